//! What acts on the closed loop from outside.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::SimulationError;

/// Where the vehicle is asked to be, in NED.
///
/// With shaping on, position and yaw are a goal, and velocity is the velocity to pass it with. With
/// shaping off it is one point of a trajectory: velocity and acceleration are fed forward.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PositionReference {
    /// Position, m.
    pub position_m: Vector3<f64>,
    /// Velocity, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Acceleration, m/s².
    pub acceleration_m_s2: Vector3<f64>,
    /// Heading ψ, rad; any number of turns.
    pub yaw_rad: f64,
    /// Rate of the heading, rad/s.
    pub yaw_rate_rad_s: f64,
}

/// A place to go to and stay at.
impl PositionReference {
    /// A position in NED, m, and a heading, rad, at rest.
    pub fn goal(position_m: [f64; 3], yaw_rad: f64) -> Self {
        Self {
            position_m: position_m.into(),
            velocity_m_s: Vector3::zeros(),
            acceleration_m_s2: Vector3::zeros(),
            yaw_rad,
            yaw_rate_rad_s: 0.0,
        }
    }
}

/// Forces and torques from outside.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Disturbance {
    /// Force at the centre of mass, NED, N.
    pub force_n: Vector3<f64>,
    /// Torque, FRD, N·m.
    pub torque_n_m: Vector3<f64>,
    /// Wind that drag is relative to, NED, m/s.
    pub wind_m_s: Vector3<f64>,
}

/// All inputs of the closed loop. They are sampled on the engine's grid of events: the reference and
/// `armed` by the controllers, the disturbance at each integration step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Where to be.
    pub reference: PositionReference,
    /// What pushes.
    pub disturbance: Disturbance,
    /// Whether the rotors turn.
    pub armed: bool,
}

/// The paper's flight: armed, to 5 m north, 5 m east, 10 m up, no disturbance.
impl Default for Inputs {
    fn default() -> Self {
        Self {
            reference: PositionReference::goal([5.0, 5.0, -10.0], 0.0),
            disturbance: Disturbance::default(),
            armed: true,
        }
    }
}

/// Inputs as a function of time; any `Fn(u64) -> Inputs` of microseconds, or constant [`Inputs`].
pub trait InputSignal {
    /// The inputs at `time_us` microseconds after the start of the flight.
    fn at(&self, time_us: u64) -> Inputs;
}

impl InputSignal for Inputs {
    fn at(&self, _time_us: u64) -> Inputs {
        *self
    }
}

impl<F: Fn(u64) -> Inputs> InputSignal for F {
    fn at(&self, time_us: u64) -> Inputs {
        self(time_us)
    }
}

impl Inputs {
    /// Refuses what is not finite.
    pub(crate) fn check(&self, time_us: u64) -> Result<(), SimulationError> {
        let finite = |vector: &Vector3<f64>| vector.iter().all(|value| value.is_finite());
        let checks = [
            ("reference.position", finite(&self.reference.position_m)),
            ("reference.velocity", finite(&self.reference.velocity_m_s)),
            ("reference.acceleration", finite(&self.reference.acceleration_m_s2)),
            ("reference.yaw", self.reference.yaw_rad.is_finite()),
            ("reference.yaw_rate", self.reference.yaw_rate_rad_s.is_finite()),
            ("disturbance.force", finite(&self.disturbance.force_n)),
            ("disturbance.torque", finite(&self.disturbance.torque_n_m)),
            ("wind.velocity", finite(&self.disturbance.wind_m_s)),
        ];
        match checks.into_iter().find(|(_, finite)| !finite) {
            Some((name, _)) => Err(SimulationError::InputNotFinite { name, time_us }),
            None => Ok(()),
        }
    }
}
