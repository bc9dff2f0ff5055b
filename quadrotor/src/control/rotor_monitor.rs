//! Which rotor no longer does as it is told, from its measured speed.

use crate::Airframe;

/// A speed differs when it is off by more than this share of the expected one …
const DIFFERENT_SHARE: f64 = 0.3;
/// … and by more than this, rad/s.
const DIFFERENT_RAD_S: f64 = 30.0;
/// A rotor whose speed has differed for this long, s, is lost.
const LOST_AFTER_S: f64 = 0.05;

/// Compares measured rotor speeds, as electronic speed controllers report them, with what the commands make expect: a
/// first-order lag. A rotor that makes less than half of its thrust counts as lost; one that is stuck, as soon as it
/// matters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorMonitor {
    expected_rad_s: [f64; 4],
    different_for_s: [f64; 4],
    latest: Option<Approach>,
}

/// By how much a lag closes a gap in a time. It takes an exponential, which is the same from one look to the next, and mostly for all rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Approach {
    dt_s: f64,
    lag_s: f64,
    share: f64,
}

impl Approach {
    fn new(dt_s: f64, lag_s: f64) -> Self {
        Self { dt_s, lag_s, share: -libm::expm1(-dt_s / lag_s) }
    }
}

impl RotorMonitor {
    /// Begins with rotors at these speeds, rad/s.
    pub fn new(measured_rad_s: [f64; 4]) -> Self {
        Self { expected_rad_s: measured_rad_s, different_for_s: [0.0; 4], latest: None }
    }

    /// Takes in measured speeds, rad/s, `dt_s` after the last ones, and the speeds that were commanded in between. Returns
    /// the index of a rotor that is lost.
    pub fn update(
        &mut self,
        airframe: &Airframe,
        command_rad_s: &[f64; 4],
        measured_rad_s: &[f64; 4],
        dt_s: f64,
    ) -> Option<usize> {
        let rotors = self.expected_rad_s.iter_mut().zip(&mut self.different_for_s);
        let mut lost = None;
        for (index, ((expected, different_for), (command, measured))) in
            rotors.zip(command_rad_s.iter().zip(measured_rad_s)).enumerate()
        {
            let lag_s = airframe.lag_s(*command, *expected);
            let known = self.latest.filter(|known| known.dt_s == dt_s && known.lag_s == lag_s);
            let approach = known.unwrap_or_else(|| Approach::new(dt_s, lag_s));
            self.latest = Some(approach);
            *expected += (command - *expected) * approach.share;
            let difference = libm::fabs(measured - *expected);
            let differs = difference > (DIFFERENT_SHARE * *expected).max(DIFFERENT_RAD_S);
            *different_for = if differs { *different_for + dt_s } else { 0.0 };
            if *different_for >= LOST_AFTER_S {
                lost = lost.or(Some(index));
            }
        }
        lost
    }

    /// Whether a rotor, 0 to 3, is lost: one that is commanded not to turn any more no longer is.
    pub fn is_lost(&self, rotor: usize) -> bool {
        self.different_for_s.get(rotor).is_some_and(|different_for_s| *different_for_s >= LOST_AFTER_S)
    }
}

#[cfg(test)]
mod tests {
    use super::RotorMonitor;
    use crate::Airframe;

    /// Commands a step and lets one rotor go to a share of its speed; the time until it is found, s.
    fn found_after_s(share: f64) -> Option<f64> {
        let airframe = Airframe::default();
        let mut measured = [250.0; 4];
        let mut monitor = RotorMonitor::new(measured);
        for step in 0..1000 {
            let command = [300.0; 4];
            for (index, speed) in measured.iter_mut().enumerate() {
                let goal = if index == 2 { share * 300.0 } else { 300.0 };
                *speed += (goal - *speed) * (1.0 - libm::exp(-0.001 / airframe.rotor_time_constant_s));
            }
            if let Some(lost) = monitor.update(&airframe, &command, &measured, 0.001) {
                assert_eq!(lost, 2);
                return Some(f64::from(step + 1) * 1e-3);
            }
        }
        None
    }

    #[test]
    fn a_stopped_rotor_is_found_within_a_tenth_of_a_second() {
        let found = found_after_s(0.0).expect("found");
        assert!((0.05..0.08).contains(&found), "{found}");
    }

    /// Speeds that fall with their own, long lag are as expected; a sound lag in place of it is not.
    #[test]
    fn a_slow_fall_is_no_loss() {
        let slow = crate::RotorSpin { fall_time_ratio: 5.0, ..crate::RotorSpin::default() };
        for (rotor_spin, found) in [(slow, false), (crate::RotorSpin::default(), true)] {
            let airframe = Airframe { rotor_spin, ..Airframe::default() };
            let mut measured = [400.0_f64; 4];
            let mut monitor = RotorMonitor::new(measured);
            let mut lost = None;
            for _ in 0..500 {
                measured = measured.map(|speed| speed + (100.0 - speed) * (1.0 - libm::exp(-0.001 / 0.15)));
                lost = lost.or(monitor.update(&airframe, &[100.0; 4], &measured, 0.001));
            }
            assert_eq!(lost.is_some(), found);
        }
    }

    #[test]
    fn lag_and_weakness_are_no_loss() {
        assert_eq!(found_after_s(1.0), None);
        assert_eq!(found_after_s(libm::sqrt(0.7)), None);
        assert!(found_after_s(libm::sqrt(0.4)).is_some());
    }
}
