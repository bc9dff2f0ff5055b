//! The stationary Kalman predictor (26) of the vehicle's motion: from position and attitude, and from velocity and body rates where those
//! are measured.

use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::attitude::turned;
use crate::control::clearance::carries;
use crate::control::euler_equation::angular_acceleration_rad_s2;
use crate::control::mass_belief::MassBelief;
use crate::design::estimator_design::EstimatorDesign;
use crate::finite::are_finite;
use crate::{
    Airframe, CascadeDesign, Configuration, GRAVITY_M_S2, Measurement, RigidBody, Sensors, Wrench,
    wrench_of_rotors,
};

/// A vehicle that turns slower than this, rad/s, and so many deviations of the noise does not turn.
const STILL_RAD_S: f64 = 0.2;
const STILL_DEVIATIONS: f64 = 4.0;
/// Time after which it is seen whether the vehicle moved when it was taken over, s; from this mean speed on, m/s, and so many deviations of
/// the noise, it did. One whose thrust is off by its weight is slower.
const SEEN_S: f64 = 0.03;
const MOVING_M_S: f64 = 0.5;
const MOVING_DEVIATIONS: f64 = 6.0;
/// So many times the lag of a disturbance it takes for such a motion to be found.
const SETTLING_LAGS: f64 = 5.0;

/// The estimate of the vehicle's motion at the next sample of the attitude controller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimator {
    body: RigidBody,
    /// Acceleration that thrust, gravity and drag do not explain, NED, m/s².
    disturbance_m_s2: Vector3<f64>,
    /// Angular acceleration that the torques do not explain, FRD, rad/s².
    disturbance_rad_s2: Vector3<f64>,
    /// Speeds of the rotors by their model, rad/s.
    rotor_speed_rad_s: [f64; 4],
    time_us: u64,
    /// When and where it took the vehicle over, µs and NED, m.
    since_us: u64,
    start_m: Vector3<f64>,
    /// Whether the vehicle moved then, as far as that was not measured; `None` until it is seen.
    moved: Option<bool>,
}

impl Estimator {
    /// Of a vehicle that was measured: at rest there, unless the measurement contains its motion.
    pub(crate) fn new(
        sensors: &Sensors,
        measured: &RigidBody,
        rotor_speed_rad_s: [f64; 4],
        time_us: u64,
    ) -> Self {
        let at_rest =
            RigidBody { velocity_m_s: Vector3::zeros(), body_rate_rad_s: Vector3::zeros(), ..*measured };
        Self {
            body: if sensors.output_feedback { at_rest } else { *measured },
            disturbance_m_s2: Vector3::zeros(),
            disturbance_rad_s2: Vector3::zeros(),
            rotor_speed_rad_s,
            time_us,
            since_us: time_us,
            start_m: measured.position_m,
            moved: None,
        }
    }

    /// Whether the motion with which it began is known at a time, µs: without a measured velocity it begins with one at rest.
    pub(crate) fn is_settled(&self, design: &EstimatorDesign, time_us: u64) -> bool {
        self.moved != Some(true) || self.age_s(time_us) > SETTLING_LAGS * design.disturbance_lag_s
    }

    /// Time since it took the vehicle over, s.
    fn age_s(&self, time_us: u64) -> f64 {
        time_us.saturating_sub(self.since_us) as f64 / 1e6
    }

    /// Looks whether the vehicle moved when it was taken over.
    fn watch_start(&mut self, sensors: &Sensors, measured: &RigidBody, time_us: u64) {
        let age_s = self.age_s(time_us);
        if self.moved.is_none() && age_s >= SEEN_S {
            let noise_m = MOVING_DEVIATIONS * sensors.position_noise_m;
            self.moved = Some((measured.position_m - self.start_m).norm() > MOVING_M_S * age_s + noise_m);
        }
    }

