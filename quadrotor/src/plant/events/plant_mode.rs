//! Which branches of f(x, u) are taken.

use serde::{Deserialize, Serialize};

use super::switch::Switch;

/// The discrete state of a plant whose equations are integrated from event to event: which switches are on. Within a mode
/// f(x, u) is smooth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct PlantMode {
    /// One bit per switch.
    on: u32,
}

impl PlantMode {
    /// Whether this switch is on.
    pub fn is_on(self, switch: Switch) -> bool {
        self.has(switch.index())
    }

    /// Whether the switch at this index is on.
    pub(crate) fn has(self, index: usize) -> bool {
        self.on & (1 << index) != 0
    }

    /// The mode with the switch at this index on or off.
    #[must_use]
    pub(crate) fn with(self, index: usize, on: bool) -> Self {
        let bit = 1 << index;
        Self { on: if on { self.on | bit } else { self.on & !bit } }
    }
}
