//! The rotation from body to world that belongs to an attitude.

use nalgebra::{Quaternion, Vector3, Vector4};

use crate::plant::differentiation::real::{Real, Valued};

/// A unit quaternion, FRD into NED: nalgebra's for any [`Real`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Orientation<T> {
    vector: Vector3<T>,
    scalar: T,
}

impl<T: Real> Orientation<T> {
    /// Of a quaternion that is unit but for rounding.
    pub(crate) fn new(attitude: &Quaternion<T>) -> Self {
        let [i, j, k, w] = attitude.coords.into();
        // The order in which nalgebra adds four squares.
        let norm = ((i * i + k * k) + (j * j + w * w)).sqrt();
        Self { vector: Vector3::new(i / norm, j / norm, k / norm), scalar: w / norm }
    }

    /// A vector of the body, FRD, in the world, NED.
    pub(crate) fn in_world(&self, vector: &Vector3<T>) -> Vector3<T> {
        rotated(&self.vector, self.scalar, vector)
    }

    /// A vector of the world, NED, in the body, FRD.
    pub(crate) fn in_body(&self, vector: &Vector3<T>) -> Vector3<T> {
        rotated(&-self.vector, self.scalar, vector)
    }
}

impl<T: Valued> Orientation<T> {
    /// φ, θ, ψ (ZYX), rad. Their derivatives have no bound where θ approaches ±90°.
    pub(crate) fn euler_angles(&self) -> Vector3<T> {
        let [i, j, k]: [T; 3] = self.vector.into();
        let w = self.scalar;
        let (ww, ii, jj, kk) = (w * w, i * i, j * j, k * k);
        let doubled = |one: T, other: T| one * other * 2.0;
        let (ij, wk, wj) = (doubled(i, j), doubled(w, k), doubled(w, j));
        let (ik, jk, wi) = (doubled(i, k), doubled(j, k), doubled(w, i));
        // R of (2): its last row and its first column.
        let (r11, r21, r31) = (ww + ii - jj - kk, wk + ij, ik - wj);
        let (r12, r13) = (ij - wk, wj + ik);
        let (r32, r33) = (wi + jk, ww - ii - jj + kk);
        if r31.abs().value() < 1.0 {
            let pitch = -r31.asin();
            let cosine = pitch.cos();
            return Vector3::new(
                (r32 / cosine).atan2(r33 / cosine),
                pitch,
                (r21 / cosine).atan2(r11 / cosine),
            );
        }
        // At θ = ±90° only the sum or the difference of φ and ψ is known: ψ counts as zero.
        let right_angle = T::constant(core::f64::consts::FRAC_PI_2);
        if r31.value() < 0.0 {
            Vector3::new(r12.atan2(r13), right_angle, T::zero())
        } else {
            Vector3::new(-r12.atan2(-r13), -right_angle, T::zero())
        }
    }
}

/// v + 2 w (q × v) + 2 q × (q × v)
fn rotated<T: Real>(axis: &Vector3<T>, scalar: T, vector: &Vector3<T>) -> Vector3<T> {
    let doubled = axis.cross(vector) * T::constant(2.0);
    doubled * scalar + axis.cross(&doubled) + vector
}

/// q ⊗ [0, v], Hamilton's product.
pub(crate) fn times_imaginary<T: Real>(attitude: &Quaternion<T>, vector: &Vector3<T>) -> Quaternion<T> {
    let [i, j, k, w] = attitude.coords.into();
    let [x, y, z]: [T; 3] = (*vector).into();
    Quaternion {
        coords: Vector4::new(
            w * x + j * z - k * y,
            w * y - i * z + k * x,
            w * z + i * y - j * x,
            -(i * x) - j * y - k * z,
        ),
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Quaternion, UnitQuaternion, Vector3};
    use proptest::prelude::*;

    use super::{Orientation, times_imaginary};

    proptest! {
        /// The doubles are nalgebra's, bit for bit.
        #[test]
        fn it_is_nalgebras_unit_quaternion(
            [w, i, j, k] in prop::array::uniform4(-1.0..1.0), vector in prop::array::uniform3(-9.0..9.0),
        ) {
            let (attitude, vector) = (Quaternion::new(w, i, j, k), Vector3::from(vector));
            let (ours, theirs) = (Orientation::new(&attitude), UnitQuaternion::new_normalize(attitude));
            prop_assert_eq!((ours.vector, ours.scalar), (theirs.imag(), theirs.w));
            prop_assert_eq!(ours.in_world(&vector), theirs * vector);
            prop_assert_eq!(ours.in_body(&vector), theirs.inverse_transform_vector(&vector));
            let (phi, theta, psi) = theirs.euler_angles();
            prop_assert_eq!(ours.euler_angles(), Vector3::new(phi, theta, psi));
            prop_assert_eq!(times_imaginary(&attitude, &vector), attitude * Quaternion::from_imag(vector));
        }
    }

    #[test]
    fn nose_up_and_nose_down_are_nalgebras() {
        for (w, j) in [(1.0, 1.0), (1.0, -1.0)] {
            for turn in [0.0, 0.7, -2.0] {
                let attitude = Quaternion::new(0.0, 0.0, 0.0, 1.0) * turn + Quaternion::new(w, 0.0, j, 0.0);
                let (phi, theta, psi) = UnitQuaternion::new_normalize(attitude).euler_angles();
                let ours = Orientation::new(&attitude).euler_angles();
                assert_eq!(ours, Vector3::new(phi, theta, psi));
            }
        }
    }
}
