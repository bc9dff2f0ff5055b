//! A recorded flight.

use nalgebra::Vector3;
use quadrotor::{
    Activity, Configuration, ConfigurationError, ControllerActivity, ControllerStatus, InputSignal, Outputs,
    Simulation, SimulationError,
};

use super::mission::{GOAL_M, Mission};

/// How often a flight is observed: the period of the attitude controller.
const STEP_US: u64 = 10_000;
/// Observations per recorded moment.
const THINNING: u64 = 5;
/// Duration of a flight, s.
pub const DURATION_S: f64 = 20.0;

/// One moment of a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Time, s.
    pub time_s: f64,
    /// What was seen.
    pub outputs: Outputs,
    /// What was asked for: position, m, and heading, rad.
    pub reference: (Vector3<f64>, f64),
}

/// Figures of a flight, and its moments.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// Root mean square of position minus reference, m.
    pub rms_m: [f64; 3],
    /// Distance from the goal at the end, m.
    pub final_m: f64,
    /// Largest share by which a coordinate went beyond its goal.
    pub overshoot: f64,
    /// ∫ (F/mg − 1)² + (|τ|/l m g)² dt, s.
    pub effort: f64,
    /// Largest tilt, rad.
    pub tilt_rad: f64,
    /// Samples of altitude, position and attitude controller with an active limit, as a share of all.
    pub limited: [f64; 3],
    /// Most iterations of a sample of the three.
    pub worst_iterations: [u32; 3],
    /// Samples whose limits had to be relaxed, or that had no solution, as a share of all.
    pub not_optimal: [f64; 3],
    /// Every 50 ms.
    pub moments: Vec<Moment>,
}

/// Flies a mission.
///
/// # Errors
/// Why the controllers were refused, or the flight was lost.
pub fn fly(configuration: &Configuration, mission: Mission) -> Result<Flight, Lost> {
    let mut simulation = Simulation::new(configuration, &mission.at(0)).map_err(Lost::Refused)?;
    let mut flight = Flight::new();
    let count = (DURATION_S * 1e6) as u64 / STEP_US;
    flight.record(configuration, &simulation.outputs(), mission, 0.0);
    for step in 1..=count {
        simulation.advance_to(step * STEP_US, &mission).map_err(Lost::Diverged)?;
        let outputs = simulation.outputs();
        flight.record(configuration, &outputs, mission, STEP_US as f64 * 1e-6);
        flight.final_m = (outputs.position_m - Vector3::from(GOAL_M)).norm();
    }
    for sum in flight.limited.iter_mut().chain(&mut flight.not_optimal) {
        *sum /= count as f64;
    }
    flight.rms_m = flight.rms_m.map(|sum| (sum / count as f64).sqrt());
    Ok(flight)
}

/// Why there is no flight.
#[derive(Debug, thiserror::Error)]
pub enum Lost {
    /// The controllers could not be designed.
    #[error(transparent)]
    Refused(ConfigurationError),
    /// The flight diverged.
    #[error(transparent)]
    Diverged(SimulationError),
}

impl Flight {
    fn new() -> Self {
        Self {
            rms_m: [0.0; 3],
            final_m: f64::INFINITY,
            overshoot: 0.0,
            effort: 0.0,
            tilt_rad: 0.0,
            limited: [0.0; 3],
            worst_iterations: [0; 3],
            not_optimal: [0.0; 3],
            moments: Vec::new(),
        }
    }

    fn record(&mut self, configuration: &Configuration, outputs: &Outputs, mission: Mission, step_s: f64) {
        let reference = mission.at(outputs.time_us).reference;
        let error = outputs.position_m - reference.position_m;
        let airframe = &configuration.airframe;
        let thrust = outputs.thrust_n / airframe.weight_n() - 1.0;
        let torque = outputs.torque_n_m.norm() / (airframe.arm_length_m * airframe.weight_n());
        if step_s > 0.0 {
            for axis in 0..3 {
                self.rms_m[axis] += error[axis] * error[axis];
                self.overshoot = self.overshoot.max(outputs.position_m[axis] / GOAL_M[axis] - 1.0);
            }
            self.effort += step_s * (thrust * thrust + torque * torque);
            self.tilt_rad = self.tilt_rad.max(tilt_rad(outputs));
            self.count(&outputs.activity);
        }
        if (outputs.time_us / STEP_US).is_multiple_of(THINNING) {
            self.moments.push(Moment {
                time_s: outputs.time_us as f64 * 1e-6,
                outputs: *outputs,
                reference: (reference.position_m, reference.yaw_rad),
            });
        }
    }

    fn count(&mut self, activity: &Activity) {
        for (index, controller) in loops(activity).into_iter().enumerate() {
            self.limited[index] += f64::from(u8::from(controller.active > 0));
            self.not_optimal[index] += f64::from(u8::from(controller.status != ControllerStatus::Optimal));
            self.worst_iterations[index] = self.worst_iterations[index].max(controller.iterations);
        }
    }
}

/// The three controllers' activities: altitude, position, attitude.
pub fn loops(activity: &Activity) -> [ControllerActivity; 3] {
    [activity.altitude, activity.position, activity.attitude]
}

/// Angle between the thrust axis and the vertical, rad: cos = cos φ cos θ.
pub fn tilt_rad(outputs: &Outputs) -> f64 {
    (outputs.attitude_rad.x.cos() * outputs.attitude_rad.y.cos()).clamp(-1.0, 1.0).acos()
}
