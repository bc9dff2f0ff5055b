//! How a body turns about its principal axes.

use nalgebra::Vector3;

/// ω × Jω, N·m, of moments of inertia J, kg·m², and a body rate ω, rad/s.
pub(crate) fn gyroscopic_n_m(inertia_kg_m2: &Vector3<f64>, rate_rad_s: &Vector3<f64>) -> Vector3<f64> {
    rate_rad_s.cross(&inertia_kg_m2.component_mul(rate_rad_s))
}

/// ω̇ = J⁻¹ (τ − ω × Jω), rad/s², under a torque τ, N·m.
pub(crate) fn angular_acceleration_rad_s2(
    inertia_kg_m2: &Vector3<f64>,
    rate_rad_s: &Vector3<f64>,
    torque_n_m: &Vector3<f64>,
) -> Vector3<f64> {
    (torque_n_m - gyroscopic_n_m(inertia_kg_m2, rate_rad_s)).component_div(inertia_kg_m2)
}