    /// Takes over a vehicle that was measured. One that its rotors carry and that does not turn is in balance: something holds it against
    /// what they make, such as a centre of mass beside theirs.
    pub(crate) fn take_over(configuration: &Configuration, first: &Measurement, time_us: u64) -> Self {
        let Measurement { motion, rotor_speed_rad_s } = first;
        let sensors = &configuration.sensors;
        let mut estimator = Self::new(sensors, motion, *rotor_speed_rad_s, time_us);
        let still_rad_s = STILL_RAD_S + STILL_DEVIATIONS * sensors.body_rate_noise_rad_s;
        let turns = estimator.body.body_rate_rad_s.norm() > still_rad_s;
        if carries(configuration, rotor_speed_rad_s) && !turns {
            let made_n_m = wrench_of_rotors(&configuration.airframe, rotor_speed_rad_s).torque_n_m;
            let held_rad_s2 = made_n_m.component_div(&configuration.believed_inertia_kg_m2());
            if are_finite(held_rad_s2.as_slice()) {
                estimator.disturbance_rad_s2 = -held_rad_s2;
            }
        }
        estimator
    }

    /// What the controllers go by at `time_us`: the measurement, in which the prediction stands for what is not measured or noisy.
    pub(crate) fn seen(&self, sensors: &Sensors, measured: &RigidBody, time_us: u64) -> RigidBody {
        if sensors.output_feedback {
            self.body_at(time_us)
        } else if sensors.filters_motion() {
            let RigidBody { position_m, velocity_m_s, .. } = self.body_at(time_us);
            RigidBody { position_m, velocity_m_s, ..*measured }
        } else {
            *measured
        }
    }

    /// The origin of positions is elsewhere: they are by so much more, m.
    pub(crate) fn shift(&mut self, by_m: &Vector3<f64>) {
        self.body.position_m += by_m;
        self.start_m += by_m;
    }

    /// The motion predicted for `time_us`, a fraction of a sample away at most.
    pub(crate) fn body_at(&self, time_us: u64) -> RigidBody {
        let elapsed_s = (time_us as f64 - self.time_us as f64) / 1e6;
        if elapsed_s == 0.0 {
            return self.body;
        }
        let turn = UnitQuaternion::from_scaled_axis(self.body.body_rate_rad_s * elapsed_s);
        RigidBody {
            position_m: self.body.position_m + self.body.velocity_m_s * elapsed_s,
            attitude: (self.body.rotation() * turn).into_inner(),
            ..self.body
        }
    }

    fn is_finite(&self) -> bool {
        self.body.is_possible()
            && are_finite(self.disturbance_m_s2.as_slice())
            && are_finite(self.disturbance_rad_s2.as_slice())
            && are_finite(&self.rotor_speed_rad_s)
            && are_finite(self.start_m.as_slice())
    }

    /// Acceleration that thrust, gravity and drag do not explain, NED, m/s².
    pub(crate) fn disturbance_m_s2(&self) -> Vector3<f64> {
        self.disturbance_m_s2
    }

    /// Angular acceleration that the torques do not explain, FRD, rad/s².
    pub(crate) fn disturbance_rad_s2(&self) -> Vector3<f64> {
        self.disturbance_rad_s2
    }

    /// Speeds of the rotors by their model at the time that is predicted for, rad/s.
    pub(crate) fn rotor_speed_rad_s(&self) -> [f64; 4] {
        self.rotor_speed_rad_s
    }

    /// Forgets the torque that was found, where the vehicle stands: the ground, which answers every torque, would pass for one.
    pub(crate) fn stand(&mut self) {
        self.disturbance_rad_s2 = Vector3::zeros();
    }

    /// Goes on under another belief in mass, inertia and drag, for an unchanged vehicle: what thrust and drag are believed to accelerate
    /// more, or less, leaves less, or more, to the disturbance.
    pub(crate) fn believe(&mut self, before: &Configuration, after: &Configuration) {
        self.disturbance_m_s2 +=
            (after.drag_1_s() - before.drag_1_s()).component_mul(&self.body.velocity_m_s);
        let inertia = before.believed_inertia_kg_m2().component_div(&after.believed_inertia_kg_m2());
        self.disturbance_rad_s2.component_mul_assign(&inertia);
        let Some(belief) = MassBelief::changed(&before.controllers, &after.controllers) else { return };
        let thrust_n = wrench_of_rotors(&before.airframe, &self.rotor_speed_rad_s).thrust_n;
        let thrust = self.body.rotation() * Vector3::z() * (thrust_n / before.believed_mass_kg());
        self.disturbance_m_s2 -= belief.growth_under(&thrust);
    }

