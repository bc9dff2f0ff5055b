//! Why a plan was not taken.

use crate::identity::Identity;

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

/// Why an item or a plan was rejected. Nothing has changed then.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct PlanFault {
    /// Which item, counted from zero; `None` for the plan as a whole.
    pub item: Option<usize>,
    /// MAV_CMD of that item, if the item itself is wrong.
    pub command: Option<u16>,
    /// For the client's program.
    pub code: FaultCode,
    /// For the pilot: variable, value and allowed range.
    pub reason: String,
}

impl PlanFault {
    /// A fault of an item.
    pub fn of_item(item: usize, code: FaultCode, reason: impl Into<String>) -> Self {
        Self { item: Some(item), command: None, code, reason: reason.into() }
    }

    /// A fault of a plan.
    pub fn of_plan(code: FaultCode, reason: impl Into<String>) -> Self {
        Self { item: None, command: None, code, reason: reason.into() }
    }

    /// The fault with its item in front: `item 3: outside the fence`.
    pub fn located(&self, identity: Identity) -> String {
        described(self.place(identity).as_deref(), None, &self.reason)
    }

    /// The fault with its item and command in front: `item 3: SET_CAMERA_MODE (530): not supported`. `name_of` names a MAV_CMD.
    pub fn described(&self, identity: Identity, name_of: fn(u16) -> String) -> String {
        let command = self.command.map(name_of);
        described(self.place(identity).as_deref(), command.as_deref(), &self.reason)
    }

    fn place(&self, identity: Identity) -> Option<String> {
        self.item.map(|item| format!("item {}", identity.item_number(item)))
    }
}

/// A reason with its place and command in front, as far as they are known.
pub(super) fn described(place: Option<&str>, command: Option<&str>, reason: &str) -> String {
    [place, command, Some(reason)].into_iter().flatten().collect::<Vec<_>>().join(": ")
}
