//! Corrections reach the controllers by and by.

use nalgebra::Vector3;

/// Time constant, s: that of PX4's output predictor (EKF2_TAU_POS, EKF2_TAU_VEL).
const RELEASE_S: f64 = 0.25;
/// Time constant of what is too much for its pace, s: a minute after the worst it is told.
const LONGEST_S: f64 = 10.0;

/// What a filter has corrected but not yet told. A measurement moves its state at once, after a loss of the receiver by
/// metres; controllers that saw the leap, or an abrupt motion instead of it, would lean into it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Release {
    held: Vector3<f64>,
    pace_per_s: f64,
    fastest_per_s: f64,
}

impl Release {
    /// Nothing held; releases no faster than this per second, unless it is very much, and is so fast after a second.
    pub fn new(fastest_per_s: f64) -> Self {
        Self { held: Vector3::zeros(), pace_per_s: 0.0, fastest_per_s }
    }

    /// Holds a correction back.
    pub fn hold(&mut self, correction: &Vector3<f64>) {
        self.held += correction;
    }

    /// Releases all of it at once.
    pub fn let_go(&mut self) {
        (self.held, self.pace_per_s) = (Vector3::zeros(), 0.0);
    }

    /// What is held.
    pub fn held(&self) -> Vector3<f64> {
        self.held
    }

    /// Goes on by `dt_s` and returns what is still held.
    pub fn step(&mut self, dt_s: f64) -> Vector3<f64> {
        let size = self.held.norm();
        let fastest_per_s = self.fastest_per_s.max(size / LONGEST_S);
        // What comes to rest when nothing is left, v²/2a with half of the change of pace that is allowed.
        let resting_per_s = libm::sqrt(fastest_per_s * size);
        let wanted_per_s = (size / RELEASE_S).min(fastest_per_s).min(resting_per_s);
        self.pace_per_s = wanted_per_s.min(self.pace_per_s + fastest_per_s * dt_s);
        if size > 0.0 {
            self.held *= 1.0 - (self.pace_per_s * dt_s / size).min(1.0);
        }
        self.held
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::Release;

    /// Largest change of the pace of a release from one step to the next, per s², and what is held after some seconds.
    fn released(correction_m: f64, seconds: f64) -> (f64, f64) {
        let mut release = Release::new(0.3);
        release.hold(&Vector3::new(0.6, 0.0, 0.8).map(|part: f64| part * correction_m));
        let (mut before, mut pace, mut jerk) = (correction_m, 0.0, 0.0_f64);
        for _ in 0..(seconds / 0.005) as usize {
            let now = release.step(0.005).norm();
            let faster = (before - now) / 0.005;
            jerk = jerk.max((faster - pace) / 0.005);
            (before, pace) = (now, faster);
            assert!(pace <= 0.300_001_f64.max(before / 9.9), "{pace} with {before} left");
        }
        (jerk, before)
    }

    #[test]
    fn a_correction_is_released_at_its_pace_without_a_jerk() {
        let (jerk, left) = released(3.0, 15.0);
        assert!(jerk < 0.31 && left < 0.01, "{jerk} {left}");
        // A small one within a second, a very large one within a minute.
        assert!(released(0.01, 1.0).1 < 0.001, "{:?}", released(0.01, 1.0));
        assert!(released(100.0, 60.0).1 < 1.0, "{:?}", released(100.0, 60.0));
    }
}
