//! The motion of the vehicle as it is measured.

use nalgebra::{Quaternion, UnitQuaternion};
use quadrotor::{Airframe, RigidBody};
use serde::{Deserialize, Serialize};

use super::{AttitudeMeasurement, ControllerError, Measurements, RotorSpeedMeasurement};

/// A motion as it is measured; of attitude and rotor speeds what [`Measurements`] chooses.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredMotion {
    /// Position in NED, m.
    pub position_m: [f64; 3],
    /// Velocity in NED, m/s.
    pub velocity_m_s: [f64; 3],
    /// Hamilton quaternion q₀ … q₃, scalar first, FRD into NED; its norm does not matter.
    pub quaternion: [f64; 4],
    /// Euler angles φ, θ, ψ (ZYX), rad.
    pub attitude_rad: [f64; 3],
    /// p, q, r in FRD, rad/s.
    pub body_rate_rad_s: [f64; 3],
    /// Speeds of the rotors in the order of the airframe's layout, rad/s.
    pub rotor_speed_rad_s: [f64; 4],
}

/// The default airframe in hover at the origin.
impl Default for MeasuredMotion {
    fn default() -> Self {
        Self {
            position_m: [0.0; 3],
            velocity_m_s: [0.0; 3],
            quaternion: [1.0, 0.0, 0.0, 0.0],
            attitude_rad: [0.0; 3],
            body_rate_rad_s: [0.0; 3],
            rotor_speed_rad_s: [Airframe::default().hover_rotor_speed_rad_s(); 4],
        }
    }
}

/// A component with the name of its variable.
type Named = (&'static str, f64);

impl MeasuredMotion {
    /// The rigid body.
    ///
    /// # Errors
    /// [`ControllerError::NotFinite`] and [`ControllerError::NoAttitude`].
    pub(super) fn body(
        &self,
        measurements: Measurements,
        time_us: u64,
    ) -> Result<RigidBody, ControllerError> {
        self.check(measurements, time_us)?;
        Ok(RigidBody {
            position_m: self.position_m.into(),
            velocity_m_s: self.velocity_m_s.into(),
            attitude: match measurements.attitude {
                AttitudeMeasurement::Quaternion => self.rotation(),
                AttitudeMeasurement::EulerAngles => {
                    let [phi, theta, psi] = self.attitude_rad;
                    UnitQuaternion::from_euler_angles(phi, theta, psi).into_inner()
                }
            },
            body_rate_rad_s: self.body_rate_rad_s.into(),
        })
    }

    fn rotation(&self) -> Quaternion<f64> {
        let [w, i, j, k] = self.quaternion;
        Quaternion::new(w, i, j, k)
    }

    fn check(&self, measurements: Measurements, time_us: u64) -> Result<(), ControllerError> {
        /// Least squared norm of a quaternion: shorter ones are interpolated between attitudes that have nothing in common, or not connected.
        const LEAST: f64 = 0.25;
        let finite = |names: &[Named]| match names.iter().find(|(_, value)| !value.is_finite()) {
            Some((name, _)) => Err(ControllerError::NotFinite { name, time_us }),
            None => Ok(()),
        };
        finite(&self.translation())?;
        match measurements.attitude {
            AttitudeMeasurement::Quaternion => {
                finite(&self.named_quaternion())?;
                if self.rotation().norm_squared() <= LEAST {
                    return Err(ControllerError::NoAttitude { quaternion: self.quaternion, time_us });
                }
            }
            AttitudeMeasurement::EulerAngles => finite(&self.euler_angles())?,
        }
        match measurements.rotor_speeds {
            RotorSpeedMeasurement::Measured => finite(&self.rotors()),
            RotorSpeedMeasurement::Predicted => Ok(()),
        }
    }

    fn translation(&self) -> [Named; 9] {
        let ([x, y, z], [u, v, w], [p, q, r]) = (self.position_m, self.velocity_m_s, self.body_rate_rad_s);
        [
            ("measured.position.x", x),
            ("measured.position.y", y),
            ("measured.position.z", z),
            ("measured.velocity.x", u),
            ("measured.velocity.y", v),
            ("measured.velocity.z", w),
            ("measured.body_rate.p", p),
            ("measured.body_rate.q", q),
            ("measured.body_rate.r", r),
        ]
    }

    fn named_quaternion(&self) -> [Named; 4] {
        let [w, i, j, k] = self.quaternion;
        [
            ("measured.attitude.q0", w),
            ("measured.attitude.q1", i),
            ("measured.attitude.q2", j),
            ("measured.attitude.q3", k),
        ]
    }

    fn euler_angles(&self) -> [Named; 3] {
        let [phi, theta, psi] = self.attitude_rad;
        [("measured.attitude.phi", phi), ("measured.attitude.theta", theta), ("measured.attitude.psi", psi)]
    }

    fn rotors(&self) -> [Named; 4] {
        let [one, two, three, four] = self.rotor_speed_rad_s;
        [
            ("measured.rotor.speed[1]", one),
            ("measured.rotor.speed[2]", two),
            ("measured.rotor.speed[3]", three),
            ("measured.rotor.speed[4]", four),
        ]
    }
}
