//! The FMI 3.0 functions of a library.

use std::ffi::{c_char, c_int, c_void};

use crate::common::loading::library;

/// `fmi3Instance`
pub type Instance = *mut c_void;
/// `fmi3FMUState`
pub type State = *mut c_void;
/// `fmi3ValueReference`
pub type Reference = u32;

/// `fmi3Status`, compared as numbers so that an impossible one is seen.
pub type Status = c_int;
pub const OK: Status = 0;
pub const ERROR: Status = 3;

/// `fmi3LogMessageCallback`
pub type LogMessage = Option<unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char)>;

library! {
    get_version = "fmi3GetVersion": fn() -> *const c_char;
    set_debug_logging = "fmi3SetDebugLogging": fn(Instance, bool, usize, *const *const c_char) -> Status;
    instantiate_model_exchange = "fmi3InstantiateModelExchange": fn(*const c_char, *const c_char, *const c_char, bool, bool, *mut c_void, LogMessage) -> Instance;
    instantiate_co_simulation = "fmi3InstantiateCoSimulation": fn(*const c_char, *const c_char, *const c_char, bool, bool, bool, bool, *const Reference, usize, *mut c_void, LogMessage, *const c_void) -> Instance;
    instantiate_scheduled_execution = "fmi3InstantiateScheduledExecution": fn(*const c_char, *const c_char, *const c_char, bool, bool, *mut c_void, LogMessage, *const c_void, *const c_void, *const c_void) -> Instance;
    free_instance = "fmi3FreeInstance": fn(Instance);
    enter_initialization_mode = "fmi3EnterInitializationMode": fn(Instance, bool, f64, f64, bool, f64) -> Status;
    exit_initialization_mode = "fmi3ExitInitializationMode": fn(Instance) -> Status;
    enter_event_mode = "fmi3EnterEventMode": fn(Instance) -> Status;
    terminate = "fmi3Terminate": fn(Instance) -> Status;
    reset = "fmi3Reset": fn(Instance) -> Status;
    get_float32 = "fmi3GetFloat32": fn(Instance, *const Reference, usize, *mut f32, usize) -> Status;
    get_float64 = "fmi3GetFloat64": fn(Instance, *const Reference, usize, *mut f64, usize) -> Status;
    get_int8 = "fmi3GetInt8": fn(Instance, *const Reference, usize, *mut i8, usize) -> Status;
    get_uint8 = "fmi3GetUInt8": fn(Instance, *const Reference, usize, *mut u8, usize) -> Status;
    get_int16 = "fmi3GetInt16": fn(Instance, *const Reference, usize, *mut i16, usize) -> Status;
    get_uint16 = "fmi3GetUInt16": fn(Instance, *const Reference, usize, *mut u16, usize) -> Status;
    get_int32 = "fmi3GetInt32": fn(Instance, *const Reference, usize, *mut i32, usize) -> Status;
    get_uint32 = "fmi3GetUInt32": fn(Instance, *const Reference, usize, *mut u32, usize) -> Status;
    get_int64 = "fmi3GetInt64": fn(Instance, *const Reference, usize, *mut i64, usize) -> Status;
    get_uint64 = "fmi3GetUInt64": fn(Instance, *const Reference, usize, *mut u64, usize) -> Status;
    get_boolean = "fmi3GetBoolean": fn(Instance, *const Reference, usize, *mut bool, usize) -> Status;
    get_string = "fmi3GetString": fn(Instance, *const Reference, usize, *mut *const c_char, usize) -> Status;
    get_binary = "fmi3GetBinary": fn(Instance, *const Reference, usize, *mut usize, *mut *const u8, usize) -> Status;
    get_clock = "fmi3GetClock": fn(Instance, *const Reference, usize, *mut bool) -> Status;
    set_float32 = "fmi3SetFloat32": fn(Instance, *const Reference, usize, *const f32, usize) -> Status;
    set_float64 = "fmi3SetFloat64": fn(Instance, *const Reference, usize, *const f64, usize) -> Status;
    set_int8 = "fmi3SetInt8": fn(Instance, *const Reference, usize, *const i8, usize) -> Status;
    set_uint8 = "fmi3SetUInt8": fn(Instance, *const Reference, usize, *const u8, usize) -> Status;
    set_int16 = "fmi3SetInt16": fn(Instance, *const Reference, usize, *const i16, usize) -> Status;
    set_uint16 = "fmi3SetUInt16": fn(Instance, *const Reference, usize, *const u16, usize) -> Status;
    set_int32 = "fmi3SetInt32": fn(Instance, *const Reference, usize, *const i32, usize) -> Status;
    set_uint32 = "fmi3SetUInt32": fn(Instance, *const Reference, usize, *const u32, usize) -> Status;
    set_int64 = "fmi3SetInt64": fn(Instance, *const Reference, usize, *const i64, usize) -> Status;
    set_uint64 = "fmi3SetUInt64": fn(Instance, *const Reference, usize, *const u64, usize) -> Status;
    set_boolean = "fmi3SetBoolean": fn(Instance, *const Reference, usize, *const bool, usize) -> Status;
    set_string = "fmi3SetString": fn(Instance, *const Reference, usize, *const *const c_char, usize) -> Status;
    set_binary = "fmi3SetBinary": fn(Instance, *const Reference, usize, *const usize, *const *const u8, usize) -> Status;
    set_clock = "fmi3SetClock": fn(Instance, *const Reference, usize, *const bool) -> Status;
    get_number_of_variable_dependencies = "fmi3GetNumberOfVariableDependencies": fn(Instance, Reference, *mut usize) -> Status;
    get_variable_dependencies = "fmi3GetVariableDependencies": fn(Instance, Reference, *mut usize, *mut Reference, *mut usize, *mut c_int, usize) -> Status;
    get_state = "fmi3GetFMUState": fn(Instance, *mut State) -> Status;
    set_state = "fmi3SetFMUState": fn(Instance, State) -> Status;
    free_state = "fmi3FreeFMUState": fn(Instance, *mut State) -> Status;
    serialized_state_size = "fmi3SerializedFMUStateSize": fn(Instance, State, *mut usize) -> Status;
    serialize_state = "fmi3SerializeFMUState": fn(Instance, State, *mut u8, usize) -> Status;
    deserialize_state = "fmi3DeserializeFMUState": fn(Instance, *const u8, usize, *mut State) -> Status;
    get_directional_derivative = "fmi3GetDirectionalDerivative": fn(Instance, *const Reference, usize, *const Reference, usize, *const f64, usize, *mut f64, usize) -> Status;
    get_adjoint_derivative = "fmi3GetAdjointDerivative": fn(Instance, *const Reference, usize, *const Reference, usize, *const f64, usize, *mut f64, usize) -> Status;
    enter_configuration_mode = "fmi3EnterConfigurationMode": fn(Instance) -> Status;
    exit_configuration_mode = "fmi3ExitConfigurationMode": fn(Instance) -> Status;
    get_interval_decimal = "fmi3GetIntervalDecimal": fn(Instance, *const Reference, usize, *mut f64, *mut c_int) -> Status;
    get_interval_fraction = "fmi3GetIntervalFraction": fn(Instance, *const Reference, usize, *mut u64, *mut u64, *mut c_int) -> Status;
    get_shift_decimal = "fmi3GetShiftDecimal": fn(Instance, *const Reference, usize, *mut f64) -> Status;
    get_shift_fraction = "fmi3GetShiftFraction": fn(Instance, *const Reference, usize, *mut u64, *mut u64) -> Status;
    set_interval_decimal = "fmi3SetIntervalDecimal": fn(Instance, *const Reference, usize, *const f64) -> Status;
    set_interval_fraction = "fmi3SetIntervalFraction": fn(Instance, *const Reference, usize, *const u64, *const u64) -> Status;
    set_shift_decimal = "fmi3SetShiftDecimal": fn(Instance, *const Reference, usize, *const f64) -> Status;
    set_shift_fraction = "fmi3SetShiftFraction": fn(Instance, *const Reference, usize, *const u64, *const u64) -> Status;
    evaluate_discrete_states = "fmi3EvaluateDiscreteStates": fn(Instance) -> Status;
    update_discrete_states = "fmi3UpdateDiscreteStates": fn(Instance, *mut bool, *mut bool, *mut bool, *mut bool, *mut bool, *mut f64) -> Status;
    enter_continuous_time_mode = "fmi3EnterContinuousTimeMode": fn(Instance) -> Status;
    completed_integrator_step = "fmi3CompletedIntegratorStep": fn(Instance, bool, *mut bool, *mut bool) -> Status;
    set_time = "fmi3SetTime": fn(Instance, f64) -> Status;
    set_continuous_states = "fmi3SetContinuousStates": fn(Instance, *const f64, usize) -> Status;
    get_continuous_state_derivatives = "fmi3GetContinuousStateDerivatives": fn(Instance, *mut f64, usize) -> Status;
    get_event_indicators = "fmi3GetEventIndicators": fn(Instance, *mut f64, usize) -> Status;
    get_continuous_states = "fmi3GetContinuousStates": fn(Instance, *mut f64, usize) -> Status;
    get_nominals_of_continuous_states = "fmi3GetNominalsOfContinuousStates": fn(Instance, *mut f64, usize) -> Status;
    get_number_of_event_indicators = "fmi3GetNumberOfEventIndicators": fn(Instance, *mut usize) -> Status;
    get_number_of_continuous_states = "fmi3GetNumberOfContinuousStates": fn(Instance, *mut usize) -> Status;
    enter_step_mode = "fmi3EnterStepMode": fn(Instance) -> Status;
    get_output_derivatives = "fmi3GetOutputDerivatives": fn(Instance, *const Reference, usize, *const i32, *mut f64, usize) -> Status;
    do_step = "fmi3DoStep": fn(Instance, f64, f64, bool, *mut bool, *mut bool, *mut bool, *mut f64) -> Status;
    activate_model_partition = "fmi3ActivateModelPartition": fn(Instance, Reference, f64) -> Status;
}
