//! Mass and inertia in the equations of motion: Newton's and Euler's.

use nalgebra::{Matrix3, Vector3};

use crate::plant::differentiation::real::Real;
use crate::{Airframe, GRAVITY_M_S2, RigidBody};

/// Mass and inertia of an airframe as the equations of motion multiply by them. A division takes as long as many products: they are inverted
/// once for all steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MassProperties {
    per_mass_1_kg: f64,
    inertia: Inertia,
}

#[derive(Clone, Copy, Debug)]
enum Inertia {
    /// The body axes are the principal axes.
    Principal {
        /// 1/J_x, 1/J_y, 1/J_z.
        inverse: [f64; 3],
        /// (J_y − J_z)/J_x, (J_z − J_x)/J_y, (J_x − J_y)/J_z.
        coupling: [f64; 3],
    },
    Any {
        tensor: Matrix3<f64>,
        inverse: Matrix3<f64>,
    },
}

impl MassProperties {
    /// Of an airframe. A singular tensor, which validation refuses, gives values that are not finite.
    pub(crate) fn new(airframe: &Airframe) -> Self {
        let inertia = if airframe.has_principal_axes() {
            let [x, y, z] = airframe.inertia_kg_m2;
            let coupling = [(y - z) / x, (z - x) / y, (x - y) / z];
            Inertia::Principal { inverse: [x, y, z].map(|moment| 1.0 / moment), coupling }
        } else {
            let tensor = airframe.inertia_tensor_kg_m2();
            // Cramer's rule for a symmetric tensor.
            let [x, y, z] = [0, 1, 2].map(|index| tensor.column(index).into_owned());
            let cofactors = Matrix3::from_columns(&[y.cross(&z), z.cross(&x), x.cross(&y)]);
            Inertia::Any { tensor, inverse: cofactors / x.dot(&y.cross(&z)) }
        };
        Self { per_mass_1_kg: 1.0 / airframe.mass_kg, inertia }
    }

    /// Acceleration, NED, m/s², of a body under a thrust, N, and an external force, NED, N: Newton's equation, the first line of (3).
    #[inline(always)]
    pub(crate) fn acceleration_m_s2<T: Real>(
        &self,
        body: &RigidBody<T>,
        thrust_n: T,
        force_n: &Vector3<T>,
    ) -> Vector3<T> {
        // World frame NED: v̇ = g e₃ − (F/m) R e₃ + f/m. With v = R [u v w]ᵀ this is the first line of (3), R is that of (2).
        let (down, squared) = body.down_axis();
        let gravity = Vector3::new(T::zero(), T::zero(), T::constant(GRAVITY_M_S2));
        gravity + (force_n - down * (thrust_n / squared)) * T::constant(self.per_mass_1_kg)
    }

    /// Angular acceleration of the body, FRD, rad/s², at a body rate, rad/s, under a torque, N·m: Euler's equation
    /// J ω̇ = τ − ω × Jω, the second line of (3).
    #[inline(always)]
    pub(crate) fn angular_acceleration_rad_s2<T: Real>(
        &self,
        rate_rad_s: &Vector3<T>,
        torque_n_m: &Vector3<T>,
    ) -> Vector3<T> {
        match &self.inertia {
            Inertia::Principal { inverse, coupling } => {
                let [p, q, r]: [T; 3] = (*rate_rad_s).into();
                let rates = [q * r, r * p, p * q];
                Vector3::from_fn(|axis, _| torque_n_m[axis] * inverse[axis] + rates[axis] * coupling[axis])
            }
            Inertia::Any { tensor, inverse } => {
                let momentum = tensor.map(T::constant) * rate_rad_s;
                inverse.map(T::constant) * (torque_n_m - rate_rad_s.cross(&momentum))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Rotation3, Vector3};
    use proptest::prelude::*;

    use super::MassProperties;
    use crate::Airframe;

    fn with_inertia(tensor: &Matrix3<f64>) -> Airframe {
        Airframe {
            inertia_kg_m2: tensor.diagonal().into(),
            products_of_inertia_kg_m2: [tensor.m12, tensor.m13, tensor.m23],
            ..Airframe::default()
        }
    }

    proptest! {
        /// J ω̇ + ω × Jω = τ, in the principal axes and in others, in which the body turns the same way.
        #[test]
        fn eulers_equation_holds_in_any_axes(
            angles in prop::array::uniform3(-3.0..3.0), rate in prop::array::uniform3(-5.0..5.0),
            torque in prop::array::uniform3(-1.0..1.0),
        ) {
            let moments = Matrix3::from_diagonal(&Vector3::new(0.08, 0.11, 0.17));
            let axes = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
            let (rate, torque) = (Vector3::from(rate), Vector3::from(torque));
            let principal =
                MassProperties::new(&with_inertia(&moments)).angular_acceleration_rad_s2(&rate, &torque);
            let balance = moments * principal + rate.cross(&(moments * rate));
            prop_assert!((balance - torque).norm() < 1e-13 * (1.0 + principal.norm()), "{balance}");
            let turned = MassProperties::new(&with_inertia(&(axes * moments * axes.inverse())));
            let seen = turned.angular_acceleration_rad_s2(&(axes * rate), &(axes * torque));
            prop_assert!((axes * principal - seen).norm() < 1e-10 * (1.0 + principal.norm()));
        }
    }
}
