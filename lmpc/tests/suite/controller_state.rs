//! What a controller remembers: what was applied, what of it feedback added, and what is held when an input saturates.

use lmpc::{Controller, ControllerState, Sample, StateFeedback, Status, Step};
use nalgebra::{Vector1, Vector2, dmatrix, vector};

/// Two independent inputs with exact arithmetic: Δv = −2 Δx − 4 (y − r) and Δv = −8 Δx − 16 (y − r).
fn law() -> StateFeedback<2, 2, 2> {
    StateFeedback::new(&dmatrix![2.0, 0.0, 4.0, 0.0; 0.0, 8.0, 0.0, 16.0]).unwrap()
}

/// One sample with Δx = (0.5, 0.25), y − r = (−1, 0.5) and u_r = (10, 20), on top of v(k−1) = (3, −1).
fn stepped() -> (ControllerState<2, 2>, Step<2>) {
    let mut state = ControllerState::new(Vector2::zeros(), vector![4.0, 1.0], vector![1.0, 2.0]);
    assert_eq!(state.feedback(), vector![3.0, -1.0]);
    let sample = Sample {
        measured: vector![0.5, 0.25],
        increment: vector![0.5, 0.25],
        error: vector![-1.0, 0.5],
        input_reference: vector![10.0, 20.0],
        ..Sample::default()
    };
    let step = law().step(&mut state, &sample);
    (state, step)
}

#[test]
fn a_step_is_the_sum_of_feed_forward_earlier_feedback_and_both_parts_of_the_move() {
    let (state, step) = stepped();
    // v = 3 − 2·0.5 − 4·(−1) = 6 and −1 − 8·0.25 − 16·0.5 = −11
    assert_eq!(state.feedback(), vector![6.0, -11.0]);
    assert_eq!(step.input, vector![16.0, 9.0]);
    assert_eq!(step.increment, vector![16.0 - 4.0, 9.0 - 1.0]);
    assert_eq!(step.integral, vector![4.0, -8.0]);
    assert_eq!((step.status, step.iterations, step.active), (Status::Optimal, 0, 0));
    assert_eq!((state.applied(), state.measured()), (step.input, vector![0.5, 0.25]));
}

/// Only the input that saturates loses its integral action, and it keeps its state feedback.
#[test]
fn a_saturated_input_waits_with_its_integral_action_alone() {
    let (mut state, step) = stepped();
    state.apply_holding_integral(&vector![12.0, 9.0], &step.integral);
    // 3 − 2·0.5: the move without −4·(−1)
    assert_eq!(state.feedback(), vector![2.0, -11.0]);
    let (mut state, step) = stepped();
    state.apply_holding_integral(&vector![16.0, 9.5], &step.integral);
    assert_eq!(state.feedback(), vector![6.0, -3.0]);
}

#[test]
fn an_input_that_was_applied_as_asked_keeps_its_integral_action() {
    let (mut state, step) = stepped();
    state.apply_holding_integral(&step.input, &step.integral);
    assert_eq!(state.feedback(), vector![6.0, -11.0]);
}

/// Saturation is what exceeds the rounding of the actuators' arithmetic: a billionth of 1 + |u|.
#[test]
fn rounding_is_not_saturation() {
    let held_at = |input: f64, cut: f64| {
        let mut state = ControllerState::<1, 1>::new(Vector1::zeros(), Vector1::new(input), Vector1::zeros());
        state.apply_holding_integral(&Vector1::new(input - cut), &Vector1::new(1.0));
        state.feedback().x != input
    };
    for sign in [-1.0, 1.0] {
        assert!(!held_at(0.0, sign * 5e-10) && held_at(0.0, sign * 2e-9));
        assert!(!held_at(1e6, sign * 5e-4) && held_at(1e6, sign * 2e-3));
        assert!(!held_at(-1e6, sign * 5e-4) && held_at(-1e6, sign * 2e-3));
    }
}

#[test]
fn what_is_not_finite_is_never_remembered() {
    for broken in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (mut state, step) = stepped();
        let before = state;
        state.apply(&vector![broken, 0.0]);
        state.apply_holding_integral(&vector![12.0, 9.0], &vector![broken, 0.0]);
        state.turn_feedback(|feedback| vector![feedback.x, broken]);
        assert_eq!(state, before);
        // The other input is held all the same.
        state.apply_holding_integral(&vector![0.0, 0.0], &vector![broken, step.integral.y]);
        assert_eq!(state.feedback(), vector![6.0, -3.0]);
    }
}

#[test]
fn what_was_applied_instead_replaces_the_feedback() {
    let (mut state, _) = stepped();
    state.apply(&vector![12.5, 19.0]);
    assert_eq!((state.feedback(), state.applied()), (vector![2.5, -1.0], vector![12.5, 19.0]));
}

/// Axes that have turned by a right angle turn what feedback added, and leave the feed-forward alone.
#[test]
fn feedback_turns_with_the_axes() {
    let (mut state, _) = stepped();
    state.turn_feedback(|feedback| vector![-feedback.y, feedback.x]);
    assert_eq!(state.feedback(), vector![11.0, 6.0]);
    assert_eq!(state.applied(), vector![21.0, 26.0]);
}

/// A sample or a result that is not finite leaves the state as it was, and says so.
#[test]
fn a_broken_sample_holds_the_input() {
    let sample = Sample {
        measured: vector![0.5, 0.25],
        increment: vector![0.5, 0.25],
        error: vector![-1.0, 0.5],
        input_reference: vector![10.0, 20.0],
        ..Sample::default()
    };
    let broken = vector![0.0, f64::NAN];
    for sample in [
        Sample { measured: broken, ..sample },
        Sample { increment: broken, ..sample },
        Sample { error: broken, ..sample },
        Sample { input_reference: broken, ..sample },
    ] {
        let (mut state, _) = stepped();
        let before = state;
        let step = law().step(&mut state, &sample);
        assert_eq!((step.status, state), (Status::Held, before));
        assert_eq!((step.input, step.increment), (before.applied(), Vector2::zeros()));
        assert_eq!(step.integral, Vector2::zeros());
    }
}
