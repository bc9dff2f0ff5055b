//! What the cascade knows of the vehicle: measured or estimated.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::control::attitude_controller::VehicleRotation;
use crate::control::estimator::{Command, Estimator, EstimatorDesign};
use crate::control::vehicle_motion::VehicleMotion;
use crate::plant::dynamics::Plant;
use crate::sensors::NoiseState;
use crate::{Configuration, ControllerKind, RigidBody, Sensors};

/// State of the sensors' noise and of the estimator.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Observer {
    noise: NoiseState,
    estimator: Estimator,
}

/// The vehicle as the controllers see it at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Observation {
    /// What the sensors say.
    measured: RigidBody,
    /// What the controllers go by.
    pub(crate) body: RigidBody,
    /// Acceleration that the thrust does not explain, NED, m/s².
    disturbance_m_s2: Vector3<f64>,
    /// Torque that the rotors do not explain, FRD, N·m.
    disturbance_n_m: Vector3<f64>,
}

impl Observer {
    /// Takes over a vehicle.
    pub(crate) fn new(
        configuration: &Configuration,
        plant: &Plant,
        estimate: Option<&RigidBody>,
        time_us: u64,
        before: Option<&Self>,
    ) -> Self {
        let mut noise = before.map_or_else(NoiseState::default, |observer| observer.noise);
        let measured = estimate.copied().unwrap_or_else(|| noise.read(&configuration.sensors, &plant.body));
        Self {
            noise,
            estimator: Estimator::new(&configuration.sensors, &measured, plant.rotor_speed_rad_s, time_us),
        }
    }

    /// A reading of the sensors, or what an estimator outside has made of its own.
    pub(crate) fn observe(
        &mut self,
        configuration: &Configuration,
        plant: &Plant,
        estimate: Option<&RigidBody>,
        time_us: u64,
    ) -> Observation {
        let measured =
            estimate.copied().unwrap_or_else(|| self.noise.read(&configuration.sensors, &plant.body));
        let body =
            if configuration.sensors.output_feedback { self.estimator.body_at(time_us) } else { measured };
        let inertia = Vector3::from(configuration.airframe.inertia_kg_m2);
        Observation {
            measured,
            body,
            disturbance_m_s2: self.estimator.disturbance_m_s2(),
            disturbance_n_m: self.estimator.disturbance_rad_s2().component_mul(&inertia)
                * configuration.controllers.mass_factor,
        }
    }

    /// What the controllers go by now, between two samples; `None` if it is the truth.
    pub(crate) fn belief(
        &self,
        sensors: &Sensors,
        plant: &Plant,
        armed: bool,
        time_us: u64,
    ) -> Option<RigidBody> {
        if sensors.output_feedback && armed {
            return Some(self.estimator.body_at(time_us));
        }
        (!sensors.is_exact()).then(|| self.noise.latest(sensors, &plant.body))
    }

    /// On to the next sample of the attitude controller. Only done when somebody asks for the estimate.
    pub(crate) fn predict(
        &mut self,
        configuration: &Configuration,
        design: &EstimatorDesign,
        observation: &Observation,
        command: &Command,
        time_us: u64,
    ) {
        let needed =
            configuration.sensors.output_feedback || configuration.controllers.kind != ControllerKind::Dlqr;
        if needed {
            let times = (time_us, configuration.controllers.attitude.sample_time_us);
            self.estimator.predict(configuration, design, &observation.measured, command, times);
        }
    }
}

impl Observation {
    /// Motion north and east.
    pub(crate) fn horizontal(&self) -> VehicleMotion<2> {
        VehicleMotion {
            position_m: self.body.position_m.xy(),
            velocity_m_s: self.body.velocity_m_s.xy(),
            disturbance_m_s2: self.disturbance_m_s2.xy(),
        }
    }

    /// Motion down.
    pub(crate) fn vertical(&self) -> VehicleMotion<1> {
        let down = |vector: &Vector3<f64>| [vector.z].into();
        VehicleMotion {
            position_m: down(&self.body.position_m),
            velocity_m_s: down(&self.body.velocity_m_s),
            disturbance_m_s2: down(&self.disturbance_m_s2),
        }
    }

    /// Rotation.
    pub(crate) fn rotation(&self) -> VehicleRotation {
        VehicleRotation {
            attitude: self.body.rotation(),
            body_rate_rad_s: self.body.body_rate_rad_s,
            disturbance_n_m: self.disturbance_n_m,
        }
    }
}
