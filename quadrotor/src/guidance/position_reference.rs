//! Where the vehicle is asked to be.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Where the vehicle is asked to be, in NED.
///
/// With shaping on, position and yaw are a goal, and velocity is the velocity to pass it with. With
/// shaping off it is one point of a trajectory: velocity, acceleration, jerk and snap are fed forward.
///
/// Derivatives that are zero count as unknown without shaping: the control loop estimates jerk and snap from successive accelerations, or
/// acceleration and jerk from successive velocities, or velocity and acceleration from successive positions, whichever is the highest
/// derivative that is given. So does a yaw acceleration of zero, from successive yaw rates.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PositionReference {
    /// Position, m.
    pub position_m: Vector3<f64>,
    /// Velocity, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Acceleration, m/s².
    pub acceleration_m_s2: Vector3<f64>,
    /// Jerk, m/s³.
    pub jerk_m_s3: Vector3<f64>,
    /// Snap, m/s⁴.
    pub snap_m_s4: Vector3<f64>,
    /// Heading ψ, rad; any number of turns.
    pub yaw_rad: f64,
    /// Rate of the heading, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Angular acceleration of the heading, rad/s².
    pub yaw_acceleration_rad_s2: f64,
}

impl PositionReference {
    /// One that is not calculated: nothing but NaN.
    pub(crate) const UNKNOWN: Self = {
        const NOT: Vector3<f64> = Vector3::new(f64::NAN, f64::NAN, f64::NAN);
        Self {
            position_m: NOT,
            velocity_m_s: NOT,
            acceleration_m_s2: NOT,
            jerk_m_s3: NOT,
            snap_m_s4: NOT,
            yaw_rad: f64::NAN,
            yaw_rate_rad_s: f64::NAN,
            yaw_acceleration_rad_s2: f64::NAN,
        }
    };

    /// A position in NED, m, and a heading, rad, at rest.
    pub fn goal(position_m: [f64; 3], yaw_rad: f64) -> Self {
        Self {
            position_m: position_m.into(),
            velocity_m_s: Vector3::zeros(),
            acceleration_m_s2: Vector3::zeros(),
            jerk_m_s3: Vector3::zeros(),
            snap_m_s4: Vector3::zeros(),
            yaw_rad,
            yaw_rate_rad_s: 0.0,
            yaw_acceleration_rad_s2: 0.0,
        }
    }

    /// Whether it stays where it is.
    pub(crate) fn is_at_rest(&self) -> bool {
        let Self { velocity_m_s, acceleration_m_s2, jerk_m_s3, snap_m_s4, .. } = self;
        [velocity_m_s, acceleration_m_s2, jerk_m_s3, snap_m_s4].iter().all(|part| **part == Vector3::zeros())
    }

    /// The name of its first component that is not finite.
    pub(crate) fn not_finite(&self) -> Option<&'static str> {
        let Self { position_m, velocity_m_s, acceleration_m_s2, jerk_m_s3, snap_m_s4, .. } = self;
        // Zero times what is not finite is not a number, and neither is a sum with it. Mostly this is all there is to do.
        let vectors = (position_m * 0.0 + velocity_m_s * 0.0)
            + (acceleration_m_s2 * 0.0 + jerk_m_s3 * 0.0)
            + snap_m_s4 * 0.0;
        let turn = self.yaw_rad * 0.0 + self.yaw_rate_rad_s * 0.0 + self.yaw_acceleration_rad_s2 * 0.0;
        if vectors.sum() + turn == 0.0 {
            return None;
        }
        let finite = |vector: &Vector3<f64>| vector.iter().all(|value| value.is_finite());
        let checks = [
            ("reference.position", finite(&self.position_m)),
            ("reference.velocity", finite(&self.velocity_m_s)),
            ("reference.acceleration", finite(&self.acceleration_m_s2)),
            ("reference.jerk", finite(&self.jerk_m_s3)),
            ("reference.snap", finite(&self.snap_m_s4)),
            ("reference.yaw", self.yaw_rad.is_finite()),
            ("reference.yaw_rate", self.yaw_rate_rad_s.is_finite()),
            ("reference.yaw_acceleration", self.yaw_acceleration_rad_s2.is_finite()),
        ];
        checks.into_iter().find(|(_, finite)| !finite).map(|(name, _)| name)
    }
}
