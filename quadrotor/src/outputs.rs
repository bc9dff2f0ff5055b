//! What can be observed of the closed loop.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::{Activity, BatteryOutput, Belief, PositionReference};

/// The observable state at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outputs {
    /// Time since the start of the flight, µs.
    pub time_us: u64,
    /// x, y, z in NED, m.
    pub position_m: Vector3<f64>,
    /// Velocity in NED, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Acceleration in NED, m/s².
    pub acceleration_m_s2: Vector3<f64>,
    /// u, v, w: velocity in FRD, m/s.
    pub body_velocity_m_s: Vector3<f64>,
    /// φ, θ, ψ (ZYX), rad; φ and ψ within ±π, θ within ±π/2.
    pub attitude_rad: Vector3<f64>,
    /// Hamilton quaternion q₀ … q₃, scalar first, FRD into NED, as it was integrated: unit but for rounding.
    pub quaternion: [f64; 4],
    /// p, q, r in FRD, rad/s.
    pub body_rate_rad_s: Vector3<f64>,
    /// F, the thrust of the four rotors, N.
    pub thrust_n: f64,
    /// τ_φ, τ_θ, τ_ψ of the four rotors about the centre of mass, N·m, without those of their spin.
    pub torque_n_m: Vector3<f64>,
    /// Speeds of the rotors in the order of the airframe's layout, rad/s.
    pub rotor_speed_rad_s: [f64; 4],
    /// Voltage, current and charge of the battery.
    pub battery: BatteryOutput,
    /// φ and θ that the position controller asks of the attitude controller, rad.
    pub tilt_reference_rad: [f64; 2],
    /// The reference that the cascade tracks, after shaping.
    pub setpoint: PositionReference,
    /// Position minus that reference, m.
    pub tracking_error_m: Vector3<f64>,
    /// Heading minus that reference, within ±π, rad.
    pub yaw_error_rad: f64,
    /// How the controllers came to their last inputs.
    pub activity: Activity,
    /// What the controllers take the vehicle for.
    pub belief: Belief,
}

impl Outputs {
    /// The attitude that the quaternion tells, FRD into NED, without its rounding.
    pub fn orientation(&self) -> UnitQuaternion<f64> {
        let [w, x, y, z] = self.quaternion;
        UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
    }
}
