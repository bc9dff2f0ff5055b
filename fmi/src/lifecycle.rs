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
