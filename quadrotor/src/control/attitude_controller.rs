//! Attitude: from the attitude and body rates to torques.

use core::f64::consts::{PI, TAU};

use lmpc::{ControllerState, Sample, Step};
use nalgebra::{SVector, UnitQuaternion, Vector1, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::attitude::{Angle, attitude_error, turned};
use crate::control::activity::ControllerActivity;
use crate::control::answered::answer;
use crate::control::attitude_reference::AttitudeReference;
use crate::control::spin::Spin;
use crate::design::attitude_design::{AXIS_STATES, AttitudeDesign};
use crate::design::attitude_limits::RotorRoom;
use crate::design::capacities::{LEAN_FEW, LEAN_MANY, TURN_FEW, TURN_MANY};
use crate::design::loop_design::LoopDesign;
use crate::{CascadeDesign, Configuration};

/// Tilt error from which a vehicle is upside down, rad: its reference may lean by the rest.
const UPSIDE_DOWN_RAD: f64 = PI - 0.6;
/// Rate from which a turn has begun, rad/s.
const BEGUN_RAD_S: f64 = 0.3;

/// What is known of the vehicle's rotation, measured or estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VehicleRotation {
    /// FRD into NED.
    pub(crate) attitude: UnitQuaternion<f64>,
    /// p, q, r, rad/s.
    pub(crate) body_rate_rad_s: Vector3<f64>,
    /// Torque that the rotors make, N·m.
    pub(crate) torque_n_m: Vector3<f64>,
    /// Estimated angular acceleration that the rotors do not explain, rad/s².
    pub(crate) disturbance_rad_s2: Vector3<f64>,
}

/// What the rotors are to make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AskedTorque {
    /// The controller's own angular acceleration, rad/s² …
    own_rad_s2: Vector3<f64>,
    /// … beside which there is this torque, N·m.
    beside_n_m: Vector3<f64>,
    inertia_kg_m2: Vector3<f64>,
}

impl AskedTorque {
    /// In FRD, N·m.
    pub(crate) fn torque_n_m(&self) -> Vector3<f64> {
        self.own_rad_s2.component_mul(&self.inertia_kg_m2) + self.beside_n_m
    }
}

/// Share of what the rotors can do that an estimated disturbance may take. A plan ends at rest against it; one that the rotors
/// cannot hold has no such end, and the limit would be broken for it at once. From 1 mrad of attitude noise on the estimate's own noise
/// comes to that: the heading wandered by 8 mrad, where it should by 0.2 mrad.
const HELD_SHARE: f64 = 0.8;

/// State of the attitude controller.
///
/// The model (23) has Euler angles; here their error is the rotation from the reference in body axes, which for small angles
/// is the same and has no singularity. Inputs are angular accelerations J⁻¹ τ.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AttitudeController {
    /// Of roll and pitch.
    lean: ControllerState<{ 2 * AXIS_STATES }, 2, LEAN_MANY, f64, LEAN_FEW>,
    /// Of yaw.
    turn: ControllerState<AXIS_STATES, 1, TURN_MANY, f64, TURN_FEW>,
    attitude: UnitQuaternion<f64>,
    /// Deviation from the reference at the last sample.
    deviation: Deviation,
    /// Integral action of the last step, rad/s².
    integral_rad_s2: Vector3<f64>,
    /// What the rotors did not explain of the angular acceleration, FRD, rad/s², as far as its changes have been answered; `None` before
    /// the first sample.
    answered_rad_s2: Option<Vector3<f64>>,
}

/// Angle, rate and angular acceleration about roll, pitch and yaw less those of the reference.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
struct Deviation {
    angle_rad: Vector3<f64>,
    rate_rad_s: Vector3<f64>,
    acceleration_rad_s2: Vector3<f64>,
}

impl Deviation {
    /// What of it can be planned with over some times, s, of lean and of turn, under angular accelerations, rad/s²: a rotation that is too
    /// fast to be braked in this time is braked, and where it has come to is of no interest.
    fn in_sight(&self, sight_s: [f64; 2], acceleration_rad_s2: [f64; 2]) -> Self {
        let [lean, turn] = [0, 1].map(|law| sight_s[law] * acceleration_rad_s2[law]);
        let mut seen = *self;
        let rate = self.rate_rad_s.xy().norm();
        if rate > lean {
            (seen.angle_rad.x, seen.angle_rad.y) = (0.0, 0.0);
            seen.rate_rad_s.x *= lean / rate;
            seen.rate_rad_s.y *= lean / rate;
        }
        if libm::fabs(self.rate_rad_s.z) > turn {
            seen.angle_rad.z = 0.0;
            seen.rate_rad_s.z = turn.copysign(self.rate_rad_s.z);
        }
        seen
    }

