//! Which call is legal when: the state machines of FMI 3.0.2, sections 2.3, 3.2 and 4.2, as one table of bit masks.
//!
//! What the standard calls "terminated" after a failed step is our phase "error". Functions that no model here offers, such as those of
//! clocks, are legal in all phases: whoever calls one reads why it is not there.

use crate::lifecycle::Function;
use crate::lifecycle::phases::*;

/// Start values can be read before initialization, too.
const READABLE: u8 = INSTANTIATED | GETTABLE;

pub const SET_DEBUG_LOGGING: Function = Function::new("fmi3SetDebugLogging", ALIVE);
pub const ENTER_INITIALIZATION_MODE: Function = Function::new("fmi3EnterInitializationMode", INSTANTIATED);
pub const EXIT_INITIALIZATION_MODE: Function = Function::new("fmi3ExitInitializationMode", INITIALIZATION);
pub const ENTER_EVENT_MODE: Function = Function::new("fmi3EnterEventMode", STEP_COMPLETE | EXCHANGE);
pub const TERMINATE: Function = Function::new("fmi3Terminate", STEP_COMPLETE | EXCHANGE);
pub const RESET: Function = Function::new("fmi3Reset", ALIVE);

pub const GET_FLOAT32: Function = Function::new("fmi3GetFloat32", READABLE);
pub const GET_FLOAT64: Function = Function::new("fmi3GetFloat64", READABLE);
pub const GET_INT8: Function = Function::new("fmi3GetInt8", READABLE);
pub const GET_UINT8: Function = Function::new("fmi3GetUInt8", READABLE);
pub const GET_INT16: Function = Function::new("fmi3GetInt16", READABLE);
pub const GET_UINT16: Function = Function::new("fmi3GetUInt16", READABLE);
pub const GET_INT32: Function = Function::new("fmi3GetInt32", READABLE);
pub const GET_UINT32: Function = Function::new("fmi3GetUInt32", READABLE);
pub const GET_INT64: Function = Function::new("fmi3GetInt64", READABLE);
pub const GET_UINT64: Function = Function::new("fmi3GetUInt64", READABLE);
pub const GET_BOOLEAN: Function = Function::new("fmi3GetBoolean", READABLE);
pub const GET_STRING: Function = Function::new("fmi3GetString", READABLE);
pub const GET_BINARY: Function = Function::new("fmi3GetBinary", READABLE);
pub const GET_CLOCK: Function = Function::new("fmi3GetClock", ALIVE);

pub const SET_FLOAT32: Function = Function::new("fmi3SetFloat32", SETTABLE);
pub const SET_FLOAT64: Function = Function::new("fmi3SetFloat64", SETTABLE);
pub const SET_INT8: Function = Function::new("fmi3SetInt8", SETTABLE);
pub const SET_UINT8: Function = Function::new("fmi3SetUInt8", SETTABLE);
pub const SET_INT16: Function = Function::new("fmi3SetInt16", SETTABLE);
pub const SET_UINT16: Function = Function::new("fmi3SetUInt16", SETTABLE);
pub const SET_INT32: Function = Function::new("fmi3SetInt32", SETTABLE);
pub const SET_UINT32: Function = Function::new("fmi3SetUInt32", SETTABLE);
pub const SET_INT64: Function = Function::new("fmi3SetInt64", SETTABLE);
pub const SET_UINT64: Function = Function::new("fmi3SetUInt64", SETTABLE);
pub const SET_BOOLEAN: Function = Function::new("fmi3SetBoolean", SETTABLE);
pub const SET_STRING: Function = Function::new("fmi3SetString", SETTABLE);
pub const SET_BINARY: Function = Function::new("fmi3SetBinary", SETTABLE);
pub const SET_CLOCK: Function = Function::new("fmi3SetClock", ALIVE);

pub const GET_NUMBER_OF_DEPENDENCIES: Function = Function::new("fmi3GetNumberOfVariableDependencies", ALIVE);
pub const GET_DEPENDENCIES: Function = Function::new("fmi3GetVariableDependencies", ALIVE);

