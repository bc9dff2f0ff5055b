//! What the failsafe has seen and done.

use super::{Action, Cause};

/// A cause must have been away for so long, µs, before it counts as over: one that flickers acts once.
const HOLD_US: u64 = 1_000_000;
/// Gusts shorter than this, s, are no high wind.
const WIND_TIME_CONSTANT_S: f64 = 2.0;

/// A cause that is there, or has been a moment ago.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    cause: Cause,
    /// When it will be over unless it comes back, µs; `None` while it is there.
    over_us: Option<u64>,
    /// Whether it is to act as soon as the vehicle takes off.
    waits: bool,
}

/// State of the failsafe.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Failsafe {
    seen: Vec<Seen>,
    engaged: Option<(Cause, Action)>,
    /// Whether a ground station is heard; `None` before the first one.
    ground_station: Option<bool>,
    /// The wind, smoothed, m/s.
    wind_m_s: f64,
    /// Whether the battery is low, and critical, by its voltage or charge, and since when the voltage is, µs.
    weak: [(bool, Option<u64>); 2],
    /// Whether the battery is known to be missing.
    battery_missed: bool,
}

/// How weak a battery is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weakness {
    /// Low.
    Low,
    /// Critical.
    Critical,
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
    /// Tells whether a ground station is heard.
    pub fn hear_ground_station(&mut self, heard: bool) {
        self.ground_station = Some(heard);
    }

    /// Whether a ground station has been heard, and is no more.
    pub fn misses_ground_station(&self) -> bool {
        self.ground_station == Some(false)
    }

    /// Feels a wind, m/s, for `dt_s`.
    pub fn feel_wind(&mut self, wind_m_s: f64, dt_s: f64) {
        let share = dt_s / (WIND_TIME_CONSTANT_S + dt_s);
        self.wind_m_s += share * (wind_m_s - self.wind_m_s);
    }

    /// Whether the battery is so weak by its voltage or charge.
    pub fn is_weak(&self, weakness: Weakness) -> bool {
        self.weak[weakness as usize].0
    }

    /// Takes in whether it is.
    pub fn set_weak(&mut self, weakness: Weakness, weak: bool) {
        self.weak[weakness as usize].0 = weak;
    }

    /// Takes in whether the battery is missing; returns whether that is news.
    pub fn miss_battery(&mut self, missing: bool) -> bool {
        !std::mem::replace(&mut self.battery_missed, missing) && missing
    }

    /// Takes in whether the voltage is low at a time; returns whether it has been for so long, µs.
    pub fn lasts(&mut self, weakness: Weakness, low: bool, time_us: u64, late_us: u64) -> bool {
        let since = &mut self.weak[weakness as usize].1;
        *since = if low { since.or(Some(time_us)) } else { None };
        since.is_some_and(|since_us| time_us - since_us >= late_us)
    }

    /// The wind without short gusts, m/s.
    pub fn wind_m_s(&self) -> f64 {
        self.wind_m_s
    }

    /// Takes in whether a cause is there at a time, µs; returns what that changes.
    pub fn see(&mut self, cause: Cause, present: bool, time_us: u64) -> Option<Change> {
        let Some(seen) = self.seen.iter_mut().find(|seen| seen.cause == cause) else {
            if !present {
                return None;
            }
            self.seen.push(Seen { cause, over_us: None, waits: false });
            return Some(Change::Begun);
        };
        if present {
            let was_over = seen.over_us.take().is_some_and(|over_us| over_us <= time_us);
            return was_over.then_some(Change::Begun);
        }
        if *seen.over_us.get_or_insert(time_us + HOLD_US) > time_us {
            return None;
        }
        self.forget(cause);
        Some(Change::Ended)
    }

    /// A cause that is there acts as soon as the vehicle takes off.
    pub fn wait_for_takeoff(&mut self, cause: Cause) {
        if let Some(seen) = self.seen.iter_mut().find(|seen| seen.cause == cause) {
            seen.waits = true;
        }
    }

    /// Takes in that the vehicle flies while a cause is there; returns whether that was waited for.
    pub fn take_off_with(&mut self, cause: Cause) -> bool {
        let mut seen = self.seen.iter_mut().filter(|seen| seen.cause == cause);
        seen.any(|seen| std::mem::take(&mut seen.waits))
    }

    /// A cause is over at once, and nobody needs to be told.
    pub fn forget(&mut self, cause: Cause) {
        self.seen.retain(|seen| seen.cause != cause);
        if self.engaged.is_some_and(|(by, _)| by == cause) {
            self.engaged = None;
        }
    }

    /// Whether a cause is there, or not over yet.
    pub fn is_present(&self, cause: Cause) -> bool {
        self.present().any(|seen| seen == cause)
    }

    /// Causes that are there or not over yet, in the order in which they came.
    pub fn present(&self) -> impl Iterator<Item = Cause> {
        self.seen.iter().map(|seen| seen.cause)
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

    /// Somebody else decides again: a user has chosen a mode, or the flight is over. What is not there any more is over then: it
    /// acts again when it comes back.
    pub fn release(&mut self) {
        self.engaged = None;
        for over_us in self.seen.iter_mut().filter_map(|seen| seen.over_us.as_mut()) {
            *over_us = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Action, Cause, Change, Failsafe, HOLD_US};

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
        assert_eq!(failsafe.see(Cause::HighWind, false, 0), None);
        assert_eq!(failsafe.see(Cause::HighWind, true, 0), Some(Change::Begun));
        assert_eq!(failsafe.see(Cause::HighWind, true, 1), None);
        failsafe.engage(Cause::HighWind, Action::Return);
        assert_eq!(failsafe.see(Cause::Fence, true, 1), Some(Change::Begun));
        assert_eq!(failsafe.see(Cause::Fence, false, 2), None);
        assert_eq!(failsafe.see(Cause::Fence, false, 2 + HOLD_US), Some(Change::Ended));
        assert_eq!(failsafe.engaged(), Some((Cause::HighWind, Action::Return)), "another cause's end");
        // What comes and goes within the hold time has never gone.
        for time_us in (3..10 * HOLD_US).step_by(HOLD_US as usize / 3) {
            assert_eq!(failsafe.see(Cause::HighWind, time_us.is_multiple_of(2), time_us), None, "{time_us}");
        }
        assert!(failsafe.is_present(Cause::HighWind));
        assert_eq!(failsafe.see(Cause::HighWind, false, 20 * HOLD_US), Some(Change::Ended));
        assert_eq!(failsafe.engaged(), None);
    }

    #[test]
    fn it_acts_again_when_the_user_brings_the_cause_back() {
        let mut failsafe = Failsafe::default();
        failsafe.see(Cause::Fence, true, 0);
        failsafe.engage(Cause::Fence, Action::Hold);
        assert_eq!(failsafe.see(Cause::Fence, false, 10), None);
        failsafe.release();
        assert_eq!(failsafe.see(Cause::Fence, true, 20), Some(Change::Begun));
        // While it is there the user has decided.
        failsafe.release();
        assert_eq!(failsafe.see(Cause::Fence, true, 30), None);
    }
}
