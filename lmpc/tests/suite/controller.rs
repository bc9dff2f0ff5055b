//! The run-time controller in closed loop.

use lmpc::{
    Augmented, Controller, ControllerState, DesignError, Discretization, LaguerreBasis, LmpcDesign,
    Reference, StateFeedback, StateSpace, Status, Step, Weighting, Weights,
};
use nalgebra::{DVector, RowVector2, Vector1, Vector2, dmatrix};
use proptest::prelude::*;

use crate::common::double_integrators;

const TIME: f64 = 0.05;

fn altitude() -> (StateSpace, LmpcDesign, StateFeedback<2, 1, 1>) {
    let plant = double_integrators(&[1.0], TIME, Discretization::ZeroOrderHold);
    let model = Augmented::new(&plant);
    let weights = Weights::output(&model, 1.0, 1.0).unwrap();
    let basis = [LaguerreBasis::new(5, 0.8187).unwrap()];
    let design = LmpcDesign::new(&model, &weights, &basis, 100, Weighting::exponential(1.2, 1.0)).unwrap();
    let controller = StateFeedback::from_design(&design).unwrap();
    (plant, design, controller)
}

fn advanced(plant: &StateSpace, x: Vector2<f64>, u: f64, disturbance: f64) -> Vector2<f64> {
    let next = plant.a() * DVector::from_column_slice(x.as_slice()) + plant.b() * (u + disturbance);
    Vector2::new(next[0], next[1])
}

/// One sample of the altitude, y = z.
fn step(
    controller: &StateFeedback<2, 1, 1>,
    state: &mut ControllerState<2, 1>,
    measured: &Vector2<f64>,
    reference: &Reference<2, 1>,
) -> Step<1> {
    let sample = reference.sample(&RowVector2::new(1.0, 0.0), &state.measured(), measured);
    controller.step(state, &sample)
}

fn at_rest() -> ControllerState<2, 1> {
    ControllerState::at_rest()
}

/// The closed loop runs exactly as A − BK says: Δu = −K [Δx_m; y − r].
#[test]
fn closed_loop_follows_its_eigenvalues() {
    let (plant, design, controller) = altitude();
    let model = Augmented::new(&plant);
    let closed_loop = model.a() - model.b() * design.gain();
    let reference = Reference::set_point(Vector2::new(3.0, 0.0), Vector1::zeros());
    let (mut state, mut x) = (at_rest(), Vector2::zeros());
    // [Δx_m; y − r] at the first sample.
    let mut predicted = DVector::from_column_slice(&[0.0, 0.0, -3.0]);
    for _ in 0..200 {
        let step = step(&controller, &mut state, &x, &reference);
        assert_eq!(step.status, Status::Optimal);
        x = advanced(&plant, x, step.input.x, 0.0);
        predicted = &closed_loop * predicted;
        assert!((x.x - 3.0 - predicted[2]).abs() < 1e-10);
    }
    assert!((x.x - 3.0).abs() < 1e-4);
}

proptest! {
    /// Integral action: no constant input disturbance leaves an error, from any state.
    #[test]
    fn constant_disturbance_leaves_no_error(
        disturbance in -5.0..5.0, goal in -10.0..10.0, z in -10.0..10.0, v in -3.0..3.0,
    ) {
        let (plant, _, controller) = altitude();
        let reference = Reference::set_point(Vector2::new(goal, 0.0), Vector1::zeros());
        let (mut state, mut x) = (at_rest(), Vector2::new(z, v));
        for _ in 0..800 {
            let step = step(&controller, &mut state, &x, &reference);
            x = advanced(&plant, x, step.input.x, disturbance);
        }
        prop_assert!((x.x - goal).abs() < 1e-8, "{}", x.x - goal);
    }

    /// No input, however absurd, makes the step panic or the state lose its numbers.
    #[test]
    fn absurd_measurements_are_survived(
        values in prop::collection::vec(
            prop_oneof![any::<f64>(), Just(f64::NAN), Just(f64::INFINITY), Just(1e308), -1.0..1.0], 4..40),
    ) {
        let (_, _, controller) = altitude();
        let mut state = at_rest();
        for pair in values.chunks_exact(4) {
            let reference = Reference {
                state: Vector2::new(pair[2], 0.0), increment: Vector2::zeros(), input: Vector1::new(pair[3]),
            };
            let before = state;
            let step = step(&controller, &mut state, &Vector2::new(pair[0], pair[1]), &reference);
            prop_assert!(step.input.x.is_finite());
            if step.status == Status::Held {
                prop_assert_eq!(state, before);
            }
            state.apply(&Vector1::new(pair[1]));
            prop_assert!(state.applied().x.is_finite());
        }
    }
}