    fn since(&self, before: &Self) -> Self {
        Self {
            angle_rad: self.angle_rad - before.angle_rad,
            rate_rad_s: self.rate_rad_s - before.rate_rad_s,
            acceleration_rad_s2: self.acceleration_rad_s2 - before.acceleration_rad_s2,
        }
    }

    /// In other axes.
    fn turned(&self, turn: Angle) -> Self {
        Self {
            angle_rad: turn.turned(&self.angle_rad),
            rate_rad_s: turn.turned(&self.rate_rad_s),
            acceleration_rad_s2: turn.turned(&self.acceleration_rad_s2),
        }
    }

    /// The states of some axes, the first of which is `first`, one axis after the other.
    fn states<const N: usize>(&self, first: usize) -> SVector<f64, N> {
        SVector::from_fn(|state, _| {
            let axis = first + state / AXIS_STATES;
            [self.angle_rad, self.rate_rad_s, self.acceleration_rad_s2][state % AXIS_STATES][axis]
        })
    }
}

/// What both laws are told at a sample.
struct Seen {
    deviation: Deviation,
    increment: Deviation,
    /// What of the increment feedback alone answers.
    passing: Deviation,
    input_reference: Vector3<f64>,
    disturbance: Vector3<f64>,
}

impl Seen {
    /// Of P axes, the first of which is `first`.
    fn sample<'a, const N: usize, const P: usize>(
        &self,
        first: usize,
        upper: &'a [f64],
    ) -> Sample<'a, N, P, P> {
        let axes = |vector: &Vector3<f64>| SVector::from_fn(|axis, _| vector[first + axis]);
        Sample {
            measured: self.deviation.states(first),
            increment: self.increment.states(first),
            deviation: self.deviation.states(first),
            error: axes(&self.deviation.angle_rad),
            input_reference: axes(&self.input_reference),
            disturbance: axes(&self.disturbance),
            upper,
            ..Sample::default()
        }
    }
}

impl AttitudeController {
    /// Takes over a vehicle, as if it had been on its reference: the whole error and the whole rate count
    /// from the first sample on. The rotors have held it by an angular acceleration, FRD, rad/s², against what disturbs it.
    pub fn new(attitude: &UnitQuaternion<f64>, held_rad_s2: &Vector3<f64>) -> Self {
        let (lean, turn) = (held_rad_s2.xy(), Vector1::new(held_rad_s2.z));
        Self {
            lean: ControllerState::new(SVector::zeros(), lean, Vector2::zeros()).keeping(),
            turn: ControllerState::new(SVector::zeros(), turn, Vector1::zeros()).keeping(),
            attitude: *attitude,
            deviation: Deviation::default(),
            integral_rad_s2: Vector3::zeros(),
            answered_rad_s2: None,
        }
    }

    /// One sample: what the rotors are to make, and how it was found. Report what they were asked for in the end with
    /// [`AttitudeController::apply`].
    pub(crate) fn step(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &VehicleRotation,
        reference: &AttitudeReference,
        thrust_n: (f64, f64),
    ) -> (AskedTorque, ControllerActivity) {
        self.turn_with_the_body(&seen.attitude);
        let in_body = seen.attitude.inverse() * reference.attitude;
        let lag_s = configuration.airframe.mean_rotor_lag_s();
        let inertia_kg_m2 = configuration.believed_inertia_kg_m2();
        let spin = Spin {
            inertia_kg_m2,
            body_rate_rad_s: seen.body_rate_rad_s,
            rate_error_rad_s: seen.body_rate_rad_s - leaning_and_turning(&in_body, &reference.rate_rad_s),
            torque_n_m: seen.torque_n_m + seen.disturbance_rad_s2.component_mul(&inertia_kg_m2),
            delay_s: lag_s + configuration.controllers.attitude.sample_time_s() / 2.0,
        };
        let [roll_n_m, pitch_n_m, yaw_n_m] = design.mixer.available_torques_n_m(thrust_n.0, thrust_n.1);
        let most_n_m = roll_n_m.min(pitch_n_m);
        let beside = spin.beside(most_n_m);
        let most_rad_s2 = [most_n_m / inertia_kg_m2.xy().max(), yaw_n_m / inertia_kg_m2.z];
        let disturbance_rad_s2 = holdable(&seen.disturbance_rad_s2, most_rad_s2);
        let reference_acceleration = leaning_and_turning(&in_body, &reference.acceleration_rad_s2);
        let reached = (seen.torque_n_m - beside.made_n_m).component_div(&inertia_kg_m2);
        let error_rad =
            going_on(&attitude_error(&reference.attitude, &seen.attitude), &spin.rate_error_rad_s);
        let largest_rad = spin.largest_lean_rad(most_n_m, design.attitude.closing_1_s);
        let deviation = Deviation {
            angle_rad: leaning_at_most(&error_rad, largest_rad),
            rate_rad_s: spin.rate_error_rad_s,
            // What disturbs the vehicle turns it, too.
            acceleration_rad_s2: reached + disturbance_rad_s2 - reference_acceleration,
        };
        let deviation = deviation.in_sight(design.attitude.sight_s, most_rad_s2);
        let (increment, passing) = self.increments(design, &deviation, &disturbance_rad_s2);
        let told = Seen {
            deviation,
            increment,
            passing,
            // A step of the reference's rate is motion of the error, which moves an incremental law at once.
            input_reference: if design.attitude.is_incremental() {
                Vector3::zeros()
            } else {
                reference_acceleration + leaning_and_turning(&in_body, &reference.jerk_rad_s3) * lag_s
            },
            disturbance: disturbance_rad_s2,
        };
        let room = RotorRoom {
            mixer: &design.mixer,
            thrust_n,
            other_n_m: beside.commanded_n_m,
            inertia_kg_m2,
            believed: configuration.controllers.mass_factor,
        };
        let (own_rad_s2, activity) = self.step_laws(&design.attitude, &told, &room);
        (AskedTorque { own_rad_s2, beside_n_m: beside.commanded_n_m, inertia_kg_m2 }, activity)
    }

