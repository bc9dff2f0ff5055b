//! Whether a receiver has leapt to another place and stays there.
//!
//! The filter takes the receiver's errors for lasting ones: what passes its gate moves it by and by, within minutes. A leap that
//! passes would hardly be followed. But an error that lasts changes slowly, and a leap does not.

use nalgebra::Vector2;

use super::gps::{GpsFix, POSITION_CORRELATION_S};

/// How long a receiver must stay where it leapt to until it is followed, µs: PX4's EKF2 moves to a receiver that it has rejected for so
/// long, ArduPilot's EKF3 after 7 to 10 s.
const PATIENCE_US: u64 = 7_000_000;
/// Between fixes further apart, µs, the inertial navigation may have drifted instead.
const LONGEST_GAP_US: u64 = 1_000_000;
/// How many standard deviations of the error's usual change from one fix to the next a leap has: without one, that happens once in
/// months.
const LEAST_DEVIATIONS: f64 = 6.0;

/// A leap that may last.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Leap {
    since_us: u64,
    /// How far the fixes were from the estimate before it, m.
    before_m: Vector2<f64>,
    /// By how much they leapt, m.
    by_m: Vector2<f64>,
}

/// Watches how far fixes are from the estimate.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct LeapWatch {
    /// The latest fix: when, µs, and how far it was from the estimate, m.
    latest: Option<(u64, Vector2<f64>)>,
    leap: Option<Leap>,
}

impl LeapWatch {
    /// Takes in how far a fix is from the estimate, m; returns whether the receiver has leapt and stays there.
    pub fn update(&mut self, fix: &GpsFix, off_m: Vector2<f64>) -> bool {
        let latest = self.latest.replace((fix.time_us, off_m));
        let leapt = self.leap.is_some();
        self.leap = self.leap.filter(|leap| {
            // On this side of the middle it has come back.
            (off_m - leap.before_m).dot(&leap.by_m) > leap.by_m.norm_squared() / 2.0
        });
        let gap = latest.map(|(latest_us, before_m)| (fix.time_us.saturating_sub(latest_us), before_m));
        let Some((gap_us, before_m)) = gap.filter(|(gap_us, _)| *gap_us <= LONGEST_GAP_US) else {
            self.leap = None;
            return false;
        };
        let leapt_m = off_m - before_m;
        let came_back = leapt && self.leap.is_none();
        if !came_back && leapt_m.norm() > LEAST_DEVIATIONS * usual_change_m(fix, gap_us) {
            let before_m = self.leap.map_or(before_m, |leap| leap.before_m);
            self.leap = Some(Leap { since_us: fix.time_us, before_m, by_m: off_m - before_m });
        }
        self.leap.is_some_and(|leap| fix.time_us - leap.since_us >= PATIENCE_US)
    }
}

/// Standard deviation of what an error that lasts changes by from one fix to the next, m.
fn usual_change_m(fix: &GpsFix, gap_us: u64) -> f64 {
    let lost = -libm::expm1(-(gap_us as f64 / 1e6) / POSITION_CORRELATION_S);
    fix.horizontal_accuracy_m * libm::sqrt(2.0 * lost)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::super::gps::GpsFix;
    use super::LeapWatch;

    /// After how many seconds a leap is followed, if the fixes, ten per second, are so far off, m.
    fn seconds_to_leap(off_m: impl Fn(u32) -> f64) -> Option<f64> {
        let mut watch = LeapWatch::default();
        let fix = |n: u32| GpsFix { time_us: u64::from(n) * 100_000, ..GpsFix::still() };
        (0..200).find(|n| watch.update(&fix(*n), Vector2::new(off_m(*n), 1.0))).map(|n| f64::from(n) / 10.0)
    }

    #[test]
    fn only_a_leap_that_lasts_is_followed() {
        assert_eq!(seconds_to_leap(|n| if n < 30 { 0.5 } else { 5.5 }), Some(10.0));
        assert_eq!(seconds_to_leap(|n| if (30..90).contains(&n) { 5.0 } else { 0.0 }), None, "it comes back");
        assert_eq!(seconds_to_leap(|n| 0.1 * f64::from(n)), None, "it drifts");
        assert_eq!(seconds_to_leap(|n| f64::from(n % 2) * 5.0), None, "noise");
        // Seven seconds from the last of two leaps on.
        assert_eq!(seconds_to_leap(|n| f64::from(u32::from(n > 30) + u32::from(n > 60)) * 4.0), Some(13.1));
    }
}
