//! References with their derivatives: figure-eights and circles with open limits, and looks ahead.

mod common;

use std::f64::consts::FRAC_PI_2;

use common::{fly, unshaped};
use nalgebra::Vector3;
use quadrotor::{Configuration, Inputs, Limits, PositionReference};

/// x = A sin(ω t + c) on each horizontal axis.
#[derive(Clone, Copy)]
struct Trajectory {
    amplitude_m: [f64; 2],
    rate_rad_s: [f64; 2],
    phase_rad: [f64; 2],
}

impl Trajectory {
    fn figure_eight(rate_rad_s: f64) -> Self {
        Self { amplitude_m: [6.0, 3.0], rate_rad_s: [rate_rad_s, 2.0 * rate_rad_s], phase_rad: [0.0; 2] }
    }

    fn circle(rate_rad_s: f64) -> Self {
        Self { amplitude_m: [4.0; 2], rate_rad_s: [rate_rad_s; 2], phase_rad: [FRAC_PI_2, 0.0] }
    }

    fn derivative(&self, order: i32, time_s: f64) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| match (self.amplitude_m.get(axis), self.rate_rad_s.get(axis)) {
            (Some(a), Some(w)) => {
                let angle = w * time_s + self.phase_rad[axis] + f64::from(order) * FRAC_PI_2;
                a * w.powi(order) * angle.sin()
            }
            _ => 0.0,
        })
    }

    /// With all derivatives, or with the acceleration as the last.
    fn reference(&self, time_us: u64, whole: bool) -> PositionReference {
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
}

/// Limits that do not count, and a start on the trajectory.
fn open(trajectory: &Trajectory) -> Configuration {
    let mut configuration = unshaped();
    configuration.limits = Limits {
        tilt_rad: 1.2,
        tilt_rate_rad_s: 20.0,
        tilt_acceleration_rad_s2: 17.0,
        thrust_min: 0.2,
        thrust_max: 3.0,
        speed_horizontal_m_s: 20.0,
        speed_up_m_s: 20.0,
        speed_down_m_s: 20.0,
        acceleration_horizontal_m_s2: 5.0,
        acceleration_vertical_m_s2: 3.0,
        jerk_horizontal_m_s3: 40.0,
        jerk_vertical_m_s3: 40.0,
        ..Limits::default()
    };
    let start = trajectory.reference(0, false);
    configuration.initial.position_m = start.position_m.into();
    configuration.initial.velocity_m_s = start.velocity_m_s.into();
    configuration
}

/// Root mean square of the distance to the trajectory after its first 5 s, m, of a reference that is set each `period_us`.
fn tracked(trajectory: Trajectory, whole: bool, period_us: u64) -> f64 {
    let inputs = move |time_us: u64| Inputs {
        reference: trajectory.reference(time_us / period_us * period_us, whole),
        ..Inputs::default()
    };
    let (mut square, mut count) = (0.0, 0.0);
    fly(&open(&trajectory), &inputs, 30.0, |outputs| {
        if outputs.time_us > 5_000_000 {
            let wanted = trajectory.reference(outputs.time_us, false).position_m;
            square += (outputs.position_m - wanted).norm_squared();
            count += 1.0;
        }
    });
    f64::sqrt(square / count)
}

#[test]
fn measured() {
    for (name, trajectory) in [
        ("eight 0.7", Trajectory::figure_eight(0.7)),
        ("eight 0.85", Trajectory::figure_eight(0.85)),
        ("circle 1.2", Trajectory::circle(1.2)),
        ("circle 1.5", Trajectory::circle(1.5)),
    ] {
        println!(
            "{name}: whole {:.4} estimated {:.4} 10 ms {:.4} 100 ms {:.4}",
            tracked(trajectory, true, 1),
            tracked(trajectory, false, 1),
            tracked(trajectory, false, 10_000),
            tracked(trajectory, false, 100_000)
        );
    }
}
