//! Which call is legal when: the state machine of FMI 2.0.4, section 4.2.4, as one table.

use std::fmt;

use serde::{Deserialize, Serialize};

/// State of an instance.
///
/// `stepInProgress`, `stepCanceled` and `stepFailed` do not occur: steps are synchronous and are never
/// discarded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
pub(crate) enum State {
    /// `instantiated`
    Instantiated = 1,
    /// `Initialization Mode`
    Initialization = 2,
    /// `stepComplete`
    StepComplete = 4,
    /// `terminated`
    Terminated = 8,
    /// `error`: the flight could not go on.
    Error = 16,
    /// `fatal`: a panic was caught; only `fmi2FreeInstance` is left.
    Fatal = 32,
}

impl fmt::Display for State {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Instantiated => "instantiated",
            Self::Initialization => "initialization mode",
            Self::StepComplete => "step complete",
            Self::Terminated => "terminated",
            Self::Error => "error",
            Self::Fatal => "fatal",
        })
    }
}

/// A function of the interface and the states in which it may be called.
pub(crate) struct Function {
    /// Exported name.
    pub name: &'static str,
    allowed: u8,
}

const INSTANTIATED: u8 = State::Instantiated as u8;
const INITIALIZATION: u8 = State::Initialization as u8;
const STEP_COMPLETE: u8 = State::StepComplete as u8;
const TERMINATED: u8 = State::Terminated as u8;
const ERROR: u8 = State::Error as u8;

const SETTABLE: u8 = INSTANTIATED | INITIALIZATION | STEP_COMPLETE;
const GETTABLE: u8 = INITIALIZATION | STEP_COMPLETE | TERMINATED | ERROR;
const STEPPED: u8 = STEP_COMPLETE | TERMINATED | ERROR;
const ALIVE: u8 = INSTANTIATED | INITIALIZATION | STEP_COMPLETE | TERMINATED | ERROR;
const NEVER: u8 = 0;

impl Function {
    pub const SET_DEBUG_LOGGING: Self = Self::new("fmi2SetDebugLogging", ALIVE);
    pub const SETUP_EXPERIMENT: Self = Self::new("fmi2SetupExperiment", INSTANTIATED);
    pub const ENTER_INITIALIZATION_MODE: Self = Self::new("fmi2EnterInitializationMode", INSTANTIATED);
    pub const EXIT_INITIALIZATION_MODE: Self = Self::new("fmi2ExitInitializationMode", INITIALIZATION);
    pub const TERMINATE: Self = Self::new("fmi2Terminate", STEP_COMPLETE);
    pub const RESET: Self = Self::new("fmi2Reset", ALIVE);
    pub const GET_REAL: Self = Self::new("fmi2GetReal", GETTABLE);
    pub const GET_INTEGER: Self = Self::new("fmi2GetInteger", GETTABLE);
    pub const GET_BOOLEAN: Self = Self::new("fmi2GetBoolean", GETTABLE);
    pub const GET_STRING: Self = Self::new("fmi2GetString", GETTABLE);
    pub const SET_REAL: Self = Self::new("fmi2SetReal", SETTABLE);
    pub const SET_INTEGER: Self = Self::new("fmi2SetInteger", SETTABLE);
    pub const SET_BOOLEAN: Self = Self::new("fmi2SetBoolean", SETTABLE);
    pub const SET_STRING: Self = Self::new("fmi2SetString", SETTABLE);
    pub const GET_STATE: Self = Self::new("fmi2GetFMUstate", ALIVE);
    pub const SET_STATE: Self = Self::new("fmi2SetFMUstate", ALIVE);
    pub const FREE_STATE: Self = Self::new("fmi2FreeFMUstate", ALIVE);
    pub const SERIALIZED_STATE_SIZE: Self = Self::new("fmi2SerializedFMUstateSize", ALIVE);
    pub const SERIALIZE_STATE: Self = Self::new("fmi2SerializeFMUstate", ALIVE);
    pub const DESERIALIZE_STATE: Self = Self::new("fmi2DeSerializeFMUstate", ALIVE);
    pub const GET_DIRECTIONAL_DERIVATIVE: Self = Self::new("fmi2GetDirectionalDerivative", GETTABLE);
    pub const SET_INPUT_DERIVATIVES: Self = Self::new("fmi2SetRealInputDerivatives", SETTABLE);
    pub const GET_OUTPUT_DERIVATIVES: Self = Self::new("fmi2GetRealOutputDerivatives", STEPPED);
    pub const DO_STEP: Self = Self::new("fmi2DoStep", STEP_COMPLETE);
    pub const CANCEL_STEP: Self = Self::new("fmi2CancelStep", NEVER);
    pub const GET_STATUS: Self = Self::new("fmi2GetStatus", STEPPED);
    pub const GET_REAL_STATUS: Self = Self::new("fmi2GetRealStatus", STEPPED);
    pub const GET_INTEGER_STATUS: Self = Self::new("fmi2GetIntegerStatus", STEPPED);
    pub const GET_BOOLEAN_STATUS: Self = Self::new("fmi2GetBooleanStatus", STEPPED);
    pub const GET_STRING_STATUS: Self = Self::new("fmi2GetStringStatus", STEPPED);

    const fn new(name: &'static str, allowed: u8) -> Self {
        Self { name, allowed }
    }

    /// Whether it may be called in this state.
    pub const fn is_allowed_in(&self, state: State) -> bool {
        self.allowed & state as u8 != 0
    }
}
