//! What the failsafe has seen and done.

use super::{Action, Cause};

/// State of the failsafe.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Failsafe {
    present: Vec<Cause>,
    engaged: Option<(Cause, Action)>,
    /// Whether a ground station is heard; `None` before the first one.
    pub(crate) ground_station: Option<bool>,
    /// The wind, smoothed, m/s.
    pub(crate) wind_m_s: f64,
}

/// How a cause has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// It is there now.
    Begun,
    /// It is over.
    Ended,
}

impl Failsafe {
    /// Takes in whether a cause is there; returns what that changes.
    pub fn see(&mut self, cause: Cause, present: bool) -> Option<Change> {
        let before = self.is_present(cause);
        match (before, present) {
            (false, true) => self.present.push(cause),
            (true, false) => self.present.retain(|seen| *seen != cause),
            _ => return None,
        }
        if before && self.engaged.is_some_and(|(by, _)| by == cause) {
            self.engaged = None;
        }
        Some(if present { Change::Begun } else { Change::Ended })
    }

    /// Whether a cause is there.
    pub fn is_present(&self, cause: Cause) -> bool {
        self.present.contains(&cause)
    }

    /// Causes that are there, in the order in which they came.
    pub fn present(&self) -> &[Cause] {
        &self.present
    }

    /// What is being done, and why.
    pub fn engaged(&self) -> Option<(Cause, Action)> {
        self.engaged
    }

    /// Decides about an action: whether it goes before what is done already, by the failsafe or by the mode.
    pub fn goes_before(&self, action: Action, by_mode: Action) -> bool {
        let now = self.engaged.map_or(Action::None, |(_, action)| action);
        action > Action::Warn && action > by_mode && action > now
    }

    /// It is done from now on.
    pub fn engage(&mut self, cause: Cause, action: Action) {
        self.engaged = Some((cause, action));
    }

    /// Somebody else decides again: a user has chosen a mode, or the flight is over.
    pub fn release(&mut self) {
        self.engaged = None;
    }
}

#[cfg(test)]
mod tests {
    use super::{Action, Cause, Change, Failsafe};

    #[test]
    fn a_worse_action_goes_before_a_milder_one_and_never_the_other_way_round() {
        for first in Action::ALL {
            for second in Action::ALL {
                let mut failsafe = Failsafe::default();
                failsafe.engage(Cause::Fence, first);
                let expected = second > first && second > Action::Warn;
                assert_eq!(failsafe.goes_before(second, Action::None), expected, "{first:?} {second:?}");
                assert_eq!(Failsafe::default().goes_before(second, first), expected);
            }
        }
    }

    #[test]
    fn causes_come_and_go_once() {
        let mut failsafe = Failsafe::default();
        assert_eq!(failsafe.see(Cause::HighWind, false), None);
        assert_eq!(failsafe.see(Cause::HighWind, true), Some(Change::Begun));
        assert_eq!(failsafe.see(Cause::HighWind, true), None);
        failsafe.engage(Cause::HighWind, Action::Return);
        assert_eq!(failsafe.see(Cause::Fence, true), Some(Change::Begun));
        assert_eq!(failsafe.see(Cause::Fence, false), Some(Change::Ended));
        assert_eq!(failsafe.engaged(), Some((Cause::HighWind, Action::Return)), "another cause's end");
        assert_eq!(failsafe.see(Cause::HighWind, false), Some(Change::Ended));
        assert_eq!(failsafe.engaged(), None);
    }
}