pub const GET_STATE: Function = Function::new("fmi3GetFMUState", ALIVE);
pub const SET_STATE: Function = Function::new("fmi3SetFMUState", ALIVE);
pub const FREE_STATE: Function = Function::new("fmi3FreeFMUState", ALIVE);
pub const SERIALIZED_STATE_SIZE: Function = Function::new("fmi3SerializedFMUStateSize", ALIVE);
pub const SERIALIZE_STATE: Function = Function::new("fmi3SerializeFMUState", ALIVE);
pub const DESERIALIZE_STATE: Function = Function::new("fmi3DeserializeFMUState", ALIVE);

pub const GET_DIRECTIONAL_DERIVATIVE: Function = Function::new("fmi3GetDirectionalDerivative", GETTABLE);
pub const GET_ADJOINT_DERIVATIVE: Function = Function::new("fmi3GetAdjointDerivative", GETTABLE);

pub const ENTER_CONFIGURATION_MODE: Function = Function::new("fmi3EnterConfigurationMode", ALIVE);
pub const EXIT_CONFIGURATION_MODE: Function = Function::new("fmi3ExitConfigurationMode", ALIVE);

pub const GET_INTERVAL_DECIMAL: Function = Function::new("fmi3GetIntervalDecimal", ALIVE);
pub const GET_INTERVAL_FRACTION: Function = Function::new("fmi3GetIntervalFraction", ALIVE);
pub const GET_SHIFT_DECIMAL: Function = Function::new("fmi3GetShiftDecimal", ALIVE);
pub const GET_SHIFT_FRACTION: Function = Function::new("fmi3GetShiftFraction", ALIVE);
pub const SET_INTERVAL_DECIMAL: Function = Function::new("fmi3SetIntervalDecimal", ALIVE);
pub const SET_INTERVAL_FRACTION: Function = Function::new("fmi3SetIntervalFraction", ALIVE);
pub const SET_SHIFT_DECIMAL: Function = Function::new("fmi3SetShiftDecimal", ALIVE);
pub const SET_SHIFT_FRACTION: Function = Function::new("fmi3SetShiftFraction", ALIVE);

pub const EVALUATE_DISCRETE_STATES: Function = Function::new("fmi3EvaluateDiscreteStates", ALIVE);
pub const UPDATE_DISCRETE_STATES: Function = Function::new("fmi3UpdateDiscreteStates", EVENT_MODE);
pub const ENTER_CONTINUOUS_TIME_MODE: Function = Function::new("fmi3EnterContinuousTimeMode", EVENT_MODE);
pub const COMPLETED_INTEGRATOR_STEP: Function =
    Function::new("fmi3CompletedIntegratorStep", CONTINUOUS_TIME_MODE);
pub const SET_TIME: Function = Function::new("fmi3SetTime", EXCHANGE);
pub const SET_CONTINUOUS_STATES: Function = Function::new("fmi3SetContinuousStates", CONTINUOUS_TIME_MODE);
pub const GET_DERIVATIVES: Function = Function::new("fmi3GetContinuousStateDerivatives", SOLVED);
pub const GET_EVENT_INDICATORS: Function = Function::new("fmi3GetEventIndicators", SOLVED);
pub const GET_CONTINUOUS_STATES: Function = Function::new("fmi3GetContinuousStates", SOLVED);
pub const GET_NOMINALS: Function = Function::new("fmi3GetNominalsOfContinuousStates", INSTANTIATED | SOLVED);
pub const GET_NUMBER_OF_EVENT_INDICATORS: Function =
    Function::new("fmi3GetNumberOfEventIndicators", INSTANTIATED | SOLVED);
pub const GET_NUMBER_OF_CONTINUOUS_STATES: Function =
    Function::new("fmi3GetNumberOfContinuousStates", INSTANTIATED | SOLVED);

pub const ENTER_STEP_MODE: Function = Function::new("fmi3EnterStepMode", ALIVE);
pub const GET_OUTPUT_DERIVATIVES: Function = Function::new("fmi3GetOutputDerivatives", STEPPED);
pub const DO_STEP: Function = Function::new("fmi3DoStep", STEP_COMPLETE);
pub const ACTIVATE_MODEL_PARTITION: Function = Function::new("fmi3ActivateModelPartition", ALIVE);
