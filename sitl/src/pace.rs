//! Simulation time as a function of the wall clock.

use std::time::{Duration, Instant};

use vehicle::parameters::Speed;

/// A longer delay is not caught up: after a suspend, the simulation does not race.
const MOST_BEHIND: Duration = Duration::from_millis(250);

/// Simulation time as a function of the wall clock.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    speed: Speed,
    wall: Instant,
    time_us: u64,
}

impl Pace {
    /// A pace from here on.
    pub fn new(speed: Speed, now: Instant, time_us: u64) -> Self {
        Self { speed, wall: now, time_us }
    }

    /// Where simulation time should be now; `None`: as far as possible.
    pub fn goal_us(&mut self, speed: Speed, now: Instant, time_us: u64) -> Option<u64> {
        if speed != self.speed {
            *self = Self::new(speed, now, time_us);
        }
        match speed {
            Speed::Max => None,
            Speed::Paused => {
                (self.wall, self.time_us) = (now, time_us);
                Some(time_us)
            }
            Speed::Factor(factor) => {
                let elapsed_s = now.saturating_duration_since(self.wall).as_secs_f64();
                let goal_us = self.time_us + (elapsed_s * factor * 1e6) as u64;
                let most_us = (MOST_BEHIND.as_secs_f64() * factor * 1e6) as u64;
                if goal_us > time_us + most_us {
                    tracing::debug!(
                        behind_us = goal_us - time_us,
                        "slower than the requested speed: simulation time falls behind"
                    );
                    *self = Self::new(speed, now, time_us + most_us);
                    return Some(time_us + most_us);
                }
                Some(goal_us)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::{Pace, Speed};

    #[test]
    fn time_follows_the_factor_and_its_changes() {
        let start = Instant::now();
        let mut pace = Pace::new(Speed::Factor(2.0), start, 0);
        let after = |ms| start + Duration::from_millis(ms);
        assert_eq!(pace.goal_us(Speed::Factor(2.0), after(100), 0), Some(200_000));
        assert_eq!(pace.goal_us(Speed::Paused, after(100), 200_000), Some(200_000));
        assert_eq!(pace.goal_us(Speed::Paused, after(900), 200_000), Some(200_000));
        assert_eq!(pace.goal_us(Speed::Factor(0.5), after(900), 200_000), Some(200_000));
        assert_eq!(pace.goal_us(Speed::Factor(0.5), after(1000), 200_000), Some(250_000));
        assert_eq!(pace.goal_us(Speed::Max, after(1000), 250_000), None);
    }

    #[test]
    fn a_long_sleep_is_not_caught_up() {
        let start = Instant::now();
        let mut pace = Pace::new(Speed::Factor(1.0), start, 0);
        assert_eq!(pace.goal_us(Speed::Factor(1.0), start + Duration::from_secs(60), 0), Some(250_000));
    }
}
