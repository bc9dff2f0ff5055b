//! What the controllers go by: the measurement, or what the Kalman predictor makes of it.

use nalgebra::Vector3;

use crate::control::attitude_controller::VehicleRotation;
use crate::control::estimator::Estimator;
use crate::control::vehicle_motion::VehicleMotion;
use crate::{Configuration, GRAVITY_M_S2, RigidBody, wrench_of_rotors};

/// The vehicle as the controllers see it at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Observation {
    /// What the sensors say.
    pub(crate) measured: RigidBody,
    /// What the controllers go by.
    pub(crate) body: RigidBody,
    /// Acceleration that thrust and gravity make, NED, m/s², and its rate as the body turns, m/s³.
    acceleration_m_s2: Vector3<f64>,
    jerk_m_s3: Vector3<f64>,
    /// Acceleration that the thrust does not explain, NED, m/s².
    disturbance_m_s2: Vector3<f64>,
    /// Angular acceleration that the torques do not explain, FRD, rad/s².
    disturbance_rad_s2: Vector3<f64>,
    /// Speeds that the rotors have reached by their model, rad/s.
    pub(crate) rotor_speed_rad_s: [f64; 4],
    /// Torque that they make at those speeds, FRD, N·m.
    rotor_torque_n_m: Vector3<f64>,
}

impl Observation {
    /// Of a measurement, beside what has been estimated until now.
    pub(crate) fn new(
        configuration: &Configuration,
        estimator: &Estimator,
        measured: &RigidBody,
        time_us: u64,
    ) -> Self {
        let body = if configuration.sensors.output_feedback { estimator.body_at(time_us) } else { *measured };
        let rotor_speed_rad_s = estimator.rotor_speed_rad_s();
        let made = wrench_of_rotors(&configuration.airframe, &rotor_speed_rad_s);
        // a = g e₃ − R e₃ F/m,  ȧ = −R (ω × e₃) F/m
        let lift = made.thrust_n / configuration.believed_mass_kg();
        let rotation = body.rotation();
        let acceleration_m_s2 = Vector3::z() * GRAVITY_M_S2 - rotation * Vector3::z() * lift;
        let jerk_m_s3 = rotation * body.body_rate_rad_s.cross(&Vector3::z()) * -lift;
        Self {
            measured: *measured,
            body,
            acceleration_m_s2,
            jerk_m_s3,
            disturbance_m_s2: estimator.disturbance_m_s2(),
            disturbance_rad_s2: estimator.disturbance_rad_s2(),
            rotor_speed_rad_s,
            rotor_torque_n_m: made.torque_n_m,
        }
    }

    /// Motion north and east.
    pub(crate) fn horizontal(&self) -> VehicleMotion<2> {
        VehicleMotion {
            position_m: self.body.position_m.xy(),
            velocity_m_s: self.body.velocity_m_s.xy(),
            acceleration_m_s2: self.acceleration_m_s2.xy(),
            jerk_m_s3: self.jerk_m_s3.xy(),
            disturbance_m_s2: self.disturbance_m_s2.xy(),
        }
    }

    /// Motion down.
    pub(crate) fn vertical(&self) -> VehicleMotion<1> {
        let down = |vector: &Vector3<f64>| [vector.z].into();
        VehicleMotion {
            position_m: down(&self.body.position_m),
            velocity_m_s: down(&self.body.velocity_m_s),
            acceleration_m_s2: down(&self.acceleration_m_s2),
            jerk_m_s3: down(&self.jerk_m_s3),
            disturbance_m_s2: down(&self.disturbance_m_s2),
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
