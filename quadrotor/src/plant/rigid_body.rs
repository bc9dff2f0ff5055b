//! The six-degree-of-freedom rigid body (2)–(3), with a quaternion in place of the Euler angles.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::{Airframe, GRAVITY_M_S2, Wrench};

/// Position and velocity in NED, attitude FRD into NED, body rates in FRD.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidBody {
    /// x, y, z, m.
    pub position_m: Vector3<f64>,
    /// Velocity in NED, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Hamilton quaternion, unit but for rounding inside an integration step.
    pub attitude: Quaternion<f64>,
    /// p, q, r, rad/s.
    pub body_rate_rad_s: Vector3<f64>,
}

/// External force in NED, N, and torque in FRD, N·m, other than gravity and rotors.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct External {
    /// NED, N.
    pub force_n: Vector3<f64>,
    /// FRD, N·m.
    pub torque_n_m: Vector3<f64>,
}

impl RigidBody {
    /// The rotation FRD into NED.
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        UnitQuaternion::new_normalize(self.attitude)
    }

    /// Time derivative under rotor wrench and external force and torque.
    pub fn derivative(&self, airframe: &Airframe, rotors: &Wrench, external: &External) -> Self {
        // R of (2). Inside an integration step the quaternion is not exactly unit: normalise.
        let rotation = self.rotation();
        let rate = self.body_rate_rad_s;

        // World frame NED: v̇ = g e₃ − (F/m) R e₃ + f/m. With v = R [u v w]ᵀ this is the first line of (3).
        let thrust = rotation * Vector3::new(0.0, 0.0, -rotors.thrust_n);
        let acceleration =
            Vector3::new(0.0, 0.0, GRAVITY_M_S2) + (thrust + external.force_n) / airframe.mass_kg;

        // q̇ = ½ q ⊗ [0, p, q, r]: the second line of (2) without its singularity at θ = ±90°
        let attitude_rate = self.attitude * Quaternion::from_imag(rate) * 0.5;

        let torque = rotors.torque_n_m + external.torque_n_m;
        Self {
            position_m: self.velocity_m_s,
            velocity_m_s: acceleration,
            attitude: attitude_rate,
            body_rate_rad_s: airframe.angular_acceleration_rad_s2(&rate, &torque),
        }
    }

    /// self + h · derivative, each component for itself.
    pub(crate) fn plus(&self, derivative: &Self, h: f64) -> Self {
        Self {
            position_m: self.position_m + derivative.position_m * h,
            velocity_m_s: self.velocity_m_s + derivative.velocity_m_s * h,
            attitude: self.attitude + derivative.attitude * h,
            body_rate_rad_s: self.body_rate_rad_s + derivative.body_rate_rad_s * h,
        }
    }

    /// Whether a vehicle can have this motion: it is finite and has an attitude.
    pub(crate) fn is_possible(&self) -> bool {
        self.is_finite() && self.attitude.norm() > 0.5
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.position_m.iter().chain(&self.velocity_m_s).chain(&self.body_rate_rad_s).all(|x| x.is_finite())
            && self.attitude.coords.iter().all(|x| x.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Quaternion, Vector3};

    use super::RigidBody;

    fn body() -> RigidBody {
        RigidBody {
            position_m: Vector3::new(1.0, 2.0, 3.0),
            velocity_m_s: Vector3::new(4.0, 5.0, 6.0),
            attitude: Quaternion::new(1.0, 0.0, 0.0, 0.0),
            body_rate_rad_s: Vector3::new(7.0, 8.0, 9.0),
        }
    }

    #[test]
    fn a_step_adds_a_multiple_of_each_component() {
        let derivative = RigidBody { attitude: Quaternion::new(0.0, 2.0, 4.0, 6.0), ..body() };
        let next = body().plus(&derivative, 0.5);
        assert_eq!(next.position_m, Vector3::new(1.5, 3.0, 4.5));
        assert_eq!(next.velocity_m_s, Vector3::new(6.0, 7.5, 9.0));
        assert_eq!(next.attitude, Quaternion::new(1.0, 1.0, 2.0, 3.0));
        assert_eq!(next.body_rate_rad_s, Vector3::new(10.5, 12.0, 13.5));
    }

    #[test]
    fn a_motion_is_possible_when_it_is_finite_and_has_an_attitude() {
        assert!(body().is_possible());
        let short = |size: f64| RigidBody { attitude: Quaternion::new(0.0, 0.0, size, 0.0), ..body() };
        assert!(short(-0.6).is_possible() && !short(0.5).is_possible() && !short(0.0).is_possible());
        let (mut position, mut velocity, mut attitude, mut rate) = (body(), body(), body(), body());
        position.position_m.y = f64::NAN;
        velocity.velocity_m_s.z = f64::INFINITY;
        attitude.attitude.w = f64::INFINITY;
        rate.body_rate_rad_s.x = f64::NEG_INFINITY;
        for broken in [position, velocity, attitude, rate] {
            assert!(!broken.is_finite() && !broken.is_possible(), "{broken:?}");
        }
    }
}
