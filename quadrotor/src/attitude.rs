//! Angles and differences of attitudes.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

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
    let upright = libm::sqrt(w * w + z * z);
    let leaning = libm::sqrt(x * x + y * y);
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

/// An angle by its sine and cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Angle {
    pub(crate) sine: f64,
    pub(crate) cosine: f64,
}

impl Angle {
    /// Of an angle, rad.
    pub(crate) fn new(angle_rad: f64) -> Self {
        let (sine, cosine) = libm::sincos(angle_rad);
        Self { sine, cosine }
    }

    /// A vector that is turned by it about the down axis.
    pub(crate) fn turned(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        let Self { sine, cosine } = *self;
        let (x, y) = (cosine * vector.x - sine * vector.y, sine * vector.x + cosine * vector.y);
        Vector3::new(x, y, vector.z)
    }

    /// Within ±π, rad.
    pub(crate) fn rad(&self) -> f64 {
        libm::atan2(self.sine, self.cosine)
    }

    /// Half of the angle within ±π: cos² (α/2) = (1 + cos α)/2, sin² (α/2) = (1 − cos α)/2, sin α = 2 sin (α/2) cos (α/2).
    fn half(&self) -> Self {
        let larger = libm::sqrt((1.0 + libm::fabs(self.cosine)) / 2.0);
        if self.cosine >= 0.0 {
            Self { sine: self.sine / (2.0 * larger), cosine: larger }
        } else {
            Self { sine: larger.copysign(self.sine), cosine: libm::fabs(self.sine) / (2.0 * larger) }
        }
    }
}

/// The attitude of roll φ, pitch θ and yaw ψ (ZYX).
pub(crate) fn attitude_of(angles: [Angle; 3]) -> UnitQuaternion<f64> {
    let [roll, pitch, yaw] = angles.map(|angle| angle.half());
    let (level, tilted) = (roll.cosine * pitch.cosine, roll.sine * pitch.sine);
    let (rolled, pitched) = (roll.sine * pitch.cosine, roll.cosine * pitch.sine);
    UnitQuaternion::new_unchecked(Quaternion::new(
        level * yaw.cosine + tilted * yaw.sine,
        rolled * yaw.cosine - pitched * yaw.sine,
        pitched * yaw.cosine + rolled * yaw.sine,
        level * yaw.sine - tilted * yaw.cosine,
    ))
}

/// Roll φ and pitch θ under which the thrust axis (body up) points against `thrust_axis_down`, a unit vector in NED, with a heading ψ:
/// `R(φ, θ, ψ) e₃ = thrust_axis_down`. φ is within ±π/2.
pub(crate) fn tilt_angles(thrust_axis_down: &Vector3<f64>, yaw: Angle) -> [Angle; 2] {
    let Angle { sine, cosine } = yaw;
    // In the axes of the heading: R_z(−ψ) b₃ = [cos φ sin θ, −sin φ, cos φ cos θ]ᵀ
    let x = cosine * thrust_axis_down.x + sine * thrust_axis_down.y;
    let y = -sine * thrust_axis_down.x + cosine * thrust_axis_down.y;
    let z = thrust_axis_down.z;
    let upright = libm::sqrt(x * x + z * z);
    // Along the lateral axis any pitch will do.
    let pitch = if upright > 0.0 {
        Angle { sine: x / upright, cosine: z / upright }
    } else {
        Angle { sine: 0.0, cosine: 1.0 }
    };
    [Angle { sine: -y, cosine: upright }, pitch]
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    use nalgebra::{UnitQuaternion, Vector3};
    use proptest::prelude::*;

    use super::{Angle, attitude_error, attitude_of, tilt_angles, turned, wrapped};

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
            x in -1.0..1.0, y in -1.0..1.0, z in -1.0..1.0, psi in -9.0..9.0,
        ) {
            let (axis, yaw) = (Vector3::new(x, y, z).normalize(), Angle::new(psi));
            let [roll, pitch] = tilt_angles(&axis, yaw);
            let pointed = attitude_of([roll, pitch, yaw]) * Vector3::z();
            prop_assert!((pointed - axis).norm() < 1e-12);
            let of_angles = attitude(roll.rad(), pitch.rad(), psi) * Vector3::z();
            prop_assert!((of_angles - axis).norm() < 1e-12);
        }

        /// Whole turns aside, and the sign, which means nothing.
        #[test]
        fn an_attitude_follows_from_sines_and_cosines(phi in -9.0..9.0, theta in -9.0..9.0, psi in -9.0..9.0) {
            let (ours, theirs) = (attitude_of([phi, theta, psi].map(Angle::new)), attitude(phi, theta, psi));
            let apart = (ours.coords - theirs.coords).norm().min((ours.coords + theirs.coords).norm());
            prop_assert!(apart < 1e-14, "{ours} {theirs}");
        }
    }

    #[test]
    fn an_angle_is_halved_at_its_ends() {
        for (angle, half) in [(0.0, 0.0), (FRAC_PI_2, FRAC_PI_4), (-FRAC_PI_2, -FRAC_PI_4)] {
            let Angle { sine, cosine } = Angle::new(angle).half();
            assert!((sine - half.sin()).abs() < 1e-15 && (cosine - half.cos()).abs() < 1e-15, "{angle}");
        }
        let about = Angle { sine: 0.0, cosine: -1.0 }.half();
        assert_eq!((about.sine, about.cosine), (1.0, 0.0));
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
