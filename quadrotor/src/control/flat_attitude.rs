//! Differential flatness: the attitude and its motion that a trajectory and a heading require.
//!
//! A quadrotor without drag is differentially flat in its position and its heading (Mellinger and Kumar 2011, "Minimum snap
//! trajectory generation and control for quadrotors"; Faessler, Franchi and Scaramuzza 2018 write the rates as used here). In
//! NED and FRD the thrust per mass f acts along −b₃:
//!
//! ```text
//! t = g e₃ − a = f b₃      ṫ = −j      ẗ = −s         with acceleration a, jerk j, snap s
//! f' = b₃·ṫ                ḃ₃ = (ṫ − f' b₃)/f
//! f" = ḃ₃·ṫ + b₃·ẗ         b̈₃ = (ẗ − f" b₃ − 2 f' ḃ₃)/f
//! ```
//!
//! From R = R_z(ψ) R_y(θ) R_x(φ) = [b₁ b₂ b₃] and Ṙ = R [ω]ₓ follow
//!
//! ```text
//! p = −b₂·ḃ₃     q = b₁·ḃ₃     q sin φ + r cos φ = ψ̇ cos θ
//! ṗ = −b₂·b̈₃ + q r     q̇ = b₁·b̈₃ − p r     ṙ from the derivative of the last equation
//! ```

use nalgebra::{UnitQuaternion, Vector3};

use crate::attitude::{Angle, attitude_of, tilt_angles};
use crate::guidance::heading::Heading;
use crate::{GRAVITY_M_S2, PositionReference};

/// Below this thrust per mass, m/s², the rates count as if it were this large: in free fall the direction of the thrust is
/// arbitrary, and near it the rates are larger than any vehicle's.
const LEAST_THRUST_M_S2: f64 = 0.5;
/// Below this thrust per mass, m/s², its direction is taken to be up.
const NO_THRUST_M_S2: f64 = 1e-6;
/// Below this cos φ (about 87°) the yaw rate is reduced smoothly to zero: with the thrust along the lateral axis of the heading,
/// no attitude keeps the heading.
const LEAST_COS_ROLL: f64 = 0.05;

/// An attitude, how it turns, and the thrust, all of which follow from a point of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatAttitude {
    /// FRD into NED, with the heading ψ of ZYX Euler angles.
    pub attitude: UnitQuaternion<f64>,
    /// φ and θ.
    tilt: [Angle; 2],
    /// p, q, r in the axes of this attitude, rad/s.
    pub body_rate_rad_s: Vector3<f64>,
    /// ṗ, q̇, ṙ in the axes of this attitude, rad/s².
    pub angular_acceleration_rad_s2: Vector3<f64>,
    /// f, thrust per mass, m/s².
    pub thrust_m_s2: f64,
    /// Its derivative, m/s³.
    pub thrust_rate_m_s3: f64,
}

/// The thrust per mass f b₃ that a point of a trajectory requires, and how it changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FlatThrust {
    /// f, m/s².
    pub(crate) size_m_s2: f64,
    /// f', m/s³.
    pub(crate) size_rate_m_s3: f64,
    /// f", m/s⁴.
    pub(crate) size_acceleration_m_s4: f64,
    /// b₃, NED.
    pub(crate) down: Vector3<f64>,
    /// ḃ₃, 1/s.
    pub(crate) down_rate: Vector3<f64>,
    /// b̈₃, 1/s².
    down_acceleration: Vector3<f64>,
}

impl FlatThrust {
    /// Of an acceleration, m/s², with jerk, m/s³, and snap, m/s⁴, in NED.
    pub(crate) fn new(
        acceleration_m_s2: &Vector3<f64>,
        jerk_m_s3: &Vector3<f64>,
        snap_m_s4: &Vector3<f64>,
    ) -> Self {
        // t = g e₃ − a = f b₃
        let thrust = Vector3::z() * GRAVITY_M_S2 - acceleration_m_s2;
        let (first, second) = (-jerk_m_s3, -snap_m_s4);
        let size_m_s2 = thrust.norm();
        let down = if size_m_s2 > NO_THRUST_M_S2 { thrust * (1.0 / size_m_s2) } else { Vector3::z() };
        let per_thrust = 1.0 / size_m_s2.max(LEAST_THRUST_M_S2);
        // f' = b₃·ṫ,  ḃ₃ = (ṫ − f' b₃)/f
        let size_rate_m_s3 = down.dot(&first);
        let down_rate = (first - down * size_rate_m_s3) * per_thrust;
        // f" = ḃ₃·ṫ + b₃·ẗ,  b̈₃ = (ẗ − f" b₃ − 2 f' ḃ₃)/f
        let size_acceleration_m_s4 = down_rate.dot(&first) + down.dot(&second);
        let down_acceleration =
            (second - down * size_acceleration_m_s4 - down_rate * (2.0 * size_rate_m_s3)) * per_thrust;
        Self { size_m_s2, size_rate_m_s3, size_acceleration_m_s4, down, down_rate, down_acceleration }
    }
}

