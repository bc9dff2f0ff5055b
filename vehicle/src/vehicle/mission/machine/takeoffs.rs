//! Whether the mission takes off.

use super::{Mission, Progress};
use crate::plan::step::Navigate;

impl Mission {
    /// Whether it climbs from the ground or descends to it.
    pub fn is_vertical(&self) -> (bool, bool) {
        self.course.is_vertical()
    }

    /// Whether it takes off, or will as its next step.
    pub fn takes_off(&self) -> bool {
        let next = self.program.navigate(self.current).filter(|_| self.progress != Progress::Complete);
        self.is_vertical().0 || matches!(next, Some(Navigate::Takeoff { .. }))
    }

    /// Whether the first thing that it flies is a takeoff; waiting before it is none.
    pub fn begins_with_takeoff(&self, restarts: bool) -> bool {
        let begins = restarts || self.progress != Progress::Started;
        let first = if begins && !self.chosen { self.program.first() } else { self.current };
        let flown = (first..self.program.len()).filter_map(|index| self.program.navigate(index));
        let next = flown.into_iter().find(|step| !matches!(step, Navigate::Delay(_)));
        matches!(next, Some(Navigate::Takeoff { .. }))
    }
}
