//! Angles and differences of attitudes.

use nalgebra::{UnitQuaternion, Vector3};

/// An angle brought into [−π, π), rad.
pub(crate) fn wrapped(angle_rad: f64) -> f64 {
    const TURN: f64 = core::f64::consts::TAU;
    angle_rad - TURN * libm::floor(angle_rad / TURN + 0.5)
}

/// The rotation vector that takes `from` to `to`, in the axes of `from`, rad: the short way, which for
/// one sample of motion is the angle turned about each body axis.
pub(crate) fn turned(from: &UnitQuaternion<f64>, to: &UnitQuaternion<f64>) -> Vector3<f64> {
    (from.inverse() * to).scaled_axis()
}

/// Error of an attitude against a reference in body axes, rad: how far the thrust axis leans off (x and
/// y), and how far the heading is turned once the thrust axes coincide (z).
///
/// q_error = q_referenceᵀ ⊗ q = (w, x, y, z) splits into a tilt about a horizontal axis and a turn about
/// the thrust axis (Brescianini and D'Andrea 2018): cos(tilt/2) = √(w² + z²), turn = 2 atan2(z, w). For
/// small angles the three are φ, θ, ψ minus their references. When the vehicle is upside down the turn
/// has no meaning and counts as 0.
pub(crate) fn attitude_error(
    reference: &UnitQuaternion<f64>,
    attitude: &UnitQuaternion<f64>,
) -> Vector3<f64> {
    let error = reference.inverse() * attitude;
    let (w, x, y, z) = (error.w, error.i, error.j, error.k);
    let upright = libm::hypot(w, z);
    let leaning = libm::hypot(x, y);
    let tilt = 2.0 * libm::atan2(leaning, upright);
    // Below this the direction of the lean is not computable, nor needed.
    const TINY: f64 = 1e-9;
    let turn = if upright > TINY { wrapped(2.0 * libm::atan2(z, w)) } else { 0.0 };
    if leaning <= TINY {
        return Vector3::new(2.0 * x, 2.0 * y, turn);
    }
    // With the tilt axis [a_x a_y] in the reference, [x y] is it turned by −turn/2 and times sin(tilt/2);
    // in body axes it is turned by −turn.
    let (sine, cosine) = if upright > TINY { (z / upright, w / upright) } else { (0.0, 1.0) };
    let tilt_x = tilt * (x * cosine + y * sine) / leaning;
    let tilt_y = tilt * (y * cosine - x * sine) / leaning;
    Vector3::new(tilt_x, tilt_y, turn)
}

/// The attitude with a heading ψ, rad, whose thrust axis (body up) points against `thrust_axis_down`, a
/// vector in NED that need not be normalised: the angles φ, θ of `R(φ, θ, ψ) e₃ ∥ thrust_axis_down`.
pub(crate) fn tilt_angles(thrust_axis_down: &Vector3<f64>, yaw_rad: f64) -> (f64, f64) {
    let (sine, cosine) = (libm::sin(yaw_rad), libm::cos(yaw_rad));
    // In the axes of the heading: R_z(−ψ) b₃ = [cos φ sin θ, −sin φ, cos φ cos θ]ᵀ
    let x = cosine * thrust_axis_down.x + sine * thrust_axis_down.y;
    let y = -sine * thrust_axis_down.x + cosine * thrust_axis_down.y;
    let z = thrust_axis_down.z;
    let phi = libm::atan2(-y, libm::hypot(x, z));
    let theta = libm::atan2(x, z);
    (phi, theta)
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};
    use proptest::prelude::*;

    use super::{attitude_error, tilt_angles, turned, wrapped};

    fn attitude(phi: f64, theta: f64, psi: f64) -> UnitQuaternion<f64> {
        UnitQuaternion::from_euler_angles(phi, theta, psi)
    }

    proptest! {
        #[test]
        fn wrapping_keeps_the_direction(angle in -100.0..100.0) {
            let near = wrapped(angle);
            prop_assert!((-core::f64::consts::PI..core::f64::consts::PI).contains(&near));
            prop_assert!((libm::sin(angle) - libm::sin(near)).abs() < 1e-12);
            prop_assert!((libm::cos(angle) - libm::cos(near)).abs() < 1e-12);
        }

        /// A tilt about a body axis that follows a turn is measured about that body axis.
        #[test]
        fn error_separates_turn_and_tilt(tilt in 0.0..3.0, direction in -3.1..3.1, turn in -3.1..3.1) {
            let axis = Vector3::new(libm::cos(direction), libm::sin(direction), 0.0);
            let reference = attitude(0.2, -0.3, 0.4);
            let body = reference
                * UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, turn))
                * UnitQuaternion::from_scaled_axis(axis * tilt);
            let error = attitude_error(&reference, &body);
            let expected: Vector3<f64> = axis * tilt + Vector3::new(0.0, 0.0, turn);
            prop_assert!((error - expected).norm() < 1e-9, "{error}");
        }

        /// For small angles the error is the difference of the Euler angles: the paper's case.
        #[test]
        fn small_error_is_the_difference_of_euler_angles(
            phi in -1e-4..1e-4, theta in -1e-4..1e-4, psi in -1e-4..1e-4,
        ) {
            let error = attitude_error(&attitude(0.0, 0.0, 0.0), &attitude(phi, theta, psi));
            prop_assert!((error - Vector3::new(phi, theta, psi)).norm() < 1e-7);
        }

        #[test]
        fn tilt_angles_point_the_thrust_axis(
            x in -1.0..1.0, y in -1.0..1.0, z in 0.1..1.0, psi in -3.0..3.0,
        ) {
            let axis = Vector3::new(x, y, z).normalize();
            let (phi, theta) = tilt_angles(&axis, psi);
            let pointed = attitude(phi, theta, psi) * Vector3::z();
            prop_assert!((pointed - axis).norm() < 1e-12);
        }
    }

    /// Half a turn about a horizontal axis: the heading has no meaning there and counts as none.
    #[test]
    fn upside_down_the_whole_error_is_a_lean() {
        for direction in [0.0, 0.7, -2.0] {
            let axis = Vector3::new(libm::cos(direction), libm::sin(direction), 0.0);
            let over = UnitQuaternion::from_scaled_axis(axis * core::f64::consts::PI);
            let error = attitude_error(&UnitQuaternion::identity(), &over);
            assert!((error - axis * core::f64::consts::PI).norm() < 1e-7, "{error}");
        }
    }

    /// Beside a lean of a billionth a turn of any size is seen whole.
    #[test]
    fn a_pure_turn_is_a_turn() {
        for turn in [-3.0, -0.1, 0.0, 2.0] {
            let error = attitude_error(&attitude(0.0, 0.0, 0.5), &attitude(0.0, 0.0, 0.5 + turn));
            assert!((error - Vector3::new(0.0, 0.0, turn)).norm() < 1e-12, "{error}");
        }
    }

    #[test]
    fn a_rotation_is_turned_by_its_axis_and_angle() {
        let (from, by) = (attitude(0.3, -0.2, 1.1), Vector3::new(0.4, -0.5, 0.6));
        let to = from * UnitQuaternion::from_scaled_axis(by);
        assert!((turned(&from, &to) - by).norm() < 1e-14);
    }
}
