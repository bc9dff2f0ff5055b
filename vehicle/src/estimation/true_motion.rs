//! What happens to the instruments.

use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::{GRAVITY_M_S2, Outputs};

/// The vehicle's true motion at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueMotion {
    /// Simulation time, µs.
    pub time_us: u64,
    /// Position, NED, m.
    pub position_m: Vector3<f64>,
    /// Velocity, NED, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// FRD into NED.
    pub attitude: UnitQuaternion<f64>,
    /// p, q, r, rad/s.
    pub body_rate_rad_s: Vector3<f64>,
    /// What an accelerometer feels, FRD, m/s²: acceleration without gravity.
    pub specific_force_m_s2: Vector3<f64>,
}

impl TrueMotion {
    /// The motion that a simulation shows.
    pub fn of(outputs: &Outputs) -> Self {
        let attitude = outputs.orientation();
        let gravity = Vector3::new(0.0, 0.0, GRAVITY_M_S2);
        Self {
            time_us: outputs.time_us,
            position_m: outputs.position_m,
            velocity_m_s: outputs.velocity_m_s,
            attitude,
            body_rate_rad_s: outputs.body_rate_rad_s,
            specific_force_m_s2: attitude.inverse_transform_vector(&(outputs.acceleration_m_s2 - gravity)),
        }
    }
}