/// With the motion of the reference and its input fed forward, a plant on the trajectory stays on it.
#[test]
fn a_trajectory_is_followed_without_error() {
    let (plant, _, controller) = altitude();
    let mut state = at_rest();
    let mut x = Vector2::zeros();
    let mut reference_state = Vector2::zeros();
    let mut previous = Vector2::zeros();
    for k in 0..400 {
        // A reference that the plant can follow: it is the plant's own motion under this input.
        let input = (0.02 * f64::from(k)).sin() + f64::from(k % 7) * 0.1;
        let reference = Reference {
            state: reference_state,
            increment: reference_state - previous,
            input: Vector1::new(input),
        };
        let step = step(&controller, &mut state, &x, &reference);
        x = advanced(&plant, x, step.input.x, 0.0);
        previous = reference_state;
        reference_state = advanced(&plant, reference_state, input, 0.0);
        assert!((x - reference_state).norm() < 1e-9, "sample {k}: {}", (x - reference_state).norm());
    }
}

/// Saturation cannot wind the integral action up: after a long time at the limit the input leaves it as
/// soon as the error asks for it.
#[test]
fn saturation_does_not_wind_up() {
    let (plant, _, controller) = altitude();
    let overshoot = |report: bool| {
        let reference = Reference::set_point(Vector2::new(20.0, 0.0), Vector1::zeros());
        let (mut state, mut x, mut top) = (at_rest(), Vector2::zeros(), 0.0_f64);
        for _ in 0..2000 {
            let wanted = step(&controller, &mut state, &x, &reference).input;
            let applied = wanted.map(|u| u.clamp(-2.0, 2.0));
            if report {
                state.apply(&applied);
            }
            x = advanced(&plant, x, applied.x, 0.0);
            top = top.max(x.x);
        }
        top - 20.0
    };
    let (reported, wound_up) = (overshoot(true), overshoot(false));
    assert!(reported < 0.5 * wound_up, "{reported} m and {wound_up} m");
}

#[test]
fn a_step_does_not_allocate() {
    let (_, _, controller) = altitude();
    let mut state = at_rest();
    let reference = Reference::set_point(Vector2::new(1.0, 0.0), Vector1::zeros());
    let allocations = allocation_counter::measure(|| {
        for _ in 0..100 {
            let step = step(&controller, &mut state, &Vector2::new(0.3, 0.1), &reference);
            state.apply(&step.input);
        }
    });
    assert_eq!(allocations.count_total, 0);
}

#[test]
fn wrong_sizes_are_refused() {
    let gain = dmatrix![1.0, 2.0, 3.0];
    assert!(StateFeedback::<2, 1, 1>::new(&gain).is_ok());
    let wrong = StateFeedback::<3, 1, 1>::new(&gain);
    assert_eq!(wrong, Err(DesignError::Dimension { name: "K", expected: (1, 4), actual: (1, 3) }));
    let wrong = StateFeedback::<2, 2, 1>::new(&gain);
    assert_eq!(wrong, Err(DesignError::Dimension { name: "K", expected: (2, 3), actual: (1, 3) }));
}
