//! Corrections reach the controllers by and by.

use nalgebra::Vector3;

/// Time constant, s: that of PX4's output predictor (EKF2_TAU_POS, EKF2_TAU_VEL).
const RELEASE_S: f64 = 0.25;
/// Time constant of what is too much for its pace, s: a minute after the worst it is told.
const LONGEST_S: f64 = 10.0;

/// What a filter has corrected but not yet told. A measurement moves its state at once, after a loss of the receiver by
/// metres; controllers that saw the leap would lean into it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Release {
    held: Vector3<f64>,
    fastest_per_s: f64,
}

impl Release {
    /// Nothing held; releases no faster than this per second, unless it is very much.
    pub fn new(fastest_per_s: f64) -> Self {
        Self { held: Vector3::zeros(), fastest_per_s }
    }

    /// Holds a correction back.
    pub fn hold(&mut self, correction: &Vector3<f64>) {
        self.held += correction;
    }

    /// Goes on by `dt_s` and returns what is still held.
    pub fn step(&mut self, dt_s: f64) -> Vector3<f64> {
        let size = self.held.norm();
        if size > 0.0 {
            let pace_per_s = self.fastest_per_s.max(size / LONGEST_S);
            let released = (size / RELEASE_S).min(pace_per_s) * dt_s;
            self.held *= 1.0 - (released / size).min(1.0);
        }
        self.held
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::Release;

    #[test]
    fn a_large_correction_is_released_at_its_pace_and_a_small_one_at_once() {
        let mut release = Release::new(1.0);
        release.hold(&Vector3::new(3.0, 0.0, 4.0));
        let mut held = 5.0;
        for step in 1..=1000 {
            let now = release.step(0.005).norm();
            assert!(held - now <= 0.005 + 1e-12, "step {step}");
            held = now;
        }
        assert!((0.0..0.3).contains(&held), "{held}");
        let mut release = Release::new(1.0);
        release.hold(&Vector3::new(0.01, 0.0, 0.0));
        for _ in 0..200 {
            held = release.step(0.005).norm();
        }
        assert!((held / 0.01 - (-4.0_f64).exp()).abs() < 0.01, "{held}");
    }
}