    /// A step of both laws: the angular acceleration that they ask for, rad/s², roll and pitch before yaw.
    fn step_laws(
        &mut self,
        design: &AttitudeDesign,
        told: &Seen,
        room: &RotorRoom,
    ) -> (Vector3<f64>, ControllerActivity) {
        let mut lean = design.lean.step(&mut self.lean, &told.sample(0, &room.lean_bounds()));
        lean.input += room.lean_beside(&lean.input, &design.lean.answer_to(&told.passing.states(0)));
        let turn_bounds = room.turn_bounds(&lean.input, told.input_reference.z);
        let mut turn = design.turn.step(&mut self.turn, &told.sample(2, &turn_bounds));
        turn.input += design.turn.answer_to(&told.passing.states(2));
        self.deviation = told.deviation;
        self.integral_rad_s2 = joined(&lean.integral, &turn.integral);
        (joined(&lean.input, &turn.input), activity(&lean, &turn))
    }

    /// The motion since the last sample: by the model, if there is one, else as it was measured. And what of it feedback alone answers: a
    /// torque that begins to disturb the vehicle is a jump of the acceleration, which no model leads to, and a plan would take it to go on.
    fn increments(
        &mut self,
        design: &CascadeDesign,
        deviation: &Deviation,
        disturbance_rad_s2: &Vector3<f64>,
    ) -> (Deviation, Deviation) {
        let answered_rad_s2 = self.answered_rad_s2.get_or_insert(*disturbance_rad_s2);
        let jump_rad_s2 = answer(answered_rad_s2, disturbance_rad_s2, &design.estimator.unsure_rad_s2);
        let none = Deviation::default();
        let Some(motion) = &design.attitude.motion else { return (deviation.since(&self.deviation), none) };
        let driving = joined(&self.lean.feedback(), &self.turn.feedback()) + disturbance_rad_s2;
        let axes =
            [0, 1, 2].map(|axis| motion.that_led_to(&deviation.states(axis), &Vector1::new(driving[axis])));
        let of = |state: usize| Vector3::from(axes.map(|axis| axis[state]));
        let led = Deviation { angle_rad: of(0), rate_rad_s: of(1), acceleration_rad_s2: of(2) };
        if design.attitude.lean.plans_increments() {
            (led, Deviation { acceleration_rad_s2: jump_rad_s2, ..none })
        } else {
            (Deviation { acceleration_rad_s2: of(2) + jump_rad_s2, ..led }, none)
        }
    }

    /// Expresses what is remembered in the body axes of now. A lean stays where it is in the world while the body
    /// spins about its thrust axis; an integral left behind in turning axes would push sideways. What holds the body against a torque
    /// turns with it.
    fn turn_with_the_body(&mut self, attitude: &UnitQuaternion<f64>) {
        let spun_rad = turned(&self.attitude, attitude).z;
        let turn = Angle::new(-spun_rad);
        let held = -self.answered_rad_s2.unwrap_or_default().xy();
        self.lean.turn_feedback(|lean| {
            let leaning = lean - held;
            held + turn.turned(&Vector3::new(leaning.x, leaning.y, 0.0)).xy()
        });
        self.deviation = self.deviation.turned(turn);
        self.attitude = *attitude;
    }

    /// Goes on with the same torque under a belief in another inertia: `ratio` is the one before over the one now.
    pub(crate) fn believe(&mut self, ratio: f64) {
        self.lean.turn_feedback(|lean| lean * ratio);
        self.turn.turn_feedback(|turn| turn * ratio);
        self.integral_rad_s2 *= ratio;
        self.answered_rad_s2 = self.answered_rad_s2.map(|answered| answered * ratio);
    }