    /// On to the next sample: from what was measured at this one and what is commanded until then.
    pub(crate) fn predict(
        &mut self,
        configuration: &Configuration,
        cascade: &CascadeDesign,
        measured: &RigidBody,
        command_rad_s: &[f64; 4],
        (time_us, period_us): (u64, u64),
    ) {
        let design = &cascade.estimator;
        self.watch_start(&configuration.sensors, measured, time_us);
        // A sample time that has changed moves the sample away from the time that was predicted for.
        self.body = self.body_at(time_us);
        let believed = configuration.controllers.mass_factor;
        let airframe = &configuration.airframe;
        let before = self.rotor_speed_rad_s;
        let kept = cascade.thrust_lag.kept();
        self.rotor_speed_rad_s = core::array::from_fn(|rotor| {
            command_rad_s[rotor] + (before[rotor] - command_rad_s[rotor]) * kept
        });
        let wrench =
            mean(&wrench_of_rotors(airframe, &before), &wrench_of_rotors(airframe, &self.rotor_speed_rad_s));
        let rotation = self.body.rotation();

        // v̇ = g e₃ − R e₃ F/m, with R in the middle of the sample: with R at its beginning, a body that turns would seem pushed.
        let half_s = design.sample_time_s / 2.0;
        let halfway = rotation * UnitQuaternion::from_scaled_axis(self.body.body_rate_rad_s * half_s);
        let thrust = halfway * Vector3::z() * (wrench.thrust_n / (believed * airframe.mass_kg));
        let acceleration = Vector3::z() * GRAVITY_M_S2 - thrust;
        let drag = configuration.drag_1_s().component_mul(&self.body.velocity_m_s);
        let inertia = Vector3::from(airframe.inertia_kg_m2) * believed;
        let rate = self.body.body_rate_rad_s;
        let spin_n_m = if airframe.rotor_spin.inertia_kg_m2 > 0.0 {
            spin_torque_n_m(airframe, &rate, [&before, &self.rotor_speed_rad_s], design.sample_time_s)
        } else {
            Vector3::zeros()
        };
        let angular = angular_acceleration_rad_s2(&inertia, &rate, &(wrench.torque_n_m + spin_n_m));

        let mut angle = Vector3::zeros();
        let apart = turned(&rotation, &measured.rotation());
        for i in 0..3 {
            let estimate = [self.body.position_m[i], self.body.velocity_m_s[i], self.disturbance_m_s2[i]];
            let next = design.translation.predict(
                &estimate,
                acceleration[i] - drag[i],
                [measured.position_m[i], measured.velocity_m_s[i]],
            );
            (self.body.position_m[i], self.body.velocity_m_s[i], self.disturbance_m_s2[i]) =
                (next[0], next[1], next[2]);
            // The angle from the attitude estimated for now.
            let estimate = [0.0, rate[i], self.disturbance_rad_s2[i]];
            let next =
                design.rotation[i].predict(&estimate, angular[i], [apart[i], measured.body_rate_rad_s[i]]);
            (angle[i], self.body.body_rate_rad_s[i], self.disturbance_rad_s2[i]) =
                (next[0], next[1], next[2]);
        }
        self.body.attitude = (rotation * UnitQuaternion::from_scaled_axis(angle)).into_inner();
        self.time_us = time_us + period_us;
        if !self.is_finite() {
            // A tumbling beyond all models has led it out of the numbers: the measurement is all there is.
            *self = Self::new(&configuration.sensors, measured, self.rotor_speed_rad_s, self.time_us);
        }
    }
}

/// Torque of rotors that go from one speed to another in a sample, FRD, N·m: the quicker a disturbance is found, the more their reaction to
/// being spun up would pass for one.
fn spin_torque_n_m(
    airframe: &Airframe,
    rate_rad_s: &Vector3<f64>,
    [before, after]: [&[f64; 4]; 2],
    sample_time_s: f64,
) -> Vector3<f64> {
    let speeds_rad_s = core::array::from_fn(|rotor| (before[rotor] + after[rotor]) / 2.0);
    let accelerations_rad_s2 = core::array::from_fn(|rotor| (after[rotor] - before[rotor]) / sample_time_s);
    airframe.spin_torque_n_m(rate_rad_s, &speeds_rad_s, &accelerations_rad_s2)
}

fn mean(one: &Wrench, other: &Wrench) -> Wrench {
    Wrench {
        thrust_n: (one.thrust_n + other.thrust_n) / 2.0,
        torque_n_m: (one.torque_n_m + other.torque_n_m) / 2.0,
    }
}
