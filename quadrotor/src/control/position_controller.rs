//! Position: from x, y and their derivatives to a horizontal acceleration, which stands for a tilt.

use core::cell::Cell;

use lmpc::{ControllerState, Sample, StateFeedback, Step};
use nalgebra::{SVector, Vector2};
use serde::{Deserialize, Serialize};

use crate::control::activity::ControllerActivity;
use crate::control::governor::{Governor, integral_rate};
use crate::control::largest_lean::LargestLean;
use crate::control::observed_motion::{LASTING_S, MotionSample, ObservedMotion};
use crate::control::thrown::Thrown;
use crate::control::vehicle_motion::HorizontalMotion;
use crate::design::braking_way::BrakingWay;
use crate::design::capacities::{POSITION_FEW, POSITION_MANY};
use crate::design::position_limits::{
    AXIS_STATES, Asked, POSITION_SIGNALS, POSITION_STATES, TurnUnderWay, closing_share, horizon_m, in_sight,
    planned_horizon_m, position_bounds,
};
use crate::design::translation_design::{PositionLaw, position_bandwidth_rad_s};
use crate::guidance::reference_motion::ReferenceMotion;
use crate::{CascadeDesign, Configuration};

/// Share of the acceleration limit with which the regulator's error is counted on to be braked. Its own response to the governed
/// error needs the rest.
const BRAKING_SHARE: f64 = 0.25;

/// Samples ahead at which it is looked what the reference will ask for, as far as its motion is limited: a reference that will be too fast
/// for the limit would be run ahead of. From the fourth on, but for the last, they are those at which the speed is limited with samples
/// of 50 ms or less: a speed that comes and goes between them is not missed. What is only foreseen to turn may also go straight on.
const ASKED: [usize; 9] = [5, 10, 15, 20, 26, 34, 50, 80, 110];
/// So many of them until what goes straight on does not speed up any more.
const FADED: usize = 4;

/// Share of the jump of its jerk with which a way is seen that limits bend, and no jump of its snap: mostly the next bend takes it back. A
/// law that answers the whole of it swings beyond the limits, and one that sees none of it loses the way.
const BENT: f64 = 0.5;

/// State of the position controller.
///
/// Its inputs stand for θ and φ of (14): ẍ = −g θ north and ÿ = g φ east hold exactly, for any tilt and heading, because the cascade
/// turns the acceleration into a direction of the thrust.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PositionController {
    controller: ControllerState<POSITION_STATES, 2, POSITION_MANY, f64, POSITION_FEW>,
    observed: ObservedMotion<POSITION_STATES, 2>,
    reference: ReferenceMotion<2>,
    thrown: Thrown,
}

/// How a vehicle has moved until a sample.
struct Motion {
    measured: SVector<f64, POSITION_STATES>,
    /// From the reference, with what disturbs the vehicle.
    deviation: SVector<f64, POSITION_STATES>,
    /// What of the increment limits go by.
    lasting: SVector<f64, POSITION_STATES>,
    /// What of it feedback alone answers.
    passing: SVector<f64, POSITION_STATES>,
    under_way: TurnUnderWay,
}

impl PositionController {
    /// Takes over a vehicle at x, y, m. Its whole velocity is damped from the first sample on: a law that goes by increments takes it to
    /// have been at rest there, one that goes by a model to have been damped so far.
    pub fn new(position_m: Vector2<f64>) -> Self {
        let zero = Vector2::zeros();
        let measured = by_axis([position_m, zero, zero, zero, zero, zero]);
        let start = ControllerState::new(measured, Vector2::zeros(), Vector2::zeros()).keeping();
        Self {
            controller: start,
            observed: ObservedMotion::default(),
            reference: ReferenceMotion::default(),
            thrown: Thrown::default(),
        }
    }

