//! Whether a receiver that goes on contradicting the estimate is right.

use nalgebra::Vector3;

use super::gps::GpsFix;

/// So long, µs, velocities that agree with one another must have been rejected, and so many of them.
const PATIENCE_US: u64 = 2_000_000;
const LEAST_FIXES: u32 = 5;
/// Velocities agree that a vehicle can have had one after the other: their change, m/s, and per second, m/s².
const CHANGE_M_S: f64 = 0.5;
const CHANGE_M_S2: f64 = 8.0;

/// Remembers the fixes that did not fit.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Lockout {
    /// Since when, µs, how many, and the latest: when, µs, and its velocity, m/s.
    rejected: Option<(u64, u32, u64, Vector3<f64>)>,
}

impl Lockout {
    /// Takes in whether the velocity of a fix fitted; returns whether it is the estimate that is wrong.
    pub fn update(&mut self, fix: &GpsFix, fitted: bool) -> bool {
        let (now_us, velocity) = (fix.time_us, fix.velocity_m_s);
        let agreeing = self.rejected.filter(|(_, _, latest_us, latest)| {
            let dt_s = now_us.saturating_sub(*latest_us) as f64 / 1e6;
            (velocity - latest).norm() < CHANGE_M_S + CHANGE_M_S2 * dt_s
        });
        let (since_us, fixes) = agreeing.map_or((now_us, 0), |(since_us, fixes, ..)| (since_us, fixes));
        self.rejected = (!fitted).then_some((since_us, fixes + 1, now_us, velocity));
        let wrong = !fitted && fixes + 1 >= LEAST_FIXES && now_us - since_us >= PATIENCE_US;
        if wrong {
            self.rejected = None;
        }
        wrong
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::super::gps::GpsFix;
    use super::Lockout;

    fn seconds_to_wrong(fitted: impl Fn(u32) -> bool, velocity: impl Fn(u32) -> f64) -> Option<f64> {
        let mut lockout = Lockout::default();
        let fix = |n: u32| GpsFix {
            time_us: u64::from(n) * 100_000,
            velocity_m_s: Vector3::new(velocity(n), 0.0, 0.0),
            ..GpsFix::still()
        };
        (0..100).find(|n| lockout.update(&fix(*n), fitted(*n))).map(|n| f64::from(n) / 10.0)
    }

    #[test]
    fn only_what_agrees_with_itself_for_a_while_is_right() {
        assert_eq!(seconds_to_wrong(|_| false, |n| 0.1 * f64::from(n)), Some(2.0));
        assert_eq!(seconds_to_wrong(|_| true, |_| 1.0), None);
        assert_eq!(seconds_to_wrong(|n| n % 15 == 0, |_| 1.0), None, "one in between fits");
        assert_eq!(seconds_to_wrong(|_| false, |n| f64::from(n % 2) * 3.0), None, "garbage");
    }
}
