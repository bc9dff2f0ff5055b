//! What changes of the plant: x of f(x, u).

use nalgebra::{Quaternion, Scalar, UnitQuaternion, Vector3, Vector4};
use serde::{Deserialize, Serialize};

use crate::plant::differentiation::real::Real;
use crate::plant::rigid_body::RigidBody;
use crate::{Airframe, InitialState};

/// Largest magnitude of the numbers of a vehicle in motion, SI units.
const LARGEST: f64 = 1e12;
/// Largest body rate, rad/s: ten radians in an integration step, whose result means nothing any more.
const FASTEST: f64 = 1e4;

/// Rigid body, rotor speeds and battery, or their time derivatives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Scalar + Serialize", deserialize = "T: Scalar + Default + Deserialize<'de>"))]
pub struct PlantState<T: Scalar = f64> {
    /// The rigid body.
    pub body: RigidBody<T>,
    /// Speeds of the rotors in the order of the airframe's layout, rad/s.
    pub rotor_speed_rad_s: [T; 4],
    /// Drawn share of the battery's charge: 0 is full. Constant without [`BatteryPack::sag`](crate::BatteryPack::sag).
    #[serde(default)]
    pub discharge: T,
}

impl PlantState {
    /// How many numbers it has.
    pub const LEN: usize = 18;

    /// Where a flight begins, with rotors at rest.
    pub fn at_rest(initial: &InitialState) -> Self {
        let [phi, theta, psi] = initial.attitude_rad;
        Self {
            body: RigidBody {
                position_m: initial.position_m.into(),
                velocity_m_s: initial.velocity_m_s.into(),
                attitude: UnitQuaternion::from_euler_angles(phi, theta, psi).into_inner(),
                body_rate_rad_s: initial.body_rate_rad_s.into(),
            },
            rotor_speed_rad_s: [0.0; 4],
            discharge: initial.discharge,
        }
    }

    /// Where a flight begins, with rotors that carry the weight and balance it.
    pub fn hovering(initial: &InitialState, airframe: &Airframe) -> Self {
        Self { rotor_speed_rad_s: airframe.balanced_rotor_speeds_rad_s(), ..Self::at_rest(initial) }
    }

    /// Magnitudes that the numbers typically have: what an integrator relates its absolute tolerances to.
    pub fn nominal(airframe: &Airframe) -> Self {
        Self {
            body: RigidBody {
                position_m: Vector3::repeat(10.0),
                velocity_m_s: Vector3::repeat(5.0),
                attitude: Quaternion { coords: Vector4::repeat(1.0) },
                body_rate_rad_s: Vector3::repeat(1.0),
            },
            rotor_speed_rad_s: [airframe.hover_rotor_speed_rad_s(); 4],
            discharge: 1.0,
        }
    }

    /// Whether a number is not finite or far beyond what any vehicle reaches, so that the motion that follows from it would
    /// soon not be finite either: 10⁴ rad/s of a body rate, 10¹² in SI units of all others.
    pub fn has_diverged(&self) -> bool {
        let RigidBody { position_m, velocity_m_s, attitude, body_rate_rad_s } = &self.body;
        // NaN is in no range. All are looked at, without a branch for each: that is quicker.
        let within = |numbers: &[f64], most: f64| {
            numbers.iter().fold(true, |all, number| all & (libm::fabs(*number) <= most))
        };
        !(within(position_m.as_slice(), LARGEST)
            & within(velocity_m_s.as_slice(), LARGEST)
            & within(attitude.coords.as_slice(), LARGEST)
            & within(&self.rotor_speed_rad_s, LARGEST)
            & within(&[self.discharge], LARGEST)
            & within(body_rate_rad_s.as_slice(), FASTEST))
    }
}

