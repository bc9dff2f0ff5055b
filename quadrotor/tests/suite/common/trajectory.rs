//! Trajectories of sinusoids, with their derivatives.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;
use quadrotor::{Configuration, FlatAttitude, PositionReference};

/// x = A sin(ω t + c) on each horizontal axis.
#[derive(Clone, Copy)]
pub struct Trajectory {
    pub amplitude_m: [f64; 3],
    pub rate_rad_s: [f64; 3],
    pub phase_rad: [f64; 3],
}

impl Trajectory {
    pub fn figure_eight(rate_rad_s: f64) -> Self {
        let rates = [rate_rad_s, 2.0 * rate_rad_s, 0.0];
        Self { amplitude_m: [6.0, 3.0, 0.0], rate_rad_s: rates, phase_rad: [0.0; 3] }
    }

    pub fn circle(rate_rad_s: f64) -> Self {
        let rates = [rate_rad_s, rate_rad_s, 0.0];
        Self { amplitude_m: [4.0, 4.0, 0.0], rate_rad_s: rates, phase_rad: [FRAC_PI_2, 0.0, 0.0] }
    }

    /// A circle of another size.
    pub fn circle_of(radius_m: f64, rate_rad_s: f64) -> Self {
        Self { amplitude_m: [radius_m, radius_m, 0.0], ..Self::circle(rate_rad_s) }
    }

    /// A figure-eight of another size.
    pub fn figure_eight_of(size_m: f64, rate_rad_s: f64) -> Self {
        Self { amplitude_m: [size_m, size_m / 2.0, 0.0], ..Self::figure_eight(rate_rad_s) }
    }

    /// An upright figure-eight.
    pub fn upright(size_m: f64, rate_rad_s: f64) -> Self {
        let rates = [rate_rad_s, 0.0, 2.0 * rate_rad_s];
        Self { amplitude_m: [size_m, 0.0, size_m / 4.0], rate_rad_s: rates, phase_rad: [0.0; 3] }
    }

    pub fn derivative(&self, order: i32, time_s: f64) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| {
            let (a, w) = (self.amplitude_m[axis], self.rate_rad_s[axis]);
            let angle = w * time_s + self.phase_rad[axis] + f64::from(order) * FRAC_PI_2;
            a * w.powi(order) * angle.sin()
        })
    }

    /// With all derivatives, or with the acceleration as the last.
    pub fn reference(&self, time_us: u64, whole: bool) -> PositionReference {
        let t = time_us as f64 * 1e-6;
        let given = |order: i32| if whole { self.derivative(order, t) } else { Vector3::zeros() };
        PositionReference {
            velocity_m_s: self.derivative(1, t),
            acceleration_m_s2: self.derivative(2, t),
            jerk_m_s3: given(3),
            snap_m_s4: given(4),
            ..PositionReference::goal((self.derivative(0, t) - Vector3::z() * 20.0).into(), 0.0)
        }
    }

    /// Begins on it, at its speed and lean.
    pub fn begin(&self, configuration: &mut Configuration) {
        let start = self.reference(0, true);
        let flat = FlatAttitude::of(&start);
        configuration.initial.position_m = start.position_m.into();
        configuration.initial.velocity_m_s = start.velocity_m_s.into();
        let [roll_rad, pitch_rad] = flat.tilt_rad();
        configuration.initial.attitude_rad = [roll_rad, pitch_rad, 0.0];
        configuration.initial.body_rate_rad_s = flat.body_rate_rad_s.into();
    }
}
