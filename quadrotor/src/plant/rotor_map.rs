//! The rotor map (1): from rotor speeds to thrust and torques.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::Airframe;

/// Thrust F along the negative down axis of the body, N, and torques τ_φ, τ_θ, τ_ψ in FRD, N·m.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Wrench {
    /// F, N.
    pub thrust_n: f64,
    /// τ_φ, τ_θ, τ_ψ, N·m.
    pub torque_n_m: Vector3<f64>,
}

/// Thrust and torques of four rotor speeds, rad/s, in the order of the airframe's layout: (1).
pub fn wrench_of_rotors(airframe: &Airframe, rotor_speed_rad_s: &[f64; 4]) -> Wrench {
    let (k1, k2, l) =
        (airframe.thrust_coefficient_n_s2, airframe.torque_coefficient_n_m_s2, airframe.arm_length_m);
    let [mut total, mut roll, mut pitch, mut yaw] = [0.0; 4];
    for (rotor, speed) in airframe.layout.rotors.iter().zip(rotor_speed_rad_s) {
        let squared = speed * speed;
        total += squared;
        roll -= rotor.y * squared;
        pitch += rotor.x * squared;
        yaw += rotor.direction.torque_sign() * squared;
    }
    // F = k₁ Σ ω²
    // τ_φ = −l k₁ Σ y ω²
    // τ_θ = l k₁ Σ x ω²
    // τ_ψ = k₂ Σ ±ω²
    Wrench { thrust_n: k1 * total, torque_n_m: Vector3::new(l * k1 * roll, l * k1 * pitch, k2 * yaw) }
}
