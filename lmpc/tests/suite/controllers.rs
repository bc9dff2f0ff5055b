//! All controllers through the one shape of a step: what every law must do, whichever it is.

use lmpc::{
    Augmented, Controller, ControllerState, Discretization, LaguerreBasis, LaguerreMpc, Limit, LmpcDesign,
    Precision, Quantity, Reference, Sample, StateFeedback, StateSpace, StateSpaceMpc, StateSpaceMpcDesign,
    StateSpaceMpcWeights, Status, Step, Weighting, Weights, unknowns,
};
use nalgebra::{RowVector2, Vector1, Vector2, dmatrix};

use crate::common::double_integrators;

const TIME: f64 = 0.05;
const MOVES: usize = 25;
const TERMS: usize = 5;
/// Room for the largest program.
const W: usize = unknowns(1, MOVES);
/// |Δu| ≤ 0.2, |u| ≤ 1
const UPPER: [f64; 4] = [0.2, 0.2, 1.0, 1.0];

type Law<T = f64> = dyn Controller<2, 1, 1, W, T>;

fn plant() -> StateSpace {
    double_integrators(&[1.0], TIME, Discretization::ZeroOrderHold)
}

fn advanced(x: Vector2<f64>, u: f64) -> Vector2<f64> {
    Vector2::new(x.x + TIME * x.y + TIME * TIME / 2.0 * u, x.y + TIME * u)
}

/// Every law on the same plant with the same weights, and whether it keeps limits.
fn laws() -> Vec<(&'static str, Box<Law>, bool)> {
    laws_in()
}

/// The same in any precision.
fn laws_in<T: Precision>() -> Vec<(&'static str, Box<Law<T>>, bool)> {
    let plant = plant();
    let model = Augmented::new(&plant);
    let weights = Weights::output(&model, 1.0, 1.0).unwrap();
    let bases = [LaguerreBasis::new(TERMS, 0.8).unwrap()];
    let design = LmpcDesign::new(&model, &weights, &bases, 100, Weighting::Terminal { lambda: 1.0 }).unwrap();
    let limits = [Limit::range(Quantity::Increment, 1, 0..TERMS), Limit::range(Quantity::Input, 1, 0..MOVES)];
    let weights = StateSpaceMpcWeights {
        output: dmatrix![1.0],
        moves: dmatrix![1.0],
        increment: dmatrix![0.0, 0.0; 0.0, 0.0],
        terminal: Some(design.dlqr().cost().clone()),
    };
    let moves = StateSpaceMpcDesign::with_weights(&plant, &weights, 60, MOVES).unwrap();
    type Laguerre = LaguerreMpc<2, 1, 1, { unknowns(1, TERMS) }>;
    let by_model = Laguerre::with_model_increment(&design, &limits).unwrap();
    let without_limits = StateFeedback::from_design(&design).unwrap();
    let regulator = StateFeedback::new(design.dlqr().gain()).unwrap();
    let laguerre = Laguerre::new(&design, &limits).unwrap();
    let state_space = StateSpaceMpc::<2, 1, 1, W>::new(&moves, &limits).unwrap();
    vec![
        ("Laguerre MPC without limits", Box::new(without_limits.to_precision()), false),
        ("DLQR", Box::new(regulator.to_precision()), false),
        ("Laguerre MPC", Box::new(laguerre.to_precision()), true),
        ("Laguerre MPC, model increment", Box::new(by_model.to_precision()), true),
        ("state-space MPC", Box::new(state_space.to_precision()), true),
    ]
}

/// One sample of a law on the way to a goal.
fn towards<T: Precision>(
    law: &Law<T>,
    state: &mut ControllerState<2, 1, W, T>,
    measured: &Vector2<f64>,
    goal: f64,
) -> Step<1, T> {
    let reference = Reference::set_point(Vector2::new(T::of(goal), T::zero()), Vector1::zeros());
    let output = RowVector2::new(T::one(), T::zero());
    let sample = reference.sample(&output, &state.measured(), &measured.map(T::of));
    law.step(state, &Sample { upper: &UPPER.map(T::of), ..sample })
}

