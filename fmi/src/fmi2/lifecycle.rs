//! Which call is legal when: the state machine of FMI 2.0.4, section 4.2.4, as one table of bit masks.

use crate::lifecycle::Phase;

/// A function of the interface and the phases in which it may be called.
pub(super) struct Function {
    /// Exported name.
    pub name: &'static str,
    allowed: u8,
}

const INSTANTIATED: u8 = Phase::Instantiated as u8;
const INITIALIZATION: u8 = Phase::Initialization as u8;
const STEP_COMPLETE: u8 = Phase::StepComplete as u8;
const TERMINATED: u8 = Phase::Terminated as u8;
const ERROR: u8 = Phase::Error as u8;

const EVENT_MODE: u8 = Phase::EventMode as u8;
const CONTINUOUS_TIME_MODE: u8 = Phase::ContinuousTimeMode as u8;

const EXCHANGE: u8 = EVENT_MODE | CONTINUOUS_TIME_MODE;
const SETTABLE: u8 = INSTANTIATED | INITIALIZATION | STEP_COMPLETE | EXCHANGE;
const GETTABLE: u8 = INITIALIZATION | STEP_COMPLETE | EXCHANGE | TERMINATED | ERROR;
/// Of model exchange alone.
const SOLVED: u8 = INITIALIZATION | EXCHANGE | TERMINATED | ERROR;
const STEPPED: u8 = STEP_COMPLETE | TERMINATED | ERROR;
const ALIVE: u8 = INSTANTIATED | INITIALIZATION | STEP_COMPLETE | EXCHANGE | TERMINATED | ERROR;
const NEVER: u8 = 0;

impl Function {
    pub const SET_DEBUG_LOGGING: Self = Self::new("fmi2SetDebugLogging", ALIVE);
    pub const SETUP_EXPERIMENT: Self = Self::new("fmi2SetupExperiment", INSTANTIATED);
    pub const ENTER_INITIALIZATION_MODE: Self = Self::new("fmi2EnterInitializationMode", INSTANTIATED);
    pub const EXIT_INITIALIZATION_MODE: Self = Self::new("fmi2ExitInitializationMode", INITIALIZATION);
    pub const TERMINATE: Self = Self::new("fmi2Terminate", STEP_COMPLETE | EXCHANGE);
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

    pub const ENTER_EVENT_MODE: Self = Self::new("fmi2EnterEventMode", EXCHANGE);
    pub const NEW_DISCRETE_STATES: Self = Self::new("fmi2NewDiscreteStates", EVENT_MODE);
    pub const ENTER_CONTINUOUS_TIME_MODE: Self = Self::new("fmi2EnterContinuousTimeMode", EVENT_MODE);
    pub const COMPLETED_INTEGRATOR_STEP: Self =
        Self::new("fmi2CompletedIntegratorStep", CONTINUOUS_TIME_MODE);
    pub const SET_TIME: Self = Self::new("fmi2SetTime", EXCHANGE);
    pub const SET_CONTINUOUS_STATES: Self = Self::new("fmi2SetContinuousStates", CONTINUOUS_TIME_MODE);
    pub const GET_DERIVATIVES: Self = Self::new("fmi2GetDerivatives", SOLVED);
    pub const GET_EVENT_INDICATORS: Self = Self::new("fmi2GetEventIndicators", SOLVED);
    pub const GET_CONTINUOUS_STATES: Self = Self::new("fmi2GetContinuousStates", SOLVED);
    pub const GET_NOMINALS: Self = Self::new("fmi2GetNominalsOfContinuousStates", INSTANTIATED | SOLVED);

    const fn new(name: &'static str, allowed: u8) -> Self {
        Self { name, allowed }
    }

    /// Whether it may be called in this phase.
    pub const fn is_allowed_in(&self, phase: Phase) -> bool {
        self.allowed & phase as u8 != 0
    }
}
