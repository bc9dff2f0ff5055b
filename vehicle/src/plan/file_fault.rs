//! Why a plan could not be read from a file.

use super::PlanFault;
use super::fault::described;

/// What is wrong with a file, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct PlanFileFault {
    /// The line or item, as the file counts it.
    place: Option<String>,
    /// MAV_CMD of an item that is wrong.
    command: Option<u16>,
    /// The value, and what is allowed.
    reason: String,
}

impl PlanFileFault {
    /// A fault of an item that was read at a place.
    pub(super) fn of_item(fault: PlanFault, place: Option<&str>) -> Self {
        Self { place: place.map(str::to_owned), command: fault.command, reason: fault.reason }
    }

    /// The fault with its place and command in front; `name_of` names a MAV_CMD.
    pub fn described(&self, name_of: fn(u16) -> String) -> String {
        described(self.place.as_deref(), self.command.map(name_of).as_deref(), &self.reason)
    }
}

impl From<String> for PlanFileFault {
    /// What cannot be read at all.
    fn from(reason: String) -> Self {
        Self { place: None, command: None, reason }
    }
}