#[test]
fn every_law_arrives_and_those_with_limits_keep_them() {
    for (name, law, limited) in &laws() {
        let (mut state, mut x, mut input, mut active) =
            (ControllerState::at_rest(), Vector2::zeros(), 0.0, 0);
        for k in 0..600 {
            let step = towards(&**law, &mut state, &x, 5.0);
            assert_eq!(step.status, Status::Optimal, "{name}, sample {k}");
            assert_eq!((step.increment.x, step.input), (step.input.x - input, state.applied()), "{name}");
            if *limited {
                assert!(step.increment.x.abs() <= 0.2 + 1e-8 && step.input.x.abs() <= 1.0 + 1e-8, "{name}");
            }
            active += step.active;
            (x, input) = (advanced(x, step.input.x), step.input.x);
        }
        assert!((x - Vector2::new(5.0, 0.0)).norm() < 1e-3, "{name}: {x}");
        assert_eq!(active > 0, *limited, "{name}");
    }
}

/// The way to a goal 5 m away: the inputs of 600 samples, how many held at limits, and where it ends.
fn flown<T: Precision>(law: &Law<T>) -> (Vec<f64>, usize, Vector2<f64>) {
    let (mut state, mut x) = (ControllerState::at_rest(), Vector2::zeros());
    let mut active = 0;
    let inputs = (0..600).map(|_| {
        let step = towards(law, &mut state, &x, 5.0);
        active += step.active;
        x = advanced(x, step.input.x.to_f64());
        step.input.x.to_f64()
    });
    (inputs.collect(), active, x)
}

/// The same designs in single precision: inputs within a 500th of their limit of those in double precision, at every sample of a flight
/// on which limits are active, and the same end.
#[test]
fn every_law_flies_in_single_precision_as_in_double() {
    for ((name, double, limited), (_, single, _)) in laws_in::<f64>().iter().zip(&laws_in::<f32>()) {
        let (expected, _, _) = flown(&**double);
        let (inputs, active, end) = flown(&**single);
        let apart = expected.iter().zip(&inputs).map(|(one, other)| (one - other).abs());
        let furthest = apart.fold(0.0, f64::max);
        assert!(furthest < 2e-3, "{name}: {furthest}");
        assert!(furthest > 0.0, "{name} did not calculate in single precision");
        assert!((end - Vector2::new(5.0, 0.0)).norm() < 2e-3, "{name}: {end}");
        assert_eq!(active > 0, *limited, "{name}");
    }
}

/// The state is the same for all, so that one law may take over from another in flight.
#[test]
fn any_law_takes_over_from_any_other() {
    let laws = laws();
    for (from, first, _) in &laws {
        for (to, second, _) in &laws {
            let (mut state, mut x) = (ControllerState::at_rest(), Vector2::zeros());
            for k in 0..600 {
                let law: &Law = if k < 40 { &**first } else { &**second };
                x = advanced(x, towards(law, &mut state, &x, 1.0).input.x);
            }
            assert!((x - Vector2::new(1.0, 0.0)).norm() < 1e-3, "{from} to {to}: {x}");
        }
    }
}

#[test]
fn a_saved_state_goes_on_as_the_original() {
    for (name, law, _) in &laws() {
        let (mut state, mut x) = (ControllerState::at_rest(), Vector2::zeros());
        for _ in 0..20 {
            x = advanced(x, towards(&**law, &mut state, &x, 5.0).input.x);
        }
        let saved = serde_json::to_string(&state).unwrap();
        let mut restored: ControllerState<2, 1, W> = serde_json::from_str(&saved).unwrap();
        assert_eq!(towards(&**law, &mut state, &x, 5.0), towards(&**law, &mut restored, &x, 5.0), "{name}");
        assert_eq!(state, restored, "{name}");
    }
}

#[test]
fn no_step_allocates() {
    no_step_allocates_in::<f64>();
    no_step_allocates_in::<f32>();
}

fn no_step_allocates_in<T: Precision>() {
    for (name, law, _) in &laws_in::<T>() {
        let (mut state, mut x) = (ControllerState::at_rest(), Vector2::zeros());
        let allocations = allocation_counter::measure(|| {
            for _ in 0..50 {
                x = advanced(x, towards(&**law, &mut state, &x, 5.0).input.x.to_f64());
            }
        });
        assert_eq!(allocations.count_total, 0, "{name}");
    }
}

