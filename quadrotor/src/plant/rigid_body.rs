//! The six-degree-of-freedom rigid body (2)–(3), with a quaternion in place of the Euler angles.

use nalgebra::{Quaternion, Scalar, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::finite::are_finite;
use crate::plant::differentiation::real::Real;
use crate::plant::mass_properties::MassProperties;
use crate::plant::orientation::{Orientation, times_imaginary};
use crate::{Airframe, Wrench};

/// Position and velocity in NED, attitude FRD into NED, body rates in FRD.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Scalar + Serialize", deserialize = "T: Scalar + Deserialize<'de>"))]
pub struct RigidBody<T: Scalar = f64> {
    /// x, y, z, m.
    pub position_m: Vector3<T>,
    /// Velocity in NED, m/s.
    pub velocity_m_s: Vector3<T>,
    /// Hamilton quaternion, unit but for rounding inside an integration step.
    pub attitude: Quaternion<T>,
    /// p, q, r, rad/s.
    pub body_rate_rad_s: Vector3<T>,
}

/// External force in NED, N, and torque in FRD, N·m, other than gravity and rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct External<T = f64> {
    /// NED, N.
    pub force_n: Vector3<T>,
    /// FRD, N·m.
    pub torque_n_m: Vector3<T>,
}

/// None.
impl<T: Real> Default for External<T> {
    fn default() -> Self {
        Self { force_n: Vector3::zeros(), torque_n_m: Vector3::zeros() }
    }
}

impl<T: Real> RigidBody<T> {
    /// Time derivative under rotor wrench and external force and torque.
    pub fn derivative(&self, airframe: &Airframe, rotors: &Wrench<T>, external: &External<T>) -> Self {
        self.derivative_of(&MassProperties::new(airframe), rotors, external)
    }

    /// The same with mass and inertia that have been inverted.
    #[inline(always)]
    pub(crate) fn derivative_of(
        &self,
        mass: &MassProperties,
        rotors: &Wrench<T>,
        external: &External<T>,
    ) -> Self {
        let rate = self.body_rate_rad_s;
        let torque = rotors.torque_n_m + external.torque_n_m;
        Self {
            position_m: self.velocity_m_s,
            velocity_m_s: mass.acceleration_m_s2(self, rotors.thrust_n, &external.force_n),
            // q̇ = q ⊗ [0, p, q, r]/2: the second line of (2) without its singularity at θ = ±90°
            attitude: times_imaginary(&self.attitude, &(rate * T::constant(0.5))),
            body_rate_rad_s: mass.angular_acceleration_rad_s2(&rate, &torque),
        }
    }

    /// |q|² R e₃, the body's down axis in the world, NED, and |q|²: without the root and the divisions of a unit quaternion.
    #[inline(always)]
    pub(crate) fn down_axis(&self) -> (Vector3<T>, T) {
        let [i, j, k, w]: [T; 4] = self.attitude.coords.into();
        let (upright, leaning) = (w * w + k * k, i * i + j * j);
        let doubled = |half: T| half + half;
        (Vector3::new(doubled(i * k + w * j), doubled(j * k - w * i), upright - leaning), upright + leaning)
    }

    /// The rotation FRD into NED. Inside an integration step the quaternion is not exactly unit: it is normalised.
    pub(crate) fn orientation(&self) -> Orientation<T> {
        Orientation::new(&self.attitude)
    }
}

impl<T: Scalar + Copy> RigidBody<T> {
    /// Made of each of the numbers of both bodies.
    #[inline(always)]
    pub(crate) fn zip_map<U: Scalar + Copy, V: Scalar>(
        &self,
        other: &RigidBody<U>,
        f: impl Fn(T, U) -> V,
    ) -> RigidBody<V> {
        RigidBody {
            position_m: self.position_m.zip_map(&other.position_m, &f),
            velocity_m_s: self.velocity_m_s.zip_map(&other.velocity_m_s, &f),
            attitude: Quaternion { coords: self.attitude.coords.zip_map(&other.attitude.coords, &f) },
            body_rate_rad_s: self.body_rate_rad_s.zip_map(&other.body_rate_rad_s, &f),
        }
    }
}

impl RigidBody {
    /// The rotation FRD into NED.
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        UnitQuaternion::new_normalize(self.attitude)
    }

    /// Whether a vehicle can have this motion: it is finite and has an attitude.
    pub(crate) fn is_possible(&self) -> bool {
        self.is_finite() && self.attitude.norm() > 0.5
    }

    pub(crate) fn is_finite(&self) -> bool {
        are_finite(self.position_m.as_slice())
            & are_finite(self.velocity_m_s.as_slice())
            & are_finite(self.body_rate_rad_s.as_slice())
            & are_finite(self.attitude.coords.as_slice())
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
