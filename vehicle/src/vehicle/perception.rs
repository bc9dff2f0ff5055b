//! What the vehicle knows of its own motion: the truth, or what an estimator makes of instruments, or what the
//! controllers measure with noise.

use nalgebra::Vector3;
use quadrotor::{GRAVITY_M_S2, Outputs, RigidBody};

use super::state::Vehicle;
use crate::estimation::{Estimate, InstrumentHealth, Navigation, Readings, TrueMotion, Validity};
use crate::fault::Sensor;

impl Vehicle {
    /// Looks at the motion that the last tick has led to.
    pub(super) fn perceive(&mut self) {
        self.truth = self.simulation.outputs();
        let stands = self.landed.is_landed() && !self.armed;
        match &mut self.navigation {
            Some(navigation) => {
                navigation.step(&TrueMotion::of(&self.truth), &self.frame, &self.faults, stands);
            }
            None => self.ideal_sensors.step(self.truth.time_us, &self.faults),
        }
        self.outputs = self.known();
    }

    /// The true outputs, with what the vehicle believes in place of the motion.
    pub(super) fn known(&self) -> Outputs {
        match &self.navigation {
            Some(navigation) => estimated(&self.truth, navigation),
            None => match self.simulation.believed_motion() {
                Some(body) => believed(&self.truth, &body, self.truth.acceleration_m_s2),
                None => self.truth,
            },
        }
    }

    /// What the feet feel: the true motion, and the reference as far from it as the controllers believe.
    pub(super) fn felt(&self) -> Outputs {
        let mut felt = self.truth;
        felt.setpoint.position_m += self.truth.position_m - self.outputs.position_m;
        felt
    }

    /// What of its motion it knows well enough to fly by.
    pub fn validity(&self) -> Validity {
        match &self.navigation {
            Some(navigation) => navigation.estimate().validity,
            None => self.ideal_sensors.validity(),
        }
    }

    /// Whether it knows enough of its motion to hold a place and a height: not without its inertial unit, nor when neither the receiver
    /// nor the barometer is left to correct the height.
    pub(super) fn knows_its_place(&self) -> bool {
        let (known, works) = (self.validity(), self.instrument_health());
        let estimated = known.tilt && known.horizontal_position && known.vertical_position;
        // Ideal sensors know the rest by themselves.
        let ideal = self.navigation.is_none();
        estimated && (ideal || works.gyroscope && works.accelerometer && (works.gps || works.barometer))
    }

    /// How fast it sinks, m/s: by the estimate, or where nothing supports that any more by the receiver.
    pub(super) fn sink_rate_m_s(&self) -> f64 {
        let works = self.instrument_health();
        let supported = works.accelerometer && (works.gps || works.barometer);
        let fix = self.navigation.as_ref().and_then(Navigation::latest_fix).filter(|_| !supported);
        fix.map_or(self.outputs.velocity_m_s.z, |fix| fix.velocity_m_s.z)
    }

    /// The instruments that do not work, by their names.
    pub(super) fn failed_instruments(&self) -> Vec<&'static str> {
        let works = self.instrument_health();
        let instruments = [
            (works.gyroscope, Sensor::Gyroscope),
            (works.accelerometer, Sensor::Accelerometer),
            (works.magnetometer, Sensor::Magnetometer),
            (works.barometer, Sensor::Barometer),
            (works.gps, Sensor::Gps),
        ];
        instruments.into_iter().filter(|(works, _)| !works).map(|(_, sensor)| sensor.name()).collect()
    }

    /// Which instruments work.
    pub fn instrument_health(&self) -> InstrumentHealth {
        match &self.navigation {
            Some(navigation) => navigation.health(),
            None => self.ideal_sensors.health(),
        }
    }

    /// Instruments and estimator, if it flies by them.
    pub fn navigation(&self) -> Option<&Navigation> {
        self.navigation.as_ref()
    }

    /// The estimate, if it flies by one.
    pub fn estimate(&self) -> Option<&Estimate> {
        self.navigation.as_ref().map(Navigation::estimate)
    }

    /// What the instruments show; ideal ones show the truth.
    pub fn readings(&self) -> Readings {
        match &self.navigation {
            Some(navigation) => *navigation.readings(),
            None => self.ideal_sensors.readings(&TrueMotion::of(&self.truth), &self.frame),
        }
    }

    /// What of the estimate speaks against arming.
    pub(super) fn navigation_obstacles(&self) -> Vec<String> {
        let (health, validity) = (self.instrument_health(), self.validity());
        let aligned = self.navigation.as_ref().is_none_or(|navigation| navigation.estimator().is_aligned());
        let checks = [
            (health.gyroscope, "gyroscope failed"),
            (health.accelerometer, "accelerometer failed"),
            (health.magnetometer, "magnetometer failed"),
            (health.barometer, "barometer failed"),
            (health.gps, "no GPS fix"),
            (aligned, "attitude not aligned yet"),
            (!aligned || validity.tilt && validity.heading, "no attitude estimate"),
            (!aligned || validity.horizontal_velocity && validity.vertical_velocity, "no velocity estimate"),
            (!aligned || validity.horizontal_position && validity.vertical_position, "no position estimate"),
        ];
        checks.into_iter().filter(|(good, _)| !good).map(|(_, why)| why.to_owned()).collect()
    }
}

fn estimated(truth: &Outputs, navigation: &Navigation) -> Outputs {
    let body = &navigation.estimate().body;
    let force = navigation.readings().inertial.specific_force_m_s2;
    let acceleration = body.rotation() * force + Vector3::new(0.0, 0.0, GRAVITY_M_S2);
    believed(truth, body, acceleration)
}

fn believed(truth: &Outputs, body: &RigidBody, acceleration_m_s2: Vector3<f64>) -> Outputs {
    let rotation = body.rotation();
    let (phi, theta, psi) = rotation.euler_angles();
    Outputs {
        position_m: body.position_m,
        velocity_m_s: body.velocity_m_s,
        acceleration_m_s2,
        body_velocity_m_s: rotation.inverse_transform_vector(&body.velocity_m_s),
        attitude_rad: Vector3::new(phi, theta, psi),
        quaternion: [rotation.w, rotation.i, rotation.j, rotation.k],
        body_rate_rad_s: body.body_rate_rad_s,
        tracking_error_m: body.position_m - truth.setpoint.position_m,
        yaw_error_rad: super::motion::wrapped(psi - truth.setpoint.yaw_rad),
        ..*truth
    }
}