    /// One sample: horizontal acceleration in NED, m/s², and how it was found. `present_m_s2` is the largest one now and
    /// `lasting` later on.
    pub(crate) fn step(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &HorizontalMotion,
        (reference, ahead, asked): (
            &ReferenceMotion<2>,
            impl Fn(usize) -> ReferenceMotion<2>,
            impl Fn(usize) -> Option<ReferenceMotion<2>>,
        ),
        (present_m_s2, lasting): (f64, LargestLean),
    ) -> (Vector2<f64>, ControllerActivity) {
        let law = &design.position.law;
        let error = planned_error_m(configuration, design, seen, reference, lasting.commanded_m_s2);
        // The loop is the same in all horizontal directions. Along the error, no corner of a polygon of limits is nearer to the goal
        // than the way to it.
        let turn = Turn::along(&error, design.position_is_isotropic);
        let mut room = [0.0; POSITION_SIGNALS];
        let (moved, asked) = foreseen(law, &turn, reference, (ahead, asked), &mut room);
        let motion = self.motion(configuration, design, seen, (reference, &error), present_m_s2);
        let (error_m, disturbance_m_s2) = (turn.vector(&error), turn.vector(&seen.disturbance_m_s2));
        let zero = Vector2::zeros();
        let way = reference.is_at_rest().then(|| BrakingWay {
            // A law that sees deviations has its goal at zero.
            goal_m: if law.sees_deviation_alone() { zero } else { turn.vector(&reference.position) },
            error_m,
            thrust_m_s2: lasting.commanded_m_s2,
            disturbance_m_s2,
            delay_s: BrakingWay::delay_s(&configuration.limits),
        });
        let lean = (present_m_s2, lasting_m_s2(reference, &lasting, &asked));
        let bounds = position_bounds(&configuration.limits, lean, &asked, motion.under_way);
        let sample = Sample {
            measured: turn.state(&motion.measured),
            increment: turn.state(&motion.lasting),
            deviation: turn.state(&motion.deviation),
            error: error_m,
            input_reference: turn.vector(&reference.thrust),
            disturbance: disturbance_m_s2,
            upper: &BrakingWay::bounds_behind(&bounds, way.as_ref()),
            moved: moved.unwrap_or_default(),
            ..Sample::default()
        };
        let step = self.step_along(law, &turn, &sample, &turn.state(&motion.passing));
        self.reference = *reference;
        let applied = step.input.cap_magnitude(present_m_s2);
        self.controller.apply(&applied);
        (applied, ControllerActivity::of(&step, &step.input, &applied))
    }

    /// How the vehicle has moved until a sample, beside a reference and by an error of its position, m, where at most an acceleration of
    /// `present_m_s2` can have been commanded.
    fn motion(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &HorizontalMotion,
        (reference, error_m): (&ReferenceMotion<2>, &Vector2<f64>),
        present_m_s2: f64,
    ) -> Motion {
        let zero = Vector2::zeros();
        // The rotors hold the body against torques that disturb it: what turns it is both together. A law that foresees limits would
        // take the rotors' part alone for a tilt that is accelerated for ever. A regulator goes by how it changes.
        let sees_torques = design.position.law.regulator().is_none();
        let turning = if sees_torques { seen.disturbance_m_s4() } else { zero };
        let measured = by_axis([
            seen.position_m,
            seen.velocity_m_s,
            seen.acceleration_m_s2,
            seen.jerk_m_s3,
            seen.snap_m_s4 + turning,
            seen.asked_snap_m_s4 + turning,
        ]);
        let deviation = with_position(&(measured - state_of(reference)), error_m);
        // What disturbs the vehicle accelerates it, too.
        let disturbed = deviation + by_axis([zero, zero, seen.disturbance_m_s2, zero, zero, zero]);
        self.take_over(design, seen, (&disturbed, reference), present_m_s2);
        let [jerk_jump, snap_jump] = reference.jumps_since(&self.reference);
        let [seen_jerk_jump, seen_snap_jump] =
            if reference.is_bent { [jerk_jump * BENT, zero] } else { [jerk_jump, snap_jump] };
        let turned = self.thrown.turned_m_s4(seen, sees_torques);
        let before = self.controller.measured() + by_axis([zero, zero, zero, zero, turned, turned]);
        let since = MotionSample {
            deviation,
            change: measured - before - motion_of(reference, &self.reference),
            feedback: self.controller.feedback(),
            jump: by_axis([zero, zero, zero, seen_jerk_jump, seen_snap_jump, zero]),
        };
        let sample_time_s = configuration.controllers.position.sample_time_s();
        let (under_way, thrown) =
            self.thrown.turn_under_way(seen, &turning, (design.attitude_loop(), sample_time_s), &jerk_jump);
        let [lasting, passing] =
            self.increments(design, &since, (sample_time_s, seen.disturbance_lag_s.max(LASTING_S)), &thrown);
        Motion { measured, deviation: disturbed, lasting, passing, under_way }
    }

