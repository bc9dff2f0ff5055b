//! The rotor map (1): from rotor speeds to thrust and torques.

use nalgebra::{Scalar, Vector3};
use serde::{Deserialize, Serialize};

use crate::Airframe;
use crate::plant::differentiation::real::Real;

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

/// Thrust and torques of four rotor speeds, rad/s, in the order of the airframe's layout: (1).
pub fn wrench_of_rotors<T: Real>(airframe: &Airframe, rotor_speed_rad_s: &[T; 4]) -> Wrench<T> {
    let (k1, k2, l) =
        (airframe.thrust_coefficient_n_s2, airframe.torque_coefficient_n_m_s2, airframe.arm_length_m);
    let [mut total, mut roll, mut pitch, mut yaw] = [T::zero(); 4];
    for (rotor, speed) in airframe.layout.rotors.iter().zip(rotor_speed_rad_s) {
        let squared = *speed * *speed;
        total += squared;
        roll -= squared * rotor.y;
        pitch += squared * rotor.x;
        yaw += squared * rotor.direction.torque_sign();
    }
    // F = k₁ Σ ω²
    // τ_φ = −l k₁ Σ y ω²
    // τ_θ = l k₁ Σ x ω²
    // τ_ψ = k₂ Σ ±ω²
    Wrench { thrust_n: total * k1, torque_n_m: Vector3::new(roll * (l * k1), pitch * (l * k1), yaw * k2) }
}