/// x(k+1) = x(k) + u(k) with x(k+1) ≤ 0.5: towards a goal beyond, the first move goes to the bound.
#[test]
fn a_plant_of_one_state_goes_to_its_bound() {
    let one = dmatrix![1.0];
    let plant = StateSpace::new(one.clone(), one.clone(), one.clone()).unwrap();
    let limits = [Limit::range(Quantity::State, 1, 1..2)];
    let model = Augmented::new(&plant);
    let weights = Weights::output(&model, 1.0, 0.1).unwrap();
    let bases = [LaguerreBasis::new(3, 0.5).unwrap()];
    let design = LmpcDesign::new(&model, &weights, &bases, 40, Weighting::Terminal { lambda: 1.0 }).unwrap();
    let laguerre = LaguerreMpc::<1, 1, 1, 4>::new(&design, &limits).unwrap();
    let moves = StateSpaceMpcDesign::new(&plant, &one, &dmatrix![0.1], 40, 3).unwrap();
    let state_space = StateSpaceMpc::<1, 1, 1, 4>::new(&moves, &limits).unwrap();
    let laws: [(&str, &dyn Controller<1, 1, 1, 4>); 2] =
        [("Laguerre MPC", &laguerre), ("state-space MPC", &state_space)];
    for (name, law) in laws {
        // At x = 0.1, 10 below the goal, of which the state-space MPC goes by the deviation.
        let sample = Sample {
            measured: Vector1::new(0.1),
            deviation: Vector1::new(-10.0),
            error: Vector1::new(-10.0),
            ..Sample::default()
        };
        let first = |upper: f64| {
            let mut state = ControllerState::new(Vector1::new(0.1), Vector1::zeros(), Vector1::zeros());
            law.step(&mut state, &Sample { upper: &[upper, 1e3], ..sample })
        };
        let from = if name == "Laguerre MPC" { 0.1 } else { -10.0 };
        assert!(first(1e3).input.x > 1.0, "{name}");
        let bounded = first(from + 0.4);
        assert_eq!((bounded.status, bounded.active), (Status::Optimal, 1), "{name}");
        assert!((bounded.input.x - 0.4).abs() < 1e-9, "{name}: {bounded:?}");
    }
}

/// With the model's increment the law is the one with the measured increment, told the motion that the model explains:
/// x(k−1) is where the plant came from under u(k−1) + d.
#[test]
fn the_model_increment_is_the_motion_that_the_model_explains() {
    let model = Augmented::new(&plant());
    let weights = Weights::output(&model, 1.0, 1.0).unwrap();
    let bases = [LaguerreBasis::new(TERMS, 0.8).unwrap()];
    let design = LmpcDesign::new(&model, &weights, &bases, 100, Weighting::Terminal { lambda: 1.0 }).unwrap();
    type Laguerre = LaguerreMpc<2, 1, 1, { unknowns(1, TERMS) }>;
    let limits = [Limit::range(Quantity::Input, 1, 0..MOVES)];
    let by_model = Laguerre::with_model_increment(&design, &limits).unwrap();
    let measured = Laguerre::new(&design, &limits).unwrap();
    for (before, u, d, bound) in [
        (Vector2::new(0.4, -0.3), 0.2, 0.1, 1e3),
        (Vector2::new(-1.0, 0.6), -0.5, 0.3, 1e3),
        (Vector2::new(3.0, 0.5), 0.1, -0.2, 0.4),
    ] {
        let x = advanced(before, u + d);
        let upper = [bound; 2];
        let state = ControllerState::<2, 1, W>::new(before, Vector1::new(u), Vector1::zeros());
        let sample = Sample {
            measured: x,
            deviation: x,
            error: Vector1::new(x.x),
            disturbance: Vector1::new(d),
            upper: &upper,
            ..Sample::default()
        };
        let expected = measured.step(&mut state.clone(), &Sample { increment: x - before, ..sample });
        // What was measured of the motion is not looked at.
        for increment in [Vector2::zeros(), Vector2::new(5.0, -7.0)] {
            let step = by_model.step(&mut state.clone(), &Sample { increment, ..sample });
            assert!((step.input - expected.input).norm() < 1e-8, "{step:?} beside {expected:?}");
            assert_eq!(step.active, expected.active);
        }
    }
}