    /// Before the first sample of a vehicle that moves beside its reference: see [`ObservedMotion::first_feedback`] and
    /// [`Thrown::taken_over`].
    fn take_over(
        &mut self,
        design: &CascadeDesign,
        seen: &HorizontalMotion,
        (deviation, reference): (&SVector<f64, POSITION_STATES>, &ReferenceMotion<2>),
        present_m_s2: f64,
    ) {
        if self.observed.has_begun() {
            return;
        }
        // What the reference asks of a vehicle that does not move yet is a command.
        let own = [seen.acceleration_m_s2 + seen.disturbance_m_s2, seen.jerk_m_s3].map(|own| own.norm());
        let beside = [2, 3].map(|of| derivative(deviation, of).norm());
        self.thrown =
            Thrown::taken_over(own[0].min(beside[0]), own[1].min(beside[1]), design.attitude_loop());
        let (law, model) = (&design.position.law, design.position.motion.as_ref());
        let answer = |increment: &_| law.answer_to(increment);
        let feedback = self.observed.first_feedback(model, answer, deviation);
        // Nothing of no length need be cut off, which would divide by it.
        if let Some(feedback) = feedback.filter(|feedback| *feedback != Vector2::zeros()) {
            let applied = (reference.thrust + feedback).cap_magnitude(present_m_s2);
            self.controller.turn_feedback(|_| applied - reference.thrust);
        }
    }

    /// The increment of a sample that limits go by, and what beside it only the feedback answers to. Noise looks like a force that comes
    /// and goes: a plan that took it to last would keep off limits that are not near. And a torque that has begun to turn the body,
    /// `thrown` m/s⁴, is a jump of the snap, which no model leads to: a plan would take it to go on.
    fn increments(
        &mut self,
        design: &CascadeDesign,
        motion: &MotionSample<POSITION_STATES, 2>,
        times: (f64, f64),
        thrown: &Vector2<f64>,
    ) -> [SVector<f64, POSITION_STATES>; 2] {
        let model = design.position.motion.as_ref();
        let zero = Vector2::zeros();
        let thrown = if model.is_some() { *thrown } else { zero };
        let [lasting, passing] = self.observed.step(model, motion, times);
        [lasting, passing + by_axis([zero, zero, zero, zero, thrown, zero])]
    }

    /// A step of the law for a sample in turned axes, and its answer to what of the motion passes; its input is in those of the world.
    fn step_along(
        &mut self,
        law: &PositionLaw,
        turn: &Turn,
        sample: &Sample<'_, POSITION_STATES, 2, 2>,
        passing: &SVector<f64, POSITION_STATES>,
    ) -> Step<2> {
        self.controller.turn(|state| turn.state(state), |input| turn.vector(input));
        let step = law.step(&mut self.controller, sample);
        let back = turn.inverse();
        self.controller.turn(|state| back.state(state), |input| back.vector(input));
        Step { input: back.vector(&(step.input + law.answer_to(passing))), ..step }
    }

    /// Vehicle and reference are elsewhere, m: neither has moved.
    pub(crate) fn shift(&mut self, by_m: &Vector2<f64>) {
        let zero = Vector2::zeros();
        let by = by_axis([*by_m, zero, zero, zero, zero, zero]);
        self.controller.turn(|measured| measured + by, Vector2::clone_owned);
        self.reference.position += by_m;
    }

    /// Leaves to the feed-forward of the reference what it takes over of the feedback: so much more drag per mass, 1/s.
    pub(crate) fn feed_forward(&mut self, drag_1_s: &Vector2<f64>) {
        let more = drag_1_s.component_mul(&self.reference.velocity);
        self.controller.turn_feedback(|feedback| feedback - more);
        let zero = Vector2::zeros();
        self.observed.believe(&by_axis([zero, zero, -more, zero, zero, zero]));
    }

