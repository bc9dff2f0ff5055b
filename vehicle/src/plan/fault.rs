//! Why a plan was not taken.

/// MAV_MISSION_RESULT of a refusal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultCode {
    /// Not now, or not understood.
    Error,
    /// A frame that the command cannot have here.
    UnsupportedFrame,
    /// A command that this vehicle does not have.
    Unsupported,
    /// More items than are kept.
    NoSpace,
    /// The plan as a whole makes no sense.
    Invalid,
    /// A parameter, 1 to 7.
    InvalidParameter(u8),
    /// An item that there is not.
    InvalidSequence,
    /// Somebody else is at it.
    Denied,
    /// Given up.
    Cancelled,
}

impl FaultCode {
    /// MAV_MISSION_RESULT.
    pub fn number(self) -> u8 {
        match self {
            Self::Error => 1,
            Self::UnsupportedFrame => 2,
            Self::Unsupported => 3,
            Self::NoSpace => 4,
            Self::Invalid => 5,
            Self::InvalidParameter(parameter) => 5 + parameter.clamp(1, 7),
            Self::InvalidSequence => 13,
            Self::Denied => 14,
            Self::Cancelled => 15,
        }
    }
}

/// Why an item or a plan was refused. Nothing has changed then.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{reason}", item.map(|item| format!("item {item}: ")).unwrap_or_default())]
pub struct PlanFault {
    /// Which item, counted from zero; `None` for the plan as a whole.
    pub item: Option<usize>,
    /// For the client's program.
    pub code: FaultCode,
    /// For the pilot: variable, value and allowed range.
    pub reason: String,
}

impl PlanFault {
    /// A fault of an item.
    pub fn of_item(item: usize, code: FaultCode, reason: impl Into<String>) -> Self {
        Self { item: Some(item), code, reason: reason.into() }
    }

    /// A fault of a plan.
    pub fn of_plan(code: FaultCode, reason: impl Into<String>) -> Self {
        Self { item: None, code, reason: reason.into() }
    }
}