    /// Goes on under another law of the same torque. An incremental law has what its reference needs in its feedback, the
    /// others beside it.
    pub(crate) fn hand_over(&mut self, before: &LoopDesign, after: &LoopDesign) {
        let is_incremental = after.cascade.attitude.is_incremental();
        if before.cascade.attitude.is_incremental() == is_incremental {
            return;
        }
        let applied = self.applied_rad_s2();
        let reference = joined(&self.lean.input_reference(), &self.turn.input_reference());
        let reference = if is_incremental { Vector3::zeros() } else { reference };
        self.lean = ControllerState::new(self.lean.measured(), applied.xy(), reference.xy()).keeping();
        self.turn =
            ControllerState::new(self.turn.measured(), Vector1::new(applied.z), Vector1::new(reference.z))
                .keeping();
        self.integral_rad_s2 = Vector3::zeros();
    }

    /// Angular accelerations about roll and pitch that feedback has asked for, FRD, rad/s².
    pub(crate) fn feedback_rad_s2(&self) -> Vector3<f64> {
        joined(&self.lean.feedback(), &Vector1::zeros())
    }

    fn applied_rad_s2(&self) -> Vector3<f64> {
        joined(&self.lean.applied(), &self.turn.applied())
    }

    /// Reports the torque, N·m, that the rotors were asked for.
    pub(crate) fn apply(&mut self, design: &AttitudeDesign, asked: &AskedTorque, torque_n_m: &Vector3<f64>) {
        let own_rad_s2 = (torque_n_m - asked.beside_n_m).component_div(&asked.inertia_kg_m2);
        let (lean, turn) = (own_rad_s2.xy(), Vector1::new(own_rad_s2.z));
        if design.is_incremental() {
            self.lean.apply_holding_integral(&lean, &self.integral_rad_s2.xy());
            self.turn.apply_holding_integral(&turn, &Vector1::new(self.integral_rad_s2.z));
        } else {
            self.lean.apply(&lean);
            self.turn.apply(&turn);
        }
    }
}

/// Motion of a reference, in its own axes, as the body should have it: `in_body` turns into the axes of the body. A turn about the
/// thrust axis is one about the body's own, however far that leans off: it does not move the thrust, and would push a vehicle sideways that
/// leans to catch up with its reference.
fn leaning_and_turning(in_body: &UnitQuaternion<f64>, motion: &Vector3<f64>) -> Vector3<f64> {
    in_body * Vector3::new(motion.x, motion.y, 0.0) + Vector3::z() * motion.z
}

/// A disturbance, rad/s², whose parts are no more than a share of what the rotors can do about lean and turn, rad/s².
fn holdable(disturbance_rad_s2: &Vector3<f64>, [lean_rad_s2, turn_rad_s2]: [f64; 2]) -> Vector3<f64> {
    let most = [lean_rad_s2, lean_rad_s2, turn_rad_s2].map(|most| HELD_SHARE * most.max(0.0));
    disturbance_rad_s2.zip_map(&Vector3::from(most), |part, most| part.clamp(-most, most))
}

/// An error in which a vehicle that is upside down goes on turning as it does, rad: the shortest way changes its direction with every
/// small lean, and the next one is no better than the one that was begun.
fn going_on(error_rad: &Vector3<f64>, rate_error_rad_s: &Vector3<f64>) -> Vector3<f64> {
    let (lean, rate) = (error_rad.xy(), rate_error_rad_s.xy());
    let (tilt, speed) = (lean.norm(), rate.norm());
    if tilt < UPSIDE_DOWN_RAD || speed < BEGUN_RAD_S {
        return *error_rad;
    }
    let left = if rate.dot(&lean) > 0.0 { TAU - tilt } else { tilt };
    let way = rate * (-left / speed);
    Vector3::new(way.x, way.y, error_rad.z)
}

/// An error whose lean is shortened to a largest one, rad.
fn leaning_at_most(error_rad: &Vector3<f64>, largest_rad: f64) -> Vector3<f64> {
    let lean = error_rad.xy().norm();
    let share = if lean > largest_rad { largest_rad / lean } else { 1.0 };
    Vector3::new(error_rad.x * share, error_rad.y * share, error_rad.z)
}

fn joined(lean: &Vector2<f64>, turn: &Vector1<f64>) -> Vector3<f64> {
    Vector3::new(lean.x, lean.y, turn.x)
}

/// Of both laws together: the worse outcome, and what they took.
fn activity(lean: &Step<2>, turn: &Step<1>) -> ControllerActivity {
    ControllerActivity::from(lean).with(&ControllerActivity::from(turn))
}
