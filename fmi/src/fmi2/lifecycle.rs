//! Which call is legal when: the state machine of FMI 2.0.4, section 4.2.4, as one table of bit masks.

use crate::lifecycle::Function;
use crate::lifecycle::phases::*;

const NEVER: u8 = 0;

pub const SET_DEBUG_LOGGING: Function = Function::new("fmi2SetDebugLogging", ALIVE);
pub const SETUP_EXPERIMENT: Function = Function::new("fmi2SetupExperiment", INSTANTIATED);
pub const ENTER_INITIALIZATION_MODE: Function = Function::new("fmi2EnterInitializationMode", INSTANTIATED);
pub const EXIT_INITIALIZATION_MODE: Function = Function::new("fmi2ExitInitializationMode", INITIALIZATION);
pub const TERMINATE: Function = Function::new("fmi2Terminate", STEP_COMPLETE | EXCHANGE);
pub const RESET: Function = Function::new("fmi2Reset", ALIVE);
pub const GET_REAL: Function = Function::new("fmi2GetReal", GETTABLE);
pub const GET_INTEGER: Function = Function::new("fmi2GetInteger", GETTABLE);
pub const GET_BOOLEAN: Function = Function::new("fmi2GetBoolean", GETTABLE);
pub const GET_STRING: Function = Function::new("fmi2GetString", GETTABLE);
pub const SET_REAL: Function = Function::new("fmi2SetReal", SETTABLE);
pub const SET_INTEGER: Function = Function::new("fmi2SetInteger", SETTABLE);
pub const SET_BOOLEAN: Function = Function::new("fmi2SetBoolean", SETTABLE);
pub const SET_STRING: Function = Function::new("fmi2SetString", SETTABLE);
pub const GET_STATE: Function = Function::new("fmi2GetFMUstate", ALIVE);
pub const SET_STATE: Function = Function::new("fmi2SetFMUstate", ALIVE);
pub const FREE_STATE: Function = Function::new("fmi2FreeFMUstate", ALIVE);
pub const SERIALIZED_STATE_SIZE: Function = Function::new("fmi2SerializedFMUstateSize", ALIVE);
pub const SERIALIZE_STATE: Function = Function::new("fmi2SerializeFMUstate", ALIVE);
pub const DESERIALIZE_STATE: Function = Function::new("fmi2DeSerializeFMUstate", ALIVE);
pub const GET_DIRECTIONAL_DERIVATIVE: Function = Function::new("fmi2GetDirectionalDerivative", GETTABLE);
pub const SET_INPUT_DERIVATIVES: Function = Function::new("fmi2SetRealInputDerivatives", SETTABLE);
pub const GET_OUTPUT_DERIVATIVES: Function = Function::new("fmi2GetRealOutputDerivatives", STEPPED);
pub const DO_STEP: Function = Function::new("fmi2DoStep", STEP_COMPLETE);
pub const CANCEL_STEP: Function = Function::new("fmi2CancelStep", NEVER);
pub const GET_STATUS: Function = Function::new("fmi2GetStatus", STEPPED);
pub const GET_REAL_STATUS: Function = Function::new("fmi2GetRealStatus", STEPPED);
pub const GET_INTEGER_STATUS: Function = Function::new("fmi2GetIntegerStatus", STEPPED);
pub const GET_BOOLEAN_STATUS: Function = Function::new("fmi2GetBooleanStatus", STEPPED);
pub const GET_STRING_STATUS: Function = Function::new("fmi2GetStringStatus", STEPPED);

pub const ENTER_EVENT_MODE: Function = Function::new("fmi2EnterEventMode", EXCHANGE);
pub const NEW_DISCRETE_STATES: Function = Function::new("fmi2NewDiscreteStates", EVENT_MODE);
pub const ENTER_CONTINUOUS_TIME_MODE: Function = Function::new("fmi2EnterContinuousTimeMode", EVENT_MODE);
pub const COMPLETED_INTEGRATOR_STEP: Function =
    Function::new("fmi2CompletedIntegratorStep", CONTINUOUS_TIME_MODE);
pub const SET_TIME: Function = Function::new("fmi2SetTime", EXCHANGE);
pub const SET_CONTINUOUS_STATES: Function = Function::new("fmi2SetContinuousStates", CONTINUOUS_TIME_MODE);
pub const GET_DERIVATIVES: Function = Function::new("fmi2GetDerivatives", SOLVED);
pub const GET_EVENT_INDICATORS: Function = Function::new("fmi2GetEventIndicators", SOLVED);
pub const GET_CONTINUOUS_STATES: Function = Function::new("fmi2GetContinuousStates", SOLVED);
pub const GET_NOMINALS: Function = Function::new("fmi2GetNominalsOfContinuousStates", INSTANTIATED | SOLVED);
