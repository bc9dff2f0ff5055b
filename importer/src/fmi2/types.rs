//! The C types of FMI 2.0 that co-simulation needs, as `fmi2TypesPlatform.h` and `fmi2FunctionTypes.h` have them.

use std::ffi::{c_char, c_double, c_int, c_uint, c_void};
use std::fmt;

use serde::{Deserialize, Serialize};

pub(crate) type Component = *mut c_void;
pub(crate) type Environment = *mut c_void;
pub(crate) type Text = *const c_char;
pub(crate) type Reference = c_uint;

pub(crate) const FALSE: c_int = 0;
pub(crate) const TRUE: c_int = 1;
/// `fmi2CoSimulation`
pub(crate) const CO_SIMULATION: c_int = 1;

/// `fmi2CallbackFunctions`. The logger is variadic: it is defined in C.
#[repr(C)]
pub(crate) struct Callbacks {
    pub(crate) logger: unsafe extern "C" fn(Environment, Text, c_int, Text, Text, ...),
    pub(crate) allocate: unsafe extern "C" fn(usize, usize) -> *mut c_void,
    pub(crate) free: unsafe extern "C" fn(*mut c_void),
    pub(crate) step_finished: Option<unsafe extern "C" fn(Environment, c_int)>,
    pub(crate) environment: Environment,
}

pub(crate) type GetText = unsafe extern "C" fn() -> Text;
pub(crate) type Instantiate =
    unsafe extern "C" fn(Text, c_int, Text, Text, *const Callbacks, c_int, c_int) -> Component;
pub(crate) type Free = unsafe extern "C" fn(Component);
pub(crate) type SetupExperiment =
    unsafe extern "C" fn(Component, c_int, c_double, c_double, c_int, c_double) -> c_int;
pub(crate) type Plain = unsafe extern "C" fn(Component) -> c_int;
pub(crate) type Get<T> = unsafe extern "C" fn(Component, *const Reference, usize, *mut T) -> c_int;
pub(crate) type Set<T> = unsafe extern "C" fn(Component, *const Reference, usize, *const T) -> c_int;
pub(crate) type DoStep = unsafe extern "C" fn(Component, c_double, c_double, c_int) -> c_int;

/// `fmi2Status`
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// fmi2OK
    Ok,
    /// fmi2Warning
    Warning,
    /// fmi2Discard
    Discard,
    /// fmi2Error
    Error,
    /// fmi2Fatal
    Fatal,
    /// fmi2Pending
    Pending,
    /// None of the standard's.
    Unknown(i32),
}

impl From<c_int> for Status {
    fn from(number: c_int) -> Self {
        match number {
            0 => Self::Ok,
            1 => Self::Warning,
            2 => Self::Discard,
            3 => Self::Error,
            4 => Self::Fatal,
            5 => Self::Pending,
            other => Self::Unknown(other),
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ok => formatter.write_str("fmi2OK"),
            Self::Warning => formatter.write_str("fmi2Warning"),
            Self::Discard => formatter.write_str("fmi2Discard"),
            Self::Error => formatter.write_str("fmi2Error"),
            Self::Fatal => formatter.write_str("fmi2Fatal"),
            Self::Pending => formatter.write_str("fmi2Pending"),
            Self::Unknown(number) => write!(formatter, "{number}, which is no fmi2Status"),
        }
    }
}

/// The functions of the standard that are called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Call {
    /// Loading the library, which runs its constructors.
    Load,
    /// fmi2GetVersion
    GetVersion,
    /// fmi2Instantiate
    Instantiate,
    /// fmi2SetupExperiment
    SetupExperiment,
    /// fmi2EnterInitializationMode
    EnterInitializationMode,
    /// fmi2ExitInitializationMode
    ExitInitializationMode,
    /// fmi2SetReal
    SetReal,
    /// fmi2SetInteger
    SetInteger,
    /// fmi2SetBoolean
    SetBoolean,
    /// fmi2SetString
    SetString,
    /// fmi2GetReal
    GetReal,
    /// fmi2GetInteger
    GetInteger,
    /// fmi2GetBoolean
    GetBoolean,
    /// fmi2DoStep
    DoStep,
    /// fmi2Terminate
    Terminate,
    /// fmi2FreeInstance
    FreeInstance,
    /// None of them.
    Nothing,
}

impl Call {
    const ALL: [Self; 17] = [
        Self::Load,
        Self::GetVersion,
        Self::Instantiate,
        Self::SetupExperiment,
        Self::EnterInitializationMode,
        Self::ExitInitializationMode,
        Self::SetReal,
        Self::SetInteger,
        Self::SetBoolean,
        Self::SetString,
        Self::GetReal,
        Self::GetInteger,
        Self::GetBoolean,
        Self::DoStep,
        Self::Terminate,
        Self::FreeInstance,
        Self::Nothing,
    ];

    /// Its number in one byte.
    pub(crate) fn number(self) -> u8 {
        self as u8
    }

    /// The one with a number.
    pub(crate) fn numbered(number: u8) -> Self {
        Self::ALL.into_iter().find(|call| call.number() == number).unwrap_or(Self::Nothing)
    }
}

impl fmt::Display for Call {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Load => "the constructors of its library",
            Self::GetVersion => "fmi2GetVersion",
            Self::Instantiate => "fmi2Instantiate",
            Self::SetupExperiment => "fmi2SetupExperiment",
            Self::EnterInitializationMode => "fmi2EnterInitializationMode",
            Self::ExitInitializationMode => "fmi2ExitInitializationMode",
            Self::SetReal => "fmi2SetReal",
            Self::SetInteger => "fmi2SetInteger",
            Self::SetBoolean => "fmi2SetBoolean",
            Self::SetString => "fmi2SetString",
            Self::GetReal => "fmi2GetReal",
            Self::GetInteger => "fmi2GetInteger",
            Self::GetBoolean => "fmi2GetBoolean",
            Self::DoStep => "fmi2DoStep",
            Self::Terminate => "fmi2Terminate",
            Self::FreeInstance => "fmi2FreeInstance",
            Self::Nothing => "no call",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Call;

    #[test]
    fn a_call_is_known_by_its_number() {
        for call in Call::ALL {
            assert_eq!(Call::numbered(call.number()), call);
        }
        assert_eq!(Call::numbered(255), Call::Nothing);
    }
}
