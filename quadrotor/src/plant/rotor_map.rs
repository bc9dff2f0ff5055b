//! The rotor map (1): from rotor speeds to thrust and torques.

use nalgebra::{Scalar, Vector3};
use serde::{Deserialize, Serialize};

use crate::plant::differentiation::real::Real;
use crate::{Airframe, Rotor};

/// Thrust F along the negative down axis of the body, N, and torques τ_φ, τ_θ, τ_ψ in FRD, N·m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Scalar + Serialize", deserialize = "T: Scalar + Deserialize<'de>"))]
pub struct Wrench<T = f64> {
    /// F, N.
    pub thrust_n: T,
    /// τ_φ, τ_θ, τ_ψ, N·m.
    pub torque_n_m: Vector3<T>,
}

/// None.
impl<T: Real> Default for Wrench<T> {
    fn default() -> Self {
        Self { thrust_n: T::zero(), torque_n_m: Vector3::zeros() }
    }
}

impl<T: Scalar + Copy> Wrench<T> {
    /// Made of each of the numbers of both wrenches.
    pub(crate) fn zip_map<U: Scalar + Copy, V: Scalar>(
        &self,
        other: &Wrench<U>,
        f: impl Fn(T, U) -> V,
    ) -> Wrench<V> {
        Wrench {
            thrust_n: f(self.thrust_n, other.thrust_n),
            torque_n_m: self.torque_n_m.zip_map(&other.torque_n_m, &f),
        }
    }
}

/// The rotor map of an airframe: what each rotor makes per squared speed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RotorMap {
    /// Of each rotor F, τ_φ, τ_θ and τ_ψ.
    columns: [[f64; 4]; 4],
}

impl RotorMap {
    /// Of an airframe.
    #[inline]
    pub(crate) fn new(airframe: &Airframe) -> Self {
        let (k1, k2) = (airframe.thrust_coefficient_n_s2, airframe.torque_coefficient_n_m_s2);
        let lever = airframe.arm_length_m * k1;
        // F = k₁ Σ ω²
        // τ_φ = −l k₁ Σ y ω²
        // τ_θ = l k₁ Σ x ω²
        // τ_ψ = k₂ Σ ±ω²
        let column =
            |rotor: Rotor| [k1, -lever * rotor.y, lever * rotor.x, k2 * rotor.direction.torque_sign()];
        Self { columns: airframe.layout.rotors.map(column) }
    }

    /// Thrust and torques of four rotor speeds, rad/s, in the order of the airframe's layout.
    #[inline(always)]
    pub(crate) fn wrench<T: Real>(&self, rotor_speed_rad_s: &[T; 4]) -> Wrench<T> {
        let mut sums = [T::zero(); 4];
        for (column, speed) in self.columns.iter().zip(rotor_speed_rad_s) {
            let squared = *speed * *speed;
            for (sum, per_squared) in sums.iter_mut().zip(column) {
                *sum += squared * *per_squared;
            }
        }
        let [thrust_n, roll, pitch, yaw] = sums;
        Wrench { thrust_n, torque_n_m: Vector3::new(roll, pitch, yaw) }
    }
}

/// Thrust and torques of four rotor speeds, rad/s, in the order of the airframe's layout: (1).
pub fn wrench_of_rotors<T: Real>(airframe: &Airframe, rotor_speed_rad_s: &[T; 4]) -> Wrench<T> {
    RotorMap::new(airframe).wrench(rotor_speed_rad_s)
}
