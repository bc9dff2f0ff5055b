//! What the equipment knows of the vehicle.

use nalgebra::Vector3;

/// The vehicle, as its camera and its gimbal need it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// Simulation time, µs after the start.
    pub time_us: u64,
    /// Where it is, NED, m.
    pub position_m: Vector3<f64>,
    /// z of home, m.
    pub home_z_m: f64,
    /// Roll, pitch and yaw, rad.
    pub attitude_rad: Vector3<f64>,
    /// What is looked at, NED, m, if that is a place.
    pub region_m: Option<Vector3<f64>>,
    /// Whether anything is looked at.
    pub looks: bool,
}
