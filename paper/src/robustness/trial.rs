//! One random flight.

use nalgebra::Vector3;
use quadrotor::{Configuration, Disturbance, Inputs, Limits, Outputs, PositionReference, Simulation};

use super::circumstances::{Circumstances, DURATION_S};
use crate::flights::{GOAL_M, HEADING_RAD, tilt_rad};

/// How often the flight is observed.
const STEP_US: u64 = 50_000;
/// From here on limits count: the start may exceed them, s.
const SETTLED_S: f64 = 3.0;
/// The last seconds, in which the vehicle must be at its goal.
const LAST_S: f64 = 2.0;
/// Share by which a limit may be exceeded.
const TOLERANCE: f64 = 1.01;

/// How it went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Largest distance from the goal in the last 2 s, m; infinite when the vehicle was lost.
    pub distance_m: f64,
    /// Whether the limit of tilt was exceeded.
    pub tilt_exceeded: bool,
    /// Whether a limit of speed was exceeded.
    pub speed_exceeded: bool,
}

/// Flies a configuration under the circumstances of a number.
pub fn fly(configuration: &Configuration, index: u32) -> Trial {
    let circumstances = Circumstances::new(index);
    let configuration = circumstances.applied(*configuration);
    let inputs = |time_us: u64| Inputs {
        reference: PositionReference::goal(GOAL_M, HEADING_RAD),
        disturbance: Disturbance { wind_m_s: circumstances.wind_m_s(time_us), ..Disturbance::default() },
        ..Inputs::default()
    };
    let lost = Trial { distance_m: f64::INFINITY, tilt_exceeded: false, speed_exceeded: false };
    let Ok(mut simulation) = Simulation::new(&configuration, &inputs(0)) else {
        return lost;
    };
    let mut trial = Trial { distance_m: 0.0, ..lost };
    for step in 1..=(DURATION_S * 1e6) as u64 / STEP_US {
        if simulation.advance_to(step * STEP_US, &inputs).is_err() {
            return Trial { distance_m: f64::INFINITY, ..trial };
        }
        trial.see(&configuration.limits, &simulation.outputs());
    }
    trial
}

impl Trial {
    fn see(&mut self, limits: &Limits, outputs: &Outputs) {
        let time_s = outputs.time_us as f64 * 1e-6;
        if time_s > DURATION_S - LAST_S {
            let distance_m = (outputs.position_m - Vector3::from(GOAL_M)).norm();
            self.distance_m = self.distance_m.max(distance_m);
        }
        if time_s >= SETTLED_S {
            let velocity = &outputs.velocity_m_s;
            self.tilt_exceeded |= tilt_rad(outputs) > TOLERANCE * limits.tilt_rad;
            self.speed_exceeded |= velocity.xy().norm() > TOLERANCE * limits.speed_horizontal_m_s
                || -velocity.z > TOLERANCE * limits.speed_up_m_s
                || velocity.z > TOLERANCE * limits.speed_down_m_s;
        }
    }
}