    /// Goes on under a belief in another inertia: `ratio` is the one before over the one now.
    pub(crate) fn believe(&mut self, ratio: f64) {
        self.thrown.believe(ratio);
    }

    /// Expresses the accelerations that were measured and applied last in other terms.
    pub(crate) fn translate(&mut self, term: impl Fn(&Vector2<f64>) -> Vector2<f64>) {
        let applied = term(&self.controller.applied());
        let measured = |state: &SVector<f64, POSITION_STATES>| {
            by_axis(core::array::from_fn(|of| {
                let value = derivative(state, of);
                // Position and velocity are what they are.
                if of < 2 { value } else { term(&value) }
            }))
        };
        self.thrown.translate(&term);
        let before = self.controller.measured();
        self.controller.turn(measured, Vector2::clone_owned);
        self.controller.apply(&applied);
        self.observed.believe(&(self.controller.measured() - before));
    }
}

/// The largest commanded acceleration later on, m/s². A reference that limits bend does not wait for later.
fn lasting_m_s2(reference: &ReferenceMotion<2>, lasting: &LargestLean, asked: &Asked) -> f64 {
    if reference.is_bent || reference.is_at_rest() {
        lasting.beside(asked.thrust_m_s2)
    } else {
        lasting.later_beside(asked.thrust_m_s2)
    }
}

/// What of the position error is planned with: as far as it can be braked within the horizon, and as the governor lets a regulator
/// see it.
fn planned_error_m(
    configuration: &Configuration,
    design: &CascadeDesign,
    seen: &HorizontalMotion,
    reference: &ReferenceMotion<2>,
    most_m_s2: f64,
) -> Vector2<f64> {
    let error = seen.position_m - reference.position;
    // An error is closed against its direction; none has none.
    let ahead_m_s = -error.dot(&reference.velocity) / error.norm().max(f64::MIN_POSITIVE);
    let speed_m_s = configuration.limits.speed_horizontal_m_s;
    let closing_m_s = speed_m_s * closing_share(speed_m_s, ahead_m_s);
    let regulator = design.position.law.regulator();
    let horizon_m = if regulator.is_some() {
        horizon_m(closing_m_s, most_m_s2)
    } else {
        let bandwidth_rad_s = position_bandwidth_rad_s(configuration, design.attitude_loop().as_ref());
        planned_horizon_m(configuration.controllers.kind, closing_m_s, most_m_s2, bandwidth_rad_s)
    };
    let error = in_sight(&error, horizon_m);
    match regulator {
        Some(regulator) if configuration.controllers.governor => governed(configuration, regulator, &error),
        _ => error,
    }
}

/// By how much the reference moves what the law foresees, in turned axes, and what it will ask for. Where it rests there is nothing to
/// look ahead at.
fn foreseen<'a>(
    law: &PositionLaw,
    turn: &Turn,
    reference: &ReferenceMotion<2>,
    (ahead, asked): (impl Fn(usize) -> ReferenceMotion<2>, impl Fn(usize) -> Option<ReferenceMotion<2>>),
    room: &'a mut [f64],
) -> (Option<&'a [f64]>, Asked) {
    if reference.is_at_rest() {
        return (None, Asked::default());
    }
    // Some samples count for both.
    let known = [const { Cell::new(None) }; ASKED.len()];
    let ahead = |sample: usize| {
        let Some(place) = ASKED.iter().position(|asked| *asked == sample) else { return ahead(sample) };
        let then: ReferenceMotion<2> = known[place].get().unwrap_or_else(|| ahead(sample));
        known[place].set(Some(then));
        then
    };
    let moved = law.moved(room, |sample| {
        let then = ahead(sample);
        let state = turn.state(&(state_of(&then) - state_of(reference)));
        (state, turn.vector(&(then.thrust - reference.thrust)))
    });
    let beside: [_; FADED] = core::array::from_fn(|place| asked(ASKED[place]));
    let is_streamed = beside.iter().any(Option::is_some) && !reference.is_narrow;
    let all = ASKED.into_iter().map(ahead).chain(beside.into_iter().flatten()).chain([*reference]);
    let asked = Asked {
        is_streamed,
        is_bent: reference.is_bent,
        is_narrow: reference.is_bent && reference.is_narrow,
        ..Asked::default()
    };
    (moved, all.fold(asked, |most, then| asked_by(&most, &then)))
}

