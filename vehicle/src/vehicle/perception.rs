//! What the vehicle knows of its own motion: the truth, or what an estimator makes of instruments, or what the
//! controllers measure with noise.

use std::sync::OnceLock;

use nalgebra::{Vector2, Vector3};
use quadrotor::{GRAVITY_M_S2, Outputs, RigidBody};

use super::arming_obstacle::{ArmingObstacle, ArmingSubject as Subject};
use super::closed_loop::ClosedLoop;
use super::motion::wrapped;
use crate::estimation::aiding::Aiding;
use crate::estimation::gps::GpsFix;
use crate::estimation::vision::VisionReading;
use crate::estimation::{
    Estimate, IdealSensors, InstrumentHealth, Navigation, Readings, SensorErrors, TrueMotion, Validity,
};
use crate::fault::Faults;
use crate::mode::Needs;
use crate::world::{Geodetic, LocalFrame};

/// A position in a frame with its place on the earth.
#[derive(Clone, Copy, Debug)]
struct Here {
    position_m: Vector3<f64>,
    frame: LocalFrame,
    place: Geodetic,
}

/// What is perceived of the motion, and by what.
#[derive(Debug)]
pub struct Perception {
    /// What the closed loop shows in truth.
    truth: Outputs,
    /// The same with what the vehicle takes for its motion, if that is not the truth.
    believed: Option<Outputs>,
    /// Instruments and estimator, unless the truth is known.
    navigation: Option<Navigation>,
    ideal_sensors: IdealSensors,
    /// Where it is on the earth, since somebody has asked: several messages tell it.
    here: OnceLock<Here>,
    /// By how much the horizontal position slid with the last tick, m, and since the start.
    slid_m: Vector2<f64>,
    slid_before_m: Vector2<f64>,
}

impl Perception {
    /// Begins with the motion of the closed loop, with instruments and an estimator or without.
    pub fn new(closed_loop: &ClosedLoop, navigation: Option<Navigation>) -> Self {
        let mut perception = Self {
            truth: closed_loop.outputs(),
            believed: None,
            navigation,
            ideal_sensors: IdealSensors::default(),
            here: OnceLock::new(),
            slid_m: Vector2::zeros(),
            slid_before_m: Vector2::zeros(),
        };
        perception.believed = perception.belief(closed_loop);
        perception
    }

    /// Looks at the motion that the last tick has led to. `stands` tells that it is disarmed on the ground.
    pub fn step(
        &mut self,
        closed_loop: &ClosedLoop,
        frame: &LocalFrame,
        faults: &Faults,
        errors: &SensorErrors,
        aiding: impl FnOnce() -> Aiding,
        stands: bool,
    ) {
        self.truth = closed_loop.outputs();
        match &mut self.navigation {
            Some(navigation) => {
                navigation.step(&TrueMotion::of(&self.truth), frame, faults, errors, &aiding(), stands);
                let slid_m = navigation.estimate().slid_m;
                (self.slid_m, self.slid_before_m) = (slid_m - self.slid_before_m, slid_m);
            }
            None => self.ideal_sensors.step(self.truth.time_us, faults),
        }
        self.believed = self.belief(closed_loop);
        if self.here.get().is_some_and(|here| here.position_m != self.outputs().position_m) {
            self.here = OnceLock::new();
        }
    }

    /// A position, NED, m, as a place. That of the vehicle is calculated once, however often it is asked for.
    pub fn place_of(&self, position_m: &Vector3<f64>, frame: &LocalFrame) -> Geodetic {
        let calculate =
            || Here { position_m: *position_m, frame: *frame, place: frame.to_geodetic(position_m) };
        if *position_m == self.outputs().position_m {
            let here = self.here.get_or_init(calculate);
            if (here.position_m, here.frame) == (*position_m, *frame) {
                return here.place;
            }
        }
        calculate().place
    }

    /// A GPS fix comes from outside.
    pub fn receive_fix(&mut self, fix: GpsFix) {
        if let Some(navigation) = &mut self.navigation {
            navigation.receive_fix(fix);
        }
    }

    /// An estimate of the motion comes from outside.
    pub fn receive_vision(&mut self, reading: VisionReading) {
        if let Some(navigation) = &mut self.navigation {
            navigation.receive_vision(reading);
        }
    }

