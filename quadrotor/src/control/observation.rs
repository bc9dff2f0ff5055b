//! What the controllers go by: the measurement, or what the Kalman predictor makes of it.

use nalgebra::{Matrix2, Vector3};

use crate::control::attitude_controller::VehicleRotation;
use crate::control::estimator::Estimator;
use crate::control::euler_equation::angular_acceleration_rad_s2;
use crate::control::vehicle_motion::{HorizontalMotion, VerticalMotion};
use crate::design::estimator_design::EstimatorDesign;
use crate::{Configuration, GRAVITY_M_S2, RigidBody, wrench_of_rotors};

/// The vehicle as the controllers see it at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Observation {
    /// What the sensors say.
    pub(crate) measured: RigidBody,
    /// What the controllers go by.
    pub(crate) body: RigidBody,
    /// Thrust per believed mass, m/s².
    lift_m_s2: f64,
    /// Acceleration that the thrust does not explain, NED, m/s².
    disturbance_m_s2: Vector3<f64>,
    /// How far that lags behind what it is, s.
    disturbance_lag_s: f64,
    /// Angular acceleration that the torques do not explain, FRD, rad/s².
    disturbance_rad_s2: Vector3<f64>,
    /// By so much that may be off by noise alone, rad/s².
    unsure_rad_s2: Vector3<f64>,
    /// Speeds that the rotors have reached by their model, rad/s.
    pub(crate) rotor_speed_rad_s: [f64; 4],
    /// Torque that they make at those speeds, FRD, N·m.
    rotor_torque_n_m: Vector3<f64>,
}

impl Observation {
    /// Of a measurement, beside what has been estimated until now by the predictors of a design.
    pub(crate) fn new(
        configuration: &Configuration,
        (estimator, design): (&Estimator, &EstimatorDesign),
        measured: &RigidBody,
        time_us: u64,
    ) -> Self {
        let body = estimator.seen(&configuration.sensors, measured, time_us);
        let rotor_speed_rad_s = estimator.rotor_speed_rad_s();
        let made = wrench_of_rotors(&configuration.airframe, &rotor_speed_rad_s);
        Self {
            measured: *measured,
            body,
            lift_m_s2: made.thrust_n / configuration.believed_mass_kg(),
            disturbance_m_s2: estimator.disturbance_m_s2(),
            disturbance_lag_s: design.disturbance_lag_s,
            disturbance_rad_s2: estimator.disturbance_rad_s2(),
            unsure_rad_s2: design.unsure_rad_s2,
            rotor_speed_rad_s,
            rotor_torque_n_m: made.torque_n_m,
        }
    }

    /// Motion north and east, when feedback of the attitude has asked for these angular accelerations, FRD, rad/s².
    pub(crate) fn horizontal(
        &self,
        configuration: &Configuration,
        asked_rad_s2: &Vector3<f64>,
    ) -> HorizontalMotion {
        // a = −R e₃ F/m, and as the body turns ȧ = −R (ω × e₃) F/m, ä = −R (ω̇ × e₃ + ω × (ω × e₃)) F/m
        let rotation = self.body.rotation();
        let turned = |by: &Vector3<f64>| (rotation * by.cross(&Vector3::z()) * -self.lift_m_s2).xy();
        let rate = &self.body.body_rate_rad_s;
        let going_on = rotation * rate.cross(&rate.cross(&Vector3::z())) * -self.lift_m_s2;
        let inertia = configuration.believed_inertia_kg_m2();
        let turning = angular_acceleration_rad_s2(&inertia, rate, &self.rotor_torque_n_m);
        HorizontalMotion {
            position_m: self.body.position_m.xy(),
            velocity_m_s: self.body.velocity_m_s.xy(),
            acceleration_m_s2: (rotation * Vector3::z() * -self.lift_m_s2).xy(),
            jerk_m_s3: turned(rate),
            snap_m_s4: turned(&turning) + going_on.xy(),
            asked_snap_m_s4: turned(asked_rad_s2),
            disturbance_m_s2: self.disturbance_m_s2.xy(),
            disturbance_lag_s: self.disturbance_lag_s,
            disturbance_rad_s2: self.disturbance_rad_s2.xy(),
            unsure_rad_s2: self.unsure_rad_s2.xy(),
            snap_by_turning: Matrix2::from_columns(&[turned(&Vector3::x()), turned(&Vector3::y())]),
        }
    }

