//! An image that was taken.

use nalgebra::Vector3;

/// Where and when an image was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Image {
    /// Number since the storage was formatted, from 1.
    pub index: u32,
    /// Number since the start, from 1: it never begins anew.
    pub trigger: u32,
    /// Simulation time, µs after the start.
    pub time_us: u64,
    /// Where the vehicle was, NED, m.
    pub position_m: Vector3<f64>,
    /// z of home, m.
    pub home_z_m: f64,
    /// Roll, pitch and yaw of the vehicle, rad.
    pub attitude_rad: Vector3<f64>,
    /// Roll, pitch and yaw from north of the camera, rad.
    pub camera_attitude_rad: Vector3<f64>,
}
