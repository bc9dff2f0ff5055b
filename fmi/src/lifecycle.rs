//! Life cycle of an instance.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Phase of an instance's life cycle; each version of the interface has its own table of the calls that are allowed.
///
/// Steps are synchronous and never discarded, so there is no step in progress, canceled or failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
pub(crate) enum Phase {
    /// Values are set.
    Instantiated = 1,
    /// Values are set, read and checked together.
    Initialization = 2,
    /// At a communication point.
    StepComplete = 4,
    /// The importer has ended the run.
    Terminated = 8,
    /// The run failed.
    Error = 16,
    /// A panic was caught; the instance can only be freed.
    Fatal = 32,
    /// Model exchange: at an event.
    EventMode = 64,
    /// Model exchange: the importer's solver integrates.
    ContinuousTimeMode = 128,
}

/// A function of the interface and the phases in which it may be called.
pub(crate) struct Function {
    /// Exported name.
    pub name: &'static str,
    allowed: u8,
}

impl Function {
    /// A function that may be called in the phases of a mask.
    pub const fn new(name: &'static str, allowed: u8) -> Self {
        Self { name, allowed }
    }

    /// Whether it may be called in this phase.
    pub const fn is_allowed_in(&self, phase: Phase) -> bool {
        self.allowed & phase as u8 != 0
    }
}

/// Sets of phases, as bit masks, for the tables of all versions.
pub(crate) mod phases {
    use super::Phase;

    pub const INSTANTIATED: u8 = Phase::Instantiated as u8;
    pub const INITIALIZATION: u8 = Phase::Initialization as u8;
    pub const STEP_COMPLETE: u8 = Phase::StepComplete as u8;
    pub const TERMINATED: u8 = Phase::Terminated as u8;
    pub const ERROR: u8 = Phase::Error as u8;
    pub const EVENT_MODE: u8 = Phase::EventMode as u8;
    pub const CONTINUOUS_TIME_MODE: u8 = Phase::ContinuousTimeMode as u8;

    /// After initialization in model exchange.
    pub const EXCHANGE: u8 = EVENT_MODE | CONTINUOUS_TIME_MODE;
    /// Where values can be set.
    pub const SETTABLE: u8 = INSTANTIATED | INITIALIZATION | STEP_COMPLETE | EXCHANGE;
    /// Where the model can be evaluated.
    pub const GETTABLE: u8 = INITIALIZATION | STEP_COMPLETE | EXCHANGE | TERMINATED | ERROR;
    /// Where the model can be evaluated in model exchange.
    pub const SOLVED: u8 = INITIALIZATION | EXCHANGE | TERMINATED | ERROR;
    /// After initialization in co-simulation.
    pub const STEPPED: u8 = STEP_COMPLETE | TERMINATED | ERROR;
    /// All but after a panic.
    pub const ALIVE: u8 = INSTANTIATED | INITIALIZATION | STEP_COMPLETE | EXCHANGE | TERMINATED | ERROR;
}

impl Phase {
    /// Whether the run has begun and goes on.
    pub fn is_running(self) -> bool {
        matches!(self, Self::StepComplete | Self::EventMode | Self::ContinuousTimeMode)
    }
}

/// How the run is driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Kind {
    /// The model integrates itself from one communication point to the next.
    CoSimulation,
    /// The importer's solver integrates the model's states.
    ModelExchange,
}

impl fmt::Display for Phase {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Instantiated => "instantiated",
            Self::Initialization => "initialization mode",
            Self::StepComplete => "step complete",
            Self::Terminated => "terminated",
            Self::Error => "error",
            Self::Fatal => "fatal",
            Self::EventMode => "event mode",
            Self::ContinuousTimeMode => "continuous-time mode",
        })
    }
}