    /// What is missing that tells the place or the velocity, if nothing does.
    fn lacks_aid(&self) -> Option<&'static str> {
        let health = self.health();
        let aiding = self.navigation.as_ref().map_or_else(Aiding::default, |navigation| *navigation.aiding());
        let sees = aiding.vision.is_some_and(|vision| vision.uses.aids());
        if aiding.gps.aids() && health.gps || sees && health.vision {
            None
        } else if sees {
            Some("no vision estimates")
        } else if aiding.gps.aids() {
            Some("no GPS fix")
        } else {
            Some("no source of position (EK3_SRC1_POSXY)")
        }
    }

    /// Looks at the same motion again: the closed loop has another configuration.
    pub fn look_again(&mut self, closed_loop: &ClosedLoop) {
        self.truth = closed_loop.outputs();
        self.believed = self.belief(closed_loop);
    }

    /// The true outputs, with what the vehicle believes in place of the motion; `None` if that is the truth.
    fn belief(&self, closed_loop: &ClosedLoop) -> Option<Outputs> {
        match &self.navigation {
            Some(navigation) => Some(estimated(&self.truth, navigation)),
            None => {
                let body = closed_loop.simulation().believed_motion()?;
                Some(believed(&self.truth, &body, self.truth.acceleration_m_s2))
            }
        }
    }

    /// What the closed loop shows, as far as the vehicle knows its motion.
    pub fn outputs(&self) -> &Outputs {
        self.believed.as_ref().unwrap_or(&self.truth)
    }

    /// What the closed loop shows in truth.
    pub fn truth(&self) -> &Outputs {
        &self.truth
    }

    /// By how much the horizontal position that is known slid with the last tick, m: see [`Estimate::slid_m`].
    pub fn slid_m(&self) -> Vector2<f64> {
        self.slid_m
    }

    /// What of its motion it knows well enough to fly by.
    pub fn validity(&self) -> Validity {
        match &self.navigation {
            Some(navigation) => navigation.estimate().validity,
            None => self.ideal_sensors.validity(),
        }
    }

    /// Which instruments work.
    pub fn health(&self) -> InstrumentHealth {
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
    pub fn readings(&self, frame: &LocalFrame) -> Readings {
        match &self.navigation {
            Some(navigation) => *navigation.readings(),
            None => {
                let place = self.place_of(&self.truth.position_m, frame);
                self.ideal_sensors.readings(&TrueMotion::of(&self.truth), &place)
            }
        }
    }

    /// What of the estimate speaks against arming. ArduPilot's clients look for its words of a place that is not known.
    pub fn obstacles(&self, needs: Needs, ardupilot: bool) -> impl Iterator<Item = ArmingObstacle> {
        let (place, height) = (needs == Needs::Place, needs >= Needs::Height);
        let (health, validity) = (self.health(), self.validity());
        let aligned = self.navigation.as_ref().is_none_or(|navigation| navigation.estimator().is_aligned());
        let lacks_aid = self.lacks_aid();
        let knows_place = validity.horizontal_position && validity.vertical_position;
        let has_compass =
            health.magnetometer || self.navigation.as_ref().is_some_and(Navigation::has_vision_heading);
        let of = |px4: &'static str, words: &'static str| if ardupilot { words } else { px4 };
        let checks = [
            (health.gyroscope, Subject::Gyroscope, of("gyroscope failed", "Gyros not healthy")),
            (health.accelerometer, Subject::Accelerometer, of("accelerometer failed", "Accels not healthy")),
            (has_compass, Subject::Magnetometer, of("magnetometer failed", "Compass 1 not healthy")),
            (health.barometer, Subject::Barometer, "barometer failed"),
            (!place || lacks_aid.is_none(), Subject::Gps, lacks_aid.unwrap_or_default()),
            (aligned, Subject::Attitude, "attitude not aligned yet"),
            (!aligned || validity.tilt && validity.heading, Subject::Attitude, "no attitude estimate"),
            (
                !aligned || !place || validity.horizontal_velocity && validity.vertical_velocity,
                Subject::Velocity,
                "no velocity estimate",
            ),
            (
                !aligned || !place || knows_place && !(ardupilot && lacks_aid.is_some()),
                Subject::Position,
                of("no position estimate", "Need Position Estimate"),
            ),
            (!aligned || !height || validity.vertical_position, Subject::Position, "no height estimate"),
        ];
        let bad = checks.into_iter().filter(|(good, ..)| !good);
        bad.map(|(_, subject, why)| ArmingObstacle::new(subject, why))
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
        yaw_error_rad: wrapped(psi - truth.setpoint.yaw_rad),
        ..*truth
    }
}