impl FlatAttitude {
    /// Of a point of a trajectory.
    pub fn of(reference: &PositionReference) -> Self {
        Self::new(
            &reference.acceleration_m_s2,
            &reference.jerk_m_s3,
            &reference.snap_m_s4,
            &Heading::of(reference),
        )
    }

    /// Of an acceleration, m/s², with jerk, m/s³, and snap, m/s⁴, in NED, and of a heading.
    ///
    /// Every finite input has a finite result. In free fall, the attitude is level. Where the thrust is along the lateral axis of
    /// the heading, the yaw rate and acceleration are zero.
    pub fn new(
        acceleration_m_s2: &Vector3<f64>,
        jerk_m_s3: &Vector3<f64>,
        snap_m_s4: &Vector3<f64>,
        heading: &Heading,
    ) -> Self {
        let thrust = FlatThrust::new(acceleration_m_s2, jerk_m_s3, snap_m_s4);
        let yaw = Angle::new(heading.yaw_rad);
        let [roll, pitch] = tilt_angles(&thrust.down, yaw);
        let attitude = attitude_of([roll, pitch, yaw]);
        let in_body = attitude.inverse();
        let turn = Turn { roll, pitch, yaw: (heading.yaw_rate_rad_s, heading.yaw_acceleration_rad_s2) };
        let (body_rate_rad_s, angular_acceleration_rad_s2) =
            turn.of(&(in_body * thrust.down_rate), &(in_body * thrust.down_acceleration));
        Self {
            attitude,
            tilt: [roll, pitch],
            body_rate_rad_s,
            angular_acceleration_rad_s2,
            thrust_m_s2: thrust.size_m_s2,
            thrust_rate_m_s3: thrust.size_rate_m_s3,
        }
    }
}

impl FlatAttitude {
    /// φ and θ, rad.
    pub fn tilt_rad(&self) -> [f64; 2] {
        self.tilt.map(|angle| angle.rad())
    }
}

/// φ, θ, and ψ̇ and ψ̈.
struct Turn {
    roll: Angle,
    pitch: Angle,
    yaw: (f64, f64),
}

impl Turn {
    /// Body rates and angular accelerations from ḃ₃ and b̈₃ in body axes.
    fn of(&self, down_rate: &Vector3<f64>, down_acceleration: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let Angle { sine: sin_roll, cosine: cos_roll } = self.roll;
        let Angle { sine: sin_pitch, cosine: cos_pitch } = self.pitch;
        let (yaw_rate, yaw_acceleration) = self.yaw;
        // 1/cos φ, which goes to zero with cos φ instead of to infinity.
        let inverse = cos_roll / (cos_roll * cos_roll).max(LEAST_COS_ROLL * LEAST_COS_ROLL);
        // ḃ₃ = R (ω × e₃) = R [q −p 0]ᵀ
        let (p, q) = (-down_rate.y, down_rate.x);
        // q sin φ + r cos φ = ψ̇ cos θ
        let r = (yaw_rate * cos_pitch - q * sin_roll) * inverse;
        // b̈₃ = R (ω × (ω × e₃) + ω̇ × e₃)
        let p_rate = -down_acceleration.y + q * r;
        let q_rate = down_acceleration.x - p * r;
        // θ̇ = q cos φ − r sin φ,  φ̇ = p + ψ̇ sin θ
        let pitch_rate = q * cos_roll - r * sin_roll;
        let roll_rate = p + yaw_rate * sin_pitch;
        // q̇ sin φ + q cos φ φ̇ + ṙ cos φ − r sin φ φ̇ = ψ̈ cos θ − ψ̇ sin θ θ̇
        let r_rate = (yaw_acceleration * cos_pitch
            - yaw_rate * sin_pitch * pitch_rate
            - q_rate * sin_roll
            - (q * cos_roll - r * sin_roll) * roll_rate)
            * inverse;
        (Vector3::new(p, q, r), Vector3::new(p_rate, q_rate, r_rate))
    }
}

#[cfg(test)]
mod tests {
    use alloc::format;
    use alloc::string::String;

    use nalgebra::{UnitQuaternion, Vector3};
    use proptest::prelude::*;

