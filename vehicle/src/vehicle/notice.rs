//! What the vehicle has to say.

/// How important it is, as in syslog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Needs action at once.
    Critical,
    /// Something was refused or failed.
    Error,
    /// Should be looked at.
    Warning,
    /// Something normal happened.
    Info,
}

impl Severity {
    /// Its number in syslog.
    pub fn level(self) -> u8 {
        match self {
            Self::Critical => 2,
            Self::Error => 3,
            Self::Warning => 4,
            Self::Info => 6,
        }
    }
}

/// A line for the pilot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// How important.
    pub severity: Severity,
    /// The line.
    pub text: String,
}

/// Why a request was not carried out.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// It can never be carried out like this.
    #[error("{0}")]
    Denied(String),
    /// It may be carried out later.
    #[error("{0}")]
    TemporarilyRejected(String),
    /// The vehicle does not have this.
    #[error("{0}")]
    Unsupported(String),
    /// A place in a frame that is not known.
    #[error("{0}")]
    UnsupportedFrame(String),
    /// It was tried.
    #[error("{0}")]
    Failed(String),
}

impl Refusal {
    /// [`Refusal::Denied`] for a reason.
    pub fn denied(reason: impl Into<String>) -> Self {
        Self::Denied(reason.into())
    }

    /// [`Refusal::TemporarilyRejected`] for a reason.
    pub fn later(reason: impl Into<String>) -> Self {
        Self::TemporarilyRejected(reason.into())
    }
}
