//! The C types of `fmi2TypesPlatform.h` and `fmi2FunctionTypes.h`.

use std::ffi::{c_char, c_double, c_int, c_uint, c_void};

/// `fmi2Component`: an instance, opaque to the importer.
pub type Component = *mut c_void;
/// `fmi2ComponentEnvironment`: the importer's own data, opaque to us.
pub type ComponentEnvironment = *mut c_void;
/// `fmi2FMUstate`: a saved state, opaque to the importer.
pub type FmuState = *mut c_void;
/// `fmi2ValueReference`
pub type ValueReference = c_uint;
/// `fmi2Real`
pub type Real = c_double;
/// `fmi2Integer`
pub type Integer = c_int;
/// `fmi2Boolean`: 0 is false, anything else true.
pub type Boolean = c_int;
/// `fmi2String`: UTF-8, ended by NUL.
pub type String = *const c_char;
/// `fmi2Byte`
pub type Byte = u8;

/// `fmi2True`
pub const TRUE: Boolean = 1;
/// `fmi2False`
pub const FALSE: Boolean = 0;

/// `fmi2Type`, value `fmi2ModelExchange`.
pub const MODEL_EXCHANGE: c_int = 0;
/// `fmi2Type`, value `fmi2CoSimulation`.
pub const CO_SIMULATION: c_int = 1;

/// `fmi2Status`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Status {
    /// Success.
    Ok = 0,
    /// A warning; the computation continues.
    Warning = 1,
    /// The requested information is not available.
    Discard = 2,
    /// The call was rejected, or the run failed.
    Error = 3,
    /// The instance can only be freed.
    Fatal = 4,
    /// An asynchronous step is in progress. Never returned.
    Pending = 5,
}

/// `fmi2StatusKind`, as the plain integer that an importer may pass.
pub type StatusKind = c_int;
/// `fmi2DoStepStatus`
pub const DO_STEP_STATUS: StatusKind = 0;
/// `fmi2PendingStatus`
pub const PENDING_STATUS: StatusKind = 1;
/// `fmi2LastSuccessfulTime`
pub const LAST_SUCCESSFUL_TIME: StatusKind = 2;
/// `fmi2Terminated`
pub const TERMINATED: StatusKind = 3;

/// `fmi2EventInfo`: what follows from an event.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct EventInfo {
    /// Whether the importer must call `fmi2NewDiscreteStates` again.
    pub new_discrete_states_needed: Boolean,
    /// Whether the model wants to end the simulation.
    pub terminate_simulation: Boolean,
    /// Whether nominals of states have changed.
    pub nominals_of_continuous_states_changed: Boolean,
    /// Whether states have jumped.
    pub values_of_continuous_states_changed: Boolean,
    /// Whether the time of the next event is known.
    pub next_event_time_defined: Boolean,
    /// That time, s.
    pub next_event_time: Real,
}

/// `fmi2CallbackLogger`: environment, instance name, status, category, printf format, arguments.
pub type CallbackLogger = unsafe extern "C" fn(ComponentEnvironment, String, Status, String, String, ...);

/// `fmi2CallbackFunctions`
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct CallbackFunctions {
    /// Receives log messages.
    pub logger: Option<CallbackLogger>,
    /// Not used: `canNotUseMemoryManagementFunctions`.
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    /// Not used.
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    /// Not used: steps are synchronous.
    pub step_finished: Option<unsafe extern "C" fn(ComponentEnvironment, Status)>,
    /// Passed back to the logger.
    pub component_environment: ComponentEnvironment,
}