    use super::FlatAttitude;
    use crate::guidance::heading::Heading;
    use crate::{GRAVITY_M_S2, PositionReference};

    /// x = A sin(ω t + c) on each axis and a heading that does the same about a turn, with exact derivatives.
    #[derive(Clone, Copy, Debug)]
    struct Trajectory {
        amplitude: [f64; 4],
        rate: [f64; 4],
        phase: [f64; 4],
        turn_rad_s: f64,
    }

    impl Trajectory {
        fn derivative(&self, axis: usize, order: i32, t: f64) -> f64 {
            let (a, w, c) = (self.amplitude[axis], self.rate[axis], self.phase[axis]);
            a * w.powi(order) * (w * t + c + f64::from(order) * core::f64::consts::FRAC_PI_2).sin()
        }

        fn vector(&self, order: i32, t: f64) -> Vector3<f64> {
            Vector3::from_fn(|axis, _| self.derivative(axis, order, t))
        }

        fn reference(&self, t: f64) -> PositionReference {
            PositionReference {
                position_m: self.vector(0, t),
                velocity_m_s: self.vector(1, t),
                acceleration_m_s2: self.vector(2, t),
                jerk_m_s3: self.vector(3, t),
                snap_m_s4: self.vector(4, t),
                yaw_rad: self.derivative(3, 0, t) + self.turn_rad_s * t,
                yaw_rate_rad_s: self.derivative(3, 1, t) + self.turn_rad_s,
                yaw_acceleration_rad_s2: self.derivative(3, 2, t),
            }
        }

        fn flat(&self, t: f64) -> FlatAttitude {
            FlatAttitude::of(&self.reference(t))
        }
    }

    /// 6 sin(ω t), 3 sin(2 ω t).
    fn figure_eight(rate: f64, turn_rad_s: f64) -> Trajectory {
        Trajectory {
            amplitude: [6.0, 3.0, 0.5, 0.4],
            rate: [rate, 2.0 * rate, 1.3 * rate, 0.8],
            phase: [0.0, 0.0, 0.3, 0.0],
            turn_rad_s,
        }
    }

    /// A circle of 4 m: 5.8 m/s² at 1.2 rad/s, 9 m/s² at 1.5 rad/s.
    fn circle(rate: f64, turn_rad_s: f64) -> Trajectory {
        let phase = [core::f64::consts::FRAC_PI_2, 0.0, 0.0, 0.0];
        Trajectory { amplitude: [4.0, 4.0, 0.0, 0.0], rate: [rate, rate, 1.0, 1.0], phase, turn_rad_s }
    }

    /// The central difference of fourth order of a function of time.
    fn difference(of: impl Fn(f64) -> Vector3<f64>, t: f64) -> Vector3<f64> {
        const H: f64 = 1e-3;
        (of(t - 2.0 * H) - of(t + 2.0 * H) + (of(t + H) - of(t - H)) * 8.0) / (12.0 * H)
    }

    /// ω = (log of R(t)ᵀ R(t + h))/h about h = 0.
    fn rate_of_attitude(trajectory: &Trajectory, t: f64) -> Vector3<f64> {
        let now = trajectory.flat(t).attitude;
        difference(|later| (now.inverse() * trajectory.flat(later).attitude).scaled_axis(), t)
    }

    fn near(found: &Vector3<f64>, expected: &Vector3<f64>) -> bool {
        (found - expected).norm() <= 1e-6 * expected.norm().max(1.0)
    }

    fn check(trajectory: &Trajectory, t: f64) -> Result<(), String> {
        let flat = trajectory.flat(t);
        let down = flat.attitude * Vector3::z();
        let thrust = Vector3::z() * GRAVITY_M_S2 - trajectory.vector(2, t);
        let rate = rate_of_attitude(trajectory, t);
        let acceleration = difference(|later| trajectory.flat(later).body_rate_rad_s, t);
        let thrust_rate = difference(|later| Vector3::x() * trajectory.flat(later).thrust_m_s2, t).x;
        let yaw = trajectory.reference(t).yaw_rad;
        let heading = UnitQuaternion::from_euler_angles(0.0, 0.0, yaw) * Vector3::y();
        let holds = near(&(down * flat.thrust_m_s2), &thrust)
            // No part of the forward axis points to the side of the heading.
            && (flat.attitude * Vector3::x()).dot(&heading).abs() < 1e-12
            && near(&flat.body_rate_rad_s, &rate)
            && near(&flat.angular_acceleration_rad_s2, &acceleration)
            && (flat.thrust_rate_m_s3 - thrust_rate).abs() < 1e-6 * thrust_rate.abs().max(1.0);
        if holds { Ok(()) } else { Err(format!("t {t} {flat:?} {rate} {acceleration} {thrust_rate}")) }
    }