    /// Motion down.
    pub(crate) fn vertical(&self) -> VerticalMotion {
        VerticalMotion {
            position_m: self.body.position_m.z,
            velocity_m_s: self.body.velocity_m_s.z,
            // z̈ = g − (R e₃)₃ F/m
            acceleration_m_s2: GRAVITY_M_S2 - (self.body.rotation() * Vector3::z()).z * self.lift_m_s2,
            disturbance_m_s2: self.disturbance_m_s2.z,
        }
    }

    /// Rotation.
    pub(crate) fn rotation(&self) -> VehicleRotation {
        VehicleRotation {
            attitude: self.body.rotation(),
            body_rate_rad_s: self.body.body_rate_rad_s,
            torque_n_m: self.rotor_torque_n_m,
            disturbance_rad_s2: self.disturbance_rad_s2,
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::Observation;
    use crate::control::estimator::Estimator;
    use crate::design::estimator_design::EstimatorDesign;
    use crate::{Configuration, GRAVITY_M_S2, RigidBody, wrench_of_rotors};

    /// Acceleration by the thrust along the axis that a body points up, m/s²: what the derivatives are taken of.
    fn acceleration(attitude: &UnitQuaternion<f64>, lift_m_s2: f64) -> Vector3<f64> {
        attitude * Vector3::new(0.0, 0.0, -lift_m_s2)
    }

    /// By differences over the body's rotation: the jerk of a body that turns at an even rate, and the snap of one that begins to turn.
    #[test]
    fn derivatives_are_those_of_the_turning_thrust() {
        const STEP_S: f64 = 1e-4;
        let configuration = Configuration::default();
        let rotor_speed_rad_s = [260.0, 251.0, 243.0, 266.0];
        let wrench = wrench_of_rotors(&configuration.airframe, &rotor_speed_rad_s);
        let lift_m_s2 = wrench.thrust_n / configuration.airframe.mass_kg;
        let attitude = UnitQuaternion::from_euler_angles(0.2, -0.3, 1.1);
        let rate = Vector3::new(0.4, -0.7, 0.9);
        let body = RigidBody {
            position_m: Vector3::new(1.0, 2.0, -3.0),
            velocity_m_s: Vector3::new(0.5, -0.25, 0.125),
            attitude: attitude.into_inner(),
            body_rate_rad_s: rate,
        };
        let estimator = Estimator::new(&configuration.sensors, &body, rotor_speed_rad_s, 0);
        let design = EstimatorDesign::new(&configuration).expect("a design");
        let seen = Observation::new(&configuration, (&estimator, &design), &body, 0);
        let asked_rad_s2 = Vector3::new(-1.5, 0.5, 0.0);
        let motion = seen.horizontal(&configuration, &asked_rad_s2);
        assert_eq!((motion.position_m, motion.velocity_m_s), (body.position_m.xy(), body.velocity_m_s.xy()));

        let now = acceleration(&attitude, lift_m_s2);
        assert!((motion.acceleration_m_s2 - now.xy()).norm() < 1e-12);
        assert!((seen.vertical().acceleration_m_s2 - GRAVITY_M_S2 - now.z).abs() < 1e-12);
        let turned = |by: Vector3<f64>| {
            acceleration(&(attitude * UnitQuaternion::from_scaled_axis(by)), lift_m_s2).xy()
        };
        let jerk = (turned(rate * STEP_S) - turned(-rate * STEP_S)) / (2.0 * STEP_S);
        assert!((motion.jerk_m_s3 - jerk).norm() < 1e-6, "{} {jerk}", motion.jerk_m_s3);
        // φ = ω̇ t²/2, from rest.
        let snap = |angular: Vector3<f64>| {
            let by = angular * (STEP_S * STEP_S / 2.0);
            (turned(by) - now.xy()) * 2.0 / (STEP_S * STEP_S)
        };
        // Euler's equations: the jerk a moment later and earlier, with the rate and the attitude of then.
        let inertia = Vector3::from(configuration.airframe.inertia_kg_m2);
        let turning = (wrench.torque_n_m - rate.cross(&inertia.component_mul(&rate))).component_div(&inertia);
        let jerk_at = |time_s: f64| {
            let attitude = attitude * UnitQuaternion::from_scaled_axis(rate * time_s);
            (attitude * (rate + turning * time_s).cross(&Vector3::z()) * -lift_m_s2).xy()
        };
        let made = (jerk_at(STEP_S) - jerk_at(-STEP_S)) / (2.0 * STEP_S);
        assert!((motion.snap_m_s4 - made).norm() < 1e-4, "{} {made}", motion.snap_m_s4);
        assert!((motion.asked_snap_m_s4 - snap(asked_rad_s2)).norm() < 1e-4);
    }
}