impl<T: Real> PlantState<T> {
    /// self + h · derivative, each component for itself: what an explicit integrator adds up. The quaternion does not stay
    /// unit; see [`PlantState::normalized`].
    pub fn plus(&self, derivative: &Self, h_s: f64) -> Self {
        self.zip_map(derivative, |value, slope| value + slope * h_s)
    }

    /// The same with a unit quaternion: what ends a step of an integrator.
    pub fn normalized(&self) -> Self {
        let (_, squared) = self.body.down_axis();
        let coords = self.body.attitude.coords * (T::one() / squared.sqrt());
        Self { body: RigidBody { attitude: Quaternion { coords }, ..self.body }, ..*self }
    }
}

impl<T: Scalar + Copy> PlantState<T> {
    /// All its numbers: position and velocity, NED; the quaternion, its scalar first; body rates; rotor speeds; discharge.
    pub fn to_array(&self) -> [T; PlantState::LEN] {
        let [x, y, z] = self.body.position_m.into();
        let [v_x, v_y, v_z] = self.body.velocity_m_s.into();
        let [q_1, q_2, q_3, q_0] = self.body.attitude.coords.into();
        let [p, q, r] = self.body.body_rate_rad_s.into();
        let [one, two, three, four] = self.rotor_speed_rad_s;
        [x, y, z, v_x, v_y, v_z, q_0, q_1, q_2, q_3, p, q, r, one, two, three, four, self.discharge]
    }

    /// The state with these numbers, in the order of [`PlantState::to_array`].
    pub fn from_array(numbers: [T; PlantState::LEN]) -> Self {
        let [x, y, z, v_x, v_y, v_z, q_0, q_1, q_2, q_3, p, q, r, one, two, three, four, discharge] = numbers;
        Self {
            body: RigidBody {
                position_m: Vector3::new(x, y, z),
                velocity_m_s: Vector3::new(v_x, v_y, v_z),
                attitude: Quaternion { coords: Vector4::new(q_1, q_2, q_3, q_0) },
                body_rate_rad_s: Vector3::new(p, q, r),
            },
            rotor_speed_rad_s: [one, two, three, four],
            discharge,
        }
    }

    /// Made of each of the numbers of both states.
    #[inline(always)]
    pub(crate) fn zip_map<U: Scalar + Copy, V: Scalar>(
        &self,
        other: &PlantState<U>,
        f: impl Fn(T, U) -> V,
    ) -> PlantState<V> {
        PlantState {
            body: self.body.zip_map(&other.body, &f),
            rotor_speed_rad_s: zipped(&self.rotor_speed_rad_s, &other.rotor_speed_rad_s, &f),
            discharge: f(self.discharge, other.discharge),
        }
    }
}

/// Made of each of the numbers of both arrays.
pub(crate) fn zipped<T: Copy, U: Copy, V>(one: &[T; 4], other: &[U; 4], f: impl Fn(T, U) -> V) -> [V; 4] {
    core::array::from_fn(|index| f(one[index], other[index]))
}

#[cfg(test)]
mod tests {
    use super::PlantState;

    /// 1 to 18.
    fn counted() -> PlantState {
        PlantState::from_array(core::array::from_fn(|index| 1.0 + index as f64))
    }

    #[test]
    fn a_step_adds_a_multiple_of_each_component() {
        let next = counted().plus(&counted(), 0.5);
        for (index, number) in next.to_array().into_iter().enumerate() {
            assert_eq!(number, 1.5 * (1.0 + index as f64));
        }
    }

    #[test]
    fn numbers_have_the_order_of_the_documentation() {
        let state = counted();
        let body = state.body;
        assert_eq!((body.position_m.z, body.velocity_m_s.x), (3.0, 4.0));
        assert_eq!((body.attitude.w, body.attitude.i, body.attitude.k), (7.0, 8.0, 10.0));
        assert_eq!((body.body_rate_rad_s.x, state.rotor_speed_rad_s), (11.0, [14.0, 15.0, 16.0, 17.0]));
        assert_eq!(state.discharge, 18.0);
    }
}