    #[test]
    fn rates_and_accelerations_are_the_derivatives_of_the_attitude() {
        for turn_rad_s in [0.0, 0.9, -2.0] {
            for trajectory in [
                figure_eight(0.7, turn_rad_s),
                figure_eight(0.85, turn_rad_s),
                figure_eight(1.5, turn_rad_s),
                circle(1.2, turn_rad_s),
                circle(1.5, turn_rad_s),
            ] {
                for step in 0..200 {
                    check(&trajectory, 0.05 * f64::from(step)).unwrap();
                }
            }
        }
    }

    proptest! {
        #[test]
        fn they_are_on_any_smooth_trajectory(
            amplitude in prop::array::uniform4(0.0..3.0_f64), rate in prop::array::uniform4(0.2..1.4_f64),
            phase in prop::array::uniform4(-3.0..3.0_f64), turn_rad_s in -2.0..2.0_f64, t in 0.0..10.0_f64,
        ) {
            let trajectory = Trajectory { amplitude, rate, phase, turn_rad_s };
            let checked = check(&trajectory, t);
            prop_assert!(checked.is_ok(), "{checked:?}");
        }

        /// Whatever is asked for, also free fall, thrust downwards and thrust along any horizontal axis: no rate is infinite.
        #[test]
        fn nothing_is_infinite(
            down in -1.0..2.0_f64, [x, y] in prop::array::uniform2(prop_oneof![Just(0.0), -20.0..20.0_f64]),
            jerk in prop::array::uniform3(-50.0..50.0_f64), snap in prop::array::uniform3(-200.0..200.0_f64),
            quarter in 0..4, rate in -5.0..5.0_f64,
        ) {
            let heading = Heading {
                yaw_rad: f64::from(quarter) * core::f64::consts::FRAC_PI_2,
                yaw_rate_rad_s: rate,
                yaw_acceleration_rad_s2: rate,
            };
            for down in [down, 1.0] {
                let acceleration = Vector3::new(x, y, down * GRAVITY_M_S2);
                let flat = FlatAttitude::new(&acceleration, &jerk.into(), &snap.into(), &heading);
                let numbers = flat.attitude.coords.iter().chain(&flat.body_rate_rad_s)
                    .chain(&flat.angular_acceleration_rad_s2)
                    .chain([&flat.thrust_m_s2, &flat.thrust_rate_m_s3]);
                prop_assert!(numbers.copied().all(f64::is_finite), "{flat:?}");
            }
        }
    }

    #[test]
    fn hover_is_level_and_turns_with_the_heading() {
        let rest = PositionReference::goal([1.0, 2.0, -3.0], 0.7);
        let flat = FlatAttitude::of(&PositionReference {
            yaw_rate_rad_s: 0.5,
            yaw_acceleration_rad_s2: -0.2,
            ..rest
        });
        let level = UnitQuaternion::from_euler_angles(0.0, 0.0, 0.7);
        assert!(flat.attitude.angle_to(&level) < 1e-12);
        assert!((flat.body_rate_rad_s - Vector3::new(0.0, 0.0, 0.5)).norm() < 1e-12);
        assert!((flat.angular_acceleration_rad_s2 - Vector3::new(0.0, 0.0, -0.2)).norm() < 1e-12);
        assert_eq!((flat.thrust_m_s2, flat.thrust_rate_m_s3), (GRAVITY_M_S2, 0.0));
    }

    /// φ = 90° with its heading: the yaw rate fades out, and comes back beyond.
    #[test]
    fn near_a_lateral_thrust_the_yaw_rate_goes_to_zero() {
        let yaw_rate = |roll: f64| {
            let thrust = Vector3::new(0.0, -roll.sin(), roll.cos()) * GRAVITY_M_S2;
            let acceleration = Vector3::z() * GRAVITY_M_S2 - thrust;
            let heading = Heading { yaw_rad: 0.0, yaw_rate_rad_s: 1.0, yaw_acceleration_rad_s2: 0.0 };
            FlatAttitude::new(&acceleration, &Vector3::zeros(), &Vector3::zeros(), &heading).body_rate_rad_s.z
        };
        let right = core::f64::consts::FRAC_PI_2;
        assert!((yaw_rate(1.5) - 1.0 / 1.5_f64.cos()).abs() < 1e-9);
        assert!(yaw_rate(right).abs() < 1e-9 && yaw_rate(right - 1e-4).abs() < 0.05);
    }
}
