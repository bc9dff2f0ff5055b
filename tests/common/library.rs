//! The FMI 2.0 functions of a library.

use std::ffi::{c_char, c_double, c_int, c_uint, c_void};

use super::loading::library;

/// `fmi2Component`
pub type Component = *mut c_void;
/// `fmi2FMUstate`
pub type State = *mut c_void;
/// `fmi2ValueReference`
pub type Reference = c_uint;

/// `fmi2Status`, compared as numbers so that an impossible one is seen.
pub type Status = c_int;
pub const OK: Status = 0;
pub const DISCARD: Status = 2;
pub const ERROR: Status = 3;

/// `fmi2CallbackFunctions`. The logger is variadic in C; see `instance::record`.
#[repr(C)]
pub struct Callbacks {
    pub logger: *const c_void,
    pub allocate: *const c_void,
    pub free: *const c_void,
    pub step_finished: *const c_void,
    pub environment: *mut c_void,
}

/// `fmi2EventInfo`
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct EventInfo {
    pub new_discrete_states_needed: c_int,
    pub terminate_simulation: c_int,
    pub nominals_of_continuous_states_changed: c_int,
    pub values_of_continuous_states_changed: c_int,
    pub next_event_time_defined: c_int,
    pub next_event_time: c_double,
}

library! {
    get_types_platform = "fmi2GetTypesPlatform": fn() -> *const c_char;
    get_version = "fmi2GetVersion": fn() -> *const c_char;
    set_debug_logging = "fmi2SetDebugLogging": fn(Component, c_int, usize, *const *const c_char) -> Status;
    instantiate = "fmi2Instantiate": fn(*const c_char, c_int, *const c_char, *const c_char, *const Callbacks, c_int, c_int) -> Component;
    free_instance = "fmi2FreeInstance": fn(Component);
    setup_experiment = "fmi2SetupExperiment": fn(Component, c_int, c_double, c_double, c_int, c_double) -> Status;
    enter_initialization_mode = "fmi2EnterInitializationMode": fn(Component) -> Status;
    exit_initialization_mode = "fmi2ExitInitializationMode": fn(Component) -> Status;
    terminate = "fmi2Terminate": fn(Component) -> Status;
    reset = "fmi2Reset": fn(Component) -> Status;
    get_real = "fmi2GetReal": fn(Component, *const Reference, usize, *mut c_double) -> Status;
    get_integer = "fmi2GetInteger": fn(Component, *const Reference, usize, *mut c_int) -> Status;
    get_boolean = "fmi2GetBoolean": fn(Component, *const Reference, usize, *mut c_int) -> Status;
    get_string = "fmi2GetString": fn(Component, *const Reference, usize, *mut *const c_char) -> Status;
    set_real = "fmi2SetReal": fn(Component, *const Reference, usize, *const c_double) -> Status;
    set_integer = "fmi2SetInteger": fn(Component, *const Reference, usize, *const c_int) -> Status;
    set_boolean = "fmi2SetBoolean": fn(Component, *const Reference, usize, *const c_int) -> Status;
    set_string = "fmi2SetString": fn(Component, *const Reference, usize, *const *const c_char) -> Status;
    get_state = "fmi2GetFMUstate": fn(Component, *mut State) -> Status;
    set_state = "fmi2SetFMUstate": fn(Component, State) -> Status;
    free_state = "fmi2FreeFMUstate": fn(Component, *mut State) -> Status;
    serialized_state_size = "fmi2SerializedFMUstateSize": fn(Component, State, *mut usize) -> Status;
    serialize_state = "fmi2SerializeFMUstate": fn(Component, State, *mut u8, usize) -> Status;
    deserialize_state = "fmi2DeSerializeFMUstate": fn(Component, *const u8, usize, *mut State) -> Status;
    get_directional_derivative = "fmi2GetDirectionalDerivative": fn(Component, *const Reference, usize, *const Reference, usize, *const c_double, *mut c_double) -> Status;
    set_input_derivatives = "fmi2SetRealInputDerivatives": fn(Component, *const Reference, usize, *const c_int, *const c_double) -> Status;
    get_output_derivatives = "fmi2GetRealOutputDerivatives": fn(Component, *const Reference, usize, *const c_int, *mut c_double) -> Status;
    enter_event_mode = "fmi2EnterEventMode": fn(Component) -> Status;
    new_discrete_states = "fmi2NewDiscreteStates": fn(Component, *mut EventInfo) -> Status;
    enter_continuous_time_mode = "fmi2EnterContinuousTimeMode": fn(Component) -> Status;
    completed_integrator_step = "fmi2CompletedIntegratorStep": fn(Component, c_int, *mut c_int, *mut c_int) -> Status;
    set_time = "fmi2SetTime": fn(Component, c_double) -> Status;
    set_continuous_states = "fmi2SetContinuousStates": fn(Component, *const c_double, usize) -> Status;
    get_derivatives = "fmi2GetDerivatives": fn(Component, *mut c_double, usize) -> Status;
    get_event_indicators = "fmi2GetEventIndicators": fn(Component, *mut c_double, usize) -> Status;
    get_continuous_states = "fmi2GetContinuousStates": fn(Component, *mut c_double, usize) -> Status;
    get_nominals = "fmi2GetNominalsOfContinuousStates": fn(Component, *mut c_double, usize) -> Status;
    do_step = "fmi2DoStep": fn(Component, c_double, c_double, c_int) -> Status;
    cancel_step = "fmi2CancelStep": fn(Component) -> Status;
    get_status = "fmi2GetStatus": fn(Component, c_int, *mut Status) -> Status;
    get_real_status = "fmi2GetRealStatus": fn(Component, c_int, *mut c_double) -> Status;
    get_integer_status = "fmi2GetIntegerStatus": fn(Component, c_int, *mut c_int) -> Status;
    get_boolean_status = "fmi2GetBooleanStatus": fn(Component, c_int, *mut c_int) -> Status;
    get_string_status = "fmi2GetStringStatus": fn(Component, c_int, *mut *const c_char) -> Status;
}
