//! When a control loop samples.

use serde::{Deserialize, Serialize};

use crate::Controllers;

/// From one look at the inputs to the next, µs: arming, for one, does not wait for a controller's sample.
const INPUT_PERIOD_US: u64 = 1_000;

/// The latest time that a saved state may have, µs: nine thousand years, so that what is added to it does not overflow.
pub(crate) const LATEST_US: u64 = u64::MAX / 64;

/// Instants at `phase_us`, and every `period_us` from there on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Clock {
    period_us: u64,
    /// Below the period.
    phase_us: u64,
}

impl Clock {
    /// Whether it ticks at `time_us`, and its first tick after that: one division tells both.
    #[inline]
    fn look(&self, time_us: u64) -> (bool, u64) {
        match time_us.checked_sub(self.phase_us) {
            Some(since_us) => {
                let rest_us = since_us % self.period_us;
                (rest_us == 0, time_us - rest_us + self.period_us)
            }
            None => (false, self.phase_us),
        }
    }

    /// Its first tick at `time_us` or later.
    fn first_us(&self, time_us: u64) -> u64 {
        let (ticks, next_us) = self.look(time_us);
        if ticks { time_us } else { next_us }
    }

    /// The phase of a clock of another period that ticks when this one ticks first, at `time_us` or later.
    fn phase_for(&self, period_us: u64, time_us: u64) -> u64 {
        if period_us == self.period_us { self.phase_us } else { self.first_us(time_us) % period_us }
    }
}

/// Which controllers sample at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Due {
    pub(crate) position: bool,
    pub(crate) altitude: bool,
    pub(crate) attitude: bool,
}

impl Due {
    /// None of them.
    pub(crate) const NONE: Self = Self { position: false, altitude: false, attitude: false };

    pub(crate) fn any(self) -> bool {
        self.position || self.altitude || self.attitude
    }
}

/// Phases of the three controllers' clocks, µs: zero until a sample time changes in flight.
///
/// A controller whose sample time changes keeps the instant at which it would have sampled next, for which its command and the
/// estimate are meant. The new sample time counts from there, in both directions: a shorter one takes effect before that
/// instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Phases {
    position_us: u64,
    altitude_us: u64,
    attitude_us: u64,
}

/// The instants of a control loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Clocks {
    position: Clock,
    altitude: Clock,
    attitude: Clock,
}

impl Phases {
    /// Whether each phase lies within its sample time.
    pub(crate) fn fit(&self, controllers: &Controllers) -> bool {
        self.position_us < controllers.position.sample_time_us
            && self.altitude_us < controllers.altitude.sample_time_us
            && self.attitude_us < controllers.attitude.sample_time_us
    }

    /// The clocks of these sample times.
    pub(crate) fn clocks(&self, controllers: &Controllers) -> Clocks {
        Clocks {
            position: Clock { period_us: controllers.position.sample_time_us, phase_us: self.position_us },
            altitude: Clock { period_us: controllers.altitude.sample_time_us, phase_us: self.altitude_us },
            attitude: Clock { period_us: controllers.attitude.sample_time_us, phase_us: self.attitude_us },
        }
    }

    /// Phases for other sample times, from `time_us` on.
    pub(crate) fn for_sample_times(&self, before: &Controllers, after: &Controllers, time_us: u64) -> Self {
        let clocks = self.clocks(before);
        Self {
            position_us: clocks.position.phase_for(after.position.sample_time_us, time_us),
            altitude_us: clocks.altitude.phase_for(after.altitude.sample_time_us, time_us),
            attitude_us: clocks.attitude.phase_for(after.attitude.sample_time_us, time_us),
        }
    }
}

impl Clocks {
    /// Those of the inputs.
    const INPUTS: Clock = Clock { period_us: INPUT_PERIOD_US, phase_us: 0 };

    /// Whether the loop samples at `time_us`.
    pub(crate) fn is_instant(&self, time_us: u64) -> bool {
        self.first_instant_us(time_us) == time_us
    }

    /// Which controllers sample at `time_us`, and the first sample of a controller after that.
    pub(crate) fn look(&self, time_us: u64) -> (Due, u64) {
        let (position, position_us) = self.position.look(time_us);
        let (altitude, altitude_us) = self.altitude.look(time_us);
        let (attitude, attitude_us) = self.attitude.look(time_us);
        (Due { position, altitude, attitude }, position_us.min(altitude_us).min(attitude_us))
    }

    /// The first sample of a controller at `time_us` or later.
    pub(crate) fn first_sample_us(&self, time_us: u64) -> u64 {
        [self.position, self.altitude, self.attitude]
            .iter()
            .map(|clock| clock.first_us(time_us))
            .fold(u64::MAX, u64::min)
    }

    /// The instant after `time_us`, if a controller samples next at `sample_us`.
    pub(crate) fn next_instant_us(time_us: u64, sample_us: u64) -> u64 {
        let (_, inputs_us) = Self::INPUTS.look(time_us);
        inputs_us.min(sample_us)
    }

    /// The first instant at `time_us` or later, if a controller samples next at `sample_us`.
    pub(crate) fn instant_from(time_us: u64, sample_us: u64) -> u64 {
        Self::INPUTS.first_us(time_us).min(sample_us)
    }

    /// The first instant at `time_us` or later.
    pub(crate) fn first_instant_us(&self, time_us: u64) -> u64 {
        Self::INPUTS.first_us(time_us).min(self.first_sample_us(time_us))
    }
}

#[cfg(test)]
mod tests {
    use super::Phases;
    use crate::Controllers;

    fn with_attitude(sample_time_us: u64) -> Controllers {
        let mut controllers = Controllers::default();
        controllers.attitude.sample_time_us = sample_time_us;
        controllers
    }

    fn instants(phases: &Phases, controllers: &Controllers, from_us: u64, to_us: u64) -> [u64; 2] {
        let mut ticks =
            (from_us..to_us).filter(|time_us| phases.clocks(controllers).look(*time_us).0.attitude);
        [ticks.next().unwrap_or(0), ticks.next().unwrap_or(0)]
    }

    /// At 1.003 s the attitude controller was to sample next at 1.010 s.
    #[test]
    fn another_sample_time_counts_from_the_next_planned_instant() {
        let before = Controllers::default();
        let start = Phases::default();
        for (sample_time_us, expected) in [
            (10_000, [1_010_000, 1_020_000]),
            (14_000, [1_010_000, 1_024_000]),
            // Shorter: at once, so that it meets the planned instant.
            (3_000, [1_004_000, 1_007_000]),
        ] {
            let after = with_attitude(sample_time_us);
            let phases = start.for_sample_times(&before, &after, 1_003_000);
            assert!(phases.fit(&after));
            assert_eq!(instants(&phases, &after, 1_003_000, 1_100_000), expected, "{sample_time_us} µs");
            // And back again, from an instant at which it samples.
            let back = phases.for_sample_times(&after, &before, expected[1]);
            assert_eq!(instants(&back, &before, expected[1], 1_100_000)[0], expected[1]);
        }
    }
}