/// The state that a reference asks for. Feedback is none of it.
fn state_of(reference: &ReferenceMotion<2>) -> SVector<f64, POSITION_STATES> {
    by_axis([
        reference.position,
        reference.velocity,
        reference.thrust,
        reference.thrust_jerk,
        reference.thrust_snap,
        Vector2::zeros(),
    ])
}

/// What a reference asks for, as far as it is more than what it asks for at other times.
fn asked_by(asked: &Asked, reference: &ReferenceMotion<2>) -> Asked {
    Asked {
        thrust_m_s2: asked.thrust_m_s2.max(reference.thrust.norm()),
        speed_m_s: asked.speed_m_s.max(reference.velocity.norm()),
        jerk_m_s3: asked.jerk_m_s3.max(reference.thrust_jerk.norm()),
        snap_m_s4: asked.snap_m_s4.max(reference.thrust_snap.norm()),
        ..*asked
    }
}

/// By how much the motion of a reference moves that state from the sample before.
fn motion_of(reference: &ReferenceMotion<2>, before: &ReferenceMotion<2>) -> SVector<f64, POSITION_STATES> {
    let increments = reference.increments_since(before);
    SVector::from_fn(|state, _| {
        increments[state / AXIS_STATES].get(state % AXIS_STATES).copied().unwrap_or_default()
    })
}

/// The same state at another position.
fn with_position(
    state: &SVector<f64, POSITION_STATES>,
    position_m: &Vector2<f64>,
) -> SVector<f64, POSITION_STATES> {
    let mut moved = *state;
    (moved[0], moved[AXIS_STATES]) = (position_m.x, position_m.y);
    moved
}

/// x and its derivatives, then y and its derivatives.
fn by_axis(derivatives: [Vector2<f64>; AXIS_STATES]) -> SVector<f64, POSITION_STATES> {
    SVector::from_fn(|state, _| derivatives[state % AXIS_STATES][state / AXIS_STATES])
}

/// A derivative of x and y in such a state.
fn derivative(state: &SVector<f64, POSITION_STATES>, of: usize) -> Vector2<f64> {
    Vector2::new(state[of], state[AXIS_STATES + of])
}

/// The error that the regulator may see.
fn governed(
    configuration: &Configuration,
    regulator: &StateFeedback<POSITION_STATES, 2, 2>,
    error: &Vector2<f64>,
) -> Vector2<f64> {
    let period_s = configuration.controllers.position.sample_time_s();
    let limits = &configuration.limits;
    let governor = Governor {
        rate: integral_rate(regulator, 0, period_s).min(integral_rate(regulator, 1, period_s)),
        deceleration: BRAKING_SHARE * limits.acceleration_horizontal_m_s2,
        speed: limits.speed_horizontal_m_s,
    };
    governor.seen_vector(error)
}

/// A turn of horizontal vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Turn {
    cosine: f64,
    sine: f64,
}

impl Turn {
    /// That which brings a vector to the first axis; none if the axes differ.
    fn along(vector: &Vector2<f64>, is_isotropic: bool) -> Self {
        let size = libm::hypot(vector.x, vector.y);
        if is_isotropic && size > 0.0 && size.is_finite() {
            Self { cosine: vector.x / size, sine: -vector.y / size }
        } else {
            Self { cosine: 1.0, sine: 0.0 }
        }
    }

    fn inverse(&self) -> Self {
        Self { sine: -self.sine, ..*self }
    }

    fn vector(&self, vector: &Vector2<f64>) -> Vector2<f64> {
        Vector2::new(
            self.cosine * vector.x - self.sine * vector.y,
            self.sine * vector.x + self.cosine * vector.y,
        )
    }

    /// Of each derivative in a state by axis.
    fn state(&self, state: &SVector<f64, POSITION_STATES>) -> SVector<f64, POSITION_STATES> {
        by_axis(core::array::from_fn(|of| self.vector(&derivative(state, of))))
    }
}
