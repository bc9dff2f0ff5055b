//! What the equipment knows of the vehicle.

use nalgebra::Vector3;

use super::mount::MountSettings;

/// The vehicle, as its camera and its gimbal need it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// Simulation time, µs after the start.
    pub time_us: u64,
    /// Where it is, NED, m.
    pub position_m: Vector3<f64>,
    /// Home, NED, m.
    pub home_m: Vector3<f64>,
    /// Roll, pitch and yaw, rad.
    pub attitude_rad: Vector3<f64>,
    /// What is looked at, NED, m, if that is a place.
    pub region_m: Option<Vector3<f64>>,
    /// Whether anything is looked at.
    pub looks: bool,
    /// How the gimbal is mounted.
    pub mount: MountSettings,
    /// Deflections of the pilot's channels for its roll, pitch and yaw, within ±1.
    pub deflections: [f64; 3],
    /// Whether the pilot's radio is lost.
    pub radio_is_lost: bool,
}
