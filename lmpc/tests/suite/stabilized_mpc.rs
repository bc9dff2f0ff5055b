//! Stabilized Laguerre MPC under limits: the program against another solver, the certificate, and what a step reports.

use lmpc::{
    ClosedLoop, Controller, ControllerState, DesignError, Sample, SignalLimit, StabilizedDesign,
    StabilizedMpc, Status, Trial,
};
use nalgebra::{DMatrix, DVector, SVector, Vector1, Vector3};
use proptest::prelude::*;

use crate::common::explicit_plan::{Optimum, Start, clarabel, simulate, simulated_cost};
use crate::common::lagged_integrators::{Case, case};

/// Up to 6 terms and the slack.
const E: usize = 7;
const SLACK_COST: f64 = 1e4;
type Law = StabilizedMpc<3, 1, 1, E>;
type State = ControllerState<3, 1, E>;

fn usual() -> Case {
    Case { sample_time_s: 0.05, lag_s: 0.1, increment_weight: 1.0, slower: 100.0, terms: 5, scale: 0.7 }
}

/// |u| ≤ upper and |v| ≤ upper at the given samples.
fn limits(samples: std::ops::Range<usize>, relaxation: f64) -> [SignalLimit; 2] {
    let range = || SignalLimit::range(1);
    [
        SignalLimit::of_inputs(3, 1, range(), samples.clone().collect()).giving_way_by(relaxation),
        SignalLimit::of_states(3, 1, &[1], range(), samples.collect()).giving_way_by(relaxation),
    ]
}

fn sample<'a>(start: &Start, upper: &'a [f64]) -> Sample<'a, 3, 1, 1> {
    Sample {
        measured: fixed(&start.measured),
        increment: fixed(&start.increment),
        error: fixed(&start.error),
        upper,
        ..Sample::default()
    }
}

fn fixed<const R: usize>(vector: &DVector<f64>) -> SVector<f64, R> {
    SVector::from_column_slice(vector.as_slice())
}

fn state(start: &Start) -> State {
    State::new(fixed(&(&start.measured - &start.increment)), fixed(&start.input), Vector1::zeros())
}

/// At rest on the origin, `goal` away.
fn at_rest(goal: f64) -> Start {
    Start {
        measured: DVector::zeros(3),
        increment: DVector::zeros(3),
        error: DVector::from_element(1, -goal),
        input: DVector::zeros(1),
    }
}

/// What the plant does under an input.
fn after(design: &StabilizedDesign, start: &Start, input: f64) -> Start {
    let plant = design.model().plant();
    let input = DVector::from_element(1, input);
    let next = plant.a() * &start.measured + plant.b() * &input;
    let increment = &next - &start.measured;
    Start { error: &start.error + plant.c() * &increment, measured: next, increment, input }
}

/// Δu of an optimum.
fn first_move(design: &StabilizedDesign, start: &Start, optimum: &Optimum) -> f64 {
    simulate(design, start, &optimum.eta, 1).moves[0][0]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// The move is that of the explicit program, whether its limits can be kept or not.
    #[test]
    fn a_step_solves_the_explicit_program(
        case in case(),
        goal in -5.0..5.0_f64,
        velocity in -1.5..1.5,
        input in -1.5..1.5,
        upper in prop::array::uniform4(0.2..2.0),
    ) {
        let design = case.design(1);
        let limits = limits(0..25, 1.0);
        let law = Law::new(&design, &limits, SLACK_COST).unwrap();
        let measured = DVector::from_column_slice(&[0.0, velocity, 0.1]);
        let increment = DVector::from_column_slice(&[velocity * case.sample_time_s, 0.0, 0.0]);
        let start = Start {
            measured,
            increment,
            error: DVector::from_element(1, -goal),
            input: DVector::from_element(1, input),
        };
        let Some(optimum) = clarabel(&design, &limits, SLACK_COST, &upper, &start) else {
            return Err(TestCaseError::reject("no reference"));
        };
        let step = law.step(&mut state(&start), &sample(&start, &upper));
        let expected = first_move(&design, &start, &optimum);
        let size = 1.0 + expected.abs();
        prop_assert!((step.increment.x - expected).abs() <= 1e-5 * size, "{} {expected}", step.increment.x);
        if optimum.slack > 1.1e-3 {
            prop_assert_eq!(step.status, Status::Relaxed);
        } else if optimum.slack < 0.9e-3 {
            prop_assert_eq!(step.status, Status::Optimal);
        }
    }

    /// Starting from the last active set changes nothing but the work.
    #[test]
    fn a_warm_start_gives_the_same(case in case(), goal in -5.0..5.0, upper in prop::array::uniform4(0.3..1.0)) {
        let design = case.design(1);
        let law = Law::new(&design, &limits(0..25, 1.0), SLACK_COST).unwrap();
        let mut start = at_rest(goal);
        let mut warm = state(&start);
        for _ in 0..60 {
            let cold = law.step(&mut state(&start), &sample(&start, &upper));
            let step = law.step(&mut warm, &sample(&start, &upper));
            prop_assert!((step.input - cold.input).norm() <= 1e-7 * (1.0 + cold.input.norm()));
            prop_assert_eq!(step.status, cold.status);
            start = after(&design, &start, step.input.x);
        }
    }

    /// What a state keeps from sample to sample changes no bit beside a state that keeps nothing: not after it was saved, which loses it,
    /// and not when other laws step with it in between.
    #[test]
    fn kept_factors_change_no_bit(case in case(), goal in -5.0..5.0, upper in prop::array::uniform4(0.3..1.0)) {
        let design = case.design(1);
        let laws = [1.0, 0.2].map(|relaxation| Law::new(&design, &limits(0..25, relaxation), SLACK_COST).unwrap());
        let mut start = at_rest(goal);
        let mut forgetting = state(&start);
        let mut keeping = forgetting.keeping::<E>();
        for at in 0..60 {
            if at % 7 == 6 {
                keeping = serde_json::from_str(&serde_json::to_string(&keeping).unwrap()).unwrap();
            }
            let law = &laws[usize::from(at % 5 == 4)];
            let step = law.step(&mut keeping, &sample(&start, &upper));
            prop_assert_eq!(step, law.step(&mut forgetting, &sample(&start, &upper)));
            prop_assert_eq!(keeping.keeping(), forgetting);
            start = after(&design, &start, step.input.x);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    /// With limits on all samples until the plan has settled, a program that can be met can be met ever after, and its cost
    /// decreases by the stage cost or more; V + cσ² does so even while limits are relaxed.
    #[test]
    fn the_optimal_cost_decreases_by_the_stage_cost(
        lag_s in 0.05..0.2,
        terms in 3_usize..7,
        scale in 0.4..0.8,
        goal in 0.5..4.0,
        relaxed in any::<bool>(),
    ) {
        let case = Case { lag_s, terms, scale, ..usual() };
        let design = case.design(1);
        let limits = limits(0..200, if relaxed { 1.0 } else { 0.0 });
        let upper = [2.0, 2.0, 0.6, 0.6];
        let law = Law::new(&design, &limits, SLACK_COST).unwrap();
        let mut start = at_rest(goal);
        let mut flying = state(&start);
        let Some(mut optimum) = clarabel(&design, &limits, SLACK_COST, &upper, &start) else {
            return Err(TestCaseError::reject("limits that cannot be met at first"));
        };
        let least = optimum.cost;
        for k in 0..30 {
            let step = law.step(&mut flying, &sample(&start, &upper));
            prop_assert_eq!(step.status, if optimum.slack > 1e-3 { Status::Relaxed } else { Status::Optimal });
            let stage = simulated_cost(&design, &simulate(&design, &start, &optimum.eta, 1));
            start = after(&design, &start, step.input.x);
            let next = clarabel(&design, &limits, SLACK_COST, &upper, &start);
            prop_assert!(next.is_some(), "sample {k} cannot be met");
            let next = next.unwrap();
            prop_assert!(
                next.cost <= optimum.cost - stage + 1e-5 * least,
                "sample {k}: {} after {} less {stage}", next.cost, optimum.cost
            );
            optimum = next;
        }
    }
}

#[test]
fn a_flight_keeps_its_limits_and_arrives() {
    let design = usual().design(1);
    let upper = [1.0, 1.0, 0.8, 0.8];
    let law = Law::new(&design, &limits(0..80, 1.0), 1e8).unwrap();
    let mut start = at_rest(2.0);
    let mut flying = state(&start);
    let mut limited = 0;
    for k in 0..400 {
        let step = law.step(&mut flying, &sample(&start, &upper));
        assert_eq!(step.status, Status::Optimal, "sample {k}");
        assert!(step.input.x.abs() <= 1.0 + 1e-3, "sample {k}: {}", step.input.x);
        start = after(&design, &start, step.input.x);
        assert!(start.measured[1].abs() <= 0.8 + 1e-3, "sample {k}: {}", start.measured[1]);
        limited += usize::from(step.active > 0);
    }
    assert!(limited > 5);
    assert!(start.error[0].abs() < 1e-4, "{}", start.error[0]);
}

#[test]
fn a_step_allocates_nothing_and_repeats_to_the_bit() {
    let design = usual().design(1);
    let upper = [0.5, 0.5, 0.8, 0.8];
    let law = Law::new(&design, &limits(0..40, 1.0), SLACK_COST).unwrap();
    let start = at_rest(5.0);
    let (mut one, mut two) = (state(&start), state(&start));
    let allocations = allocation_counter::measure(|| {
        for _ in 0..20 {
            let step = law.step(&mut one, &sample_of(&upper));
            assert!(step.active > 0);
            one.apply(&Vector1::zeros());
        }
    });
    assert_eq!(allocations.count_total, 0);
    for _ in 0..20 {
        law.step(&mut two, &sample_of(&upper));
        two.apply(&Vector1::zeros());
    }
    assert_eq!(one, two);
}

/// In single precision a flight along a limit of the speed has the inputs of double precision to a 500th of their limit, ends where that
/// ends, and allocates nothing.
#[test]
fn single_precision_flies_as_double() {
    let design = usual().design(1);
    let upper = [0.5, 0.5, 0.8, 0.8];
    let law = Law::new(&design, &limits(0..40, 1.0), SLACK_COST).unwrap();
    let single = law.to_precision::<f32>();
    assert_eq!(law.to_precision::<f64>(), law);
    let (mut start, mut start_single) = (at_rest(5.0), at_rest(5.0));
    let mut expected = state(&start);
    let mut state = ControllerState::<3, 1, E, f32>::at_rest();
    let upper_single = upper.map(|bound| bound as f32);
    let mut active = 0;
    for k in 0..300 {
        let input = law.step(&mut expected, &sample(&start, &upper)).input.x;
        let seen = sample(&start_single, &[]);
        let seen = Sample {
            measured: seen.measured.cast(),
            increment: seen.increment.cast(),
            error: seen.error.cast(),
            upper: &upper_single,
            ..Sample::default()
        };
        let mut step = None;
        let allocations = allocation_counter::measure(|| step = Some(single.step(&mut state, &seen)));
        assert_eq!(allocations.count_total, 0);
        let step = step.expect("a step");
        assert!((f64::from(step.input.x) - input).abs() < 1e-3, "sample {k}: {} {input}", step.input.x);
        active += usize::from(step.active > 0);
        start = after(&design, &start, input);
        start_single = after(&design, &start_single, f64::from(step.input.x));
    }
    assert!(active > 5);
    let apart = (start_single.error[0] - start.error[0]).abs();
    assert!(apart < 1e-3, "{apart}");
}

fn sample_of(upper: &[f64]) -> Sample<'_, 3, 1, 1> {
    Sample { error: Vector1::new(-5.0), upper, ..Sample::default() }
}

#[test]
fn what_is_not_finite_holds_the_input() {
    let design = usual().design(1);
    let upper = [0.5, 0.5, 0.8, 0.8];
    let law = Law::new(&design, &limits(0..40, 1.0), SLACK_COST).unwrap();
    for broken in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let samples = [
            Sample { error: Vector1::new(broken), ..sample_of(&upper) },
            Sample { increment: Vector3::new(0.0, broken, 0.0), ..sample_of(&upper) },
            Sample { measured: Vector3::new(0.0, broken, 0.0), ..sample_of(&upper) },
            Sample { input_reference: Vector1::new(broken), ..sample_of(&upper) },
        ];
        for sample in samples {
            let mut flying = State::new(Vector3::zeros(), Vector1::new(0.25), Vector1::zeros());
            let step = law.step(&mut flying, &sample);
            assert_eq!((step.status, step.input.x), (Status::Held, 0.25), "{sample:?}");
        }
    }
}

/// Bounds that are missing or infinite do not bound: the law without limits.
#[test]
fn without_bounds_it_is_the_linear_law() {
    let design = usual().design(1);
    let law = Law::new(&design, &limits(0..40, 1.0), SLACK_COST).unwrap();
    for upper in [&[][..], &[f64::INFINITY; 4]] {
        let start = at_rest(5.0);
        let step = law.step(&mut state(&start), &sample(&start, upper));
        assert_eq!(step, law.unconstrained().step(&mut state(&start), &sample(&start, upper)));
    }
}

/// What the reference moves by takes room: as if the bounds were lower by that much.
#[test]
fn the_motion_of_the_reference_takes_room() {
    let design = usual().design(1);
    let law = Law::new(&design, &limits(0..30, 1.0), SLACK_COST).unwrap();
    let moved = [0.2; 59]; // 30 inputs, and 29 speeds: that of now is measured.
    let told = Sample { moved: &moved, ..sample_of(&[1.2, 1.0, 1.1, 1.0]) };
    let step = |sample: &Sample<'_, 3, 1, 1>| law.step(&mut State::at_rest(), sample);
    let lower = step(&sample_of(&[1.0, 1.2, 0.9, 1.2]));
    assert!(lower.active > 0);
    assert!((step(&told).input - lower.input).norm() < 1e-12);
    let untold = step(&sample_of(&[1.2, 1.0, 1.1, 1.0]));
    assert!((untold.input - lower.input).norm() > 1e-3);
}

/// Limit by limit, sample by sample: an input, then the second state, of a reference that moves by m, 2 m, 3 m and 4 m in m samples.
#[test]
fn the_motion_of_the_reference_is_told_limit_by_limit() {
    let design = usual().design(1);
    let law = Law::new(&design, &limits(0..30, 1.0), SLACK_COST).unwrap();
    assert_eq!(law.moved_signals(), 59);
    let ahead = |sample: usize| {
        let m = sample as f64;
        (Vector3::new(m, 2.0 * m, 3.0 * m), Vector1::new(4.0 * m))
    };
    let mut room = [f64::NAN; 60];
    let moved = law.moved(&mut room, ahead).unwrap();
    let inputs = (0..30).map(|m| 4.0 * f64::from(m));
    let speeds = (1..30).map(|m| 2.0 * f64::from(m));
    assert_eq!(moved, inputs.chain(speeds).collect::<Vec<_>>());
    assert!(room[59].is_nan());
    assert_eq!(law.moved(&mut [0.0; 58], ahead), None);
}

#[test]
fn each_precondition_has_its_error() {
    let design = usual().design(1);
    let usual = limits(0..10, 1.0);
    for slack_cost in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Law::new(&design, &usual, slack_cost), Err(DesignError::SlackCost { .. })));
    }
    // Five coefficients and the slack do not fit five unknowns.
    assert!(matches!(
        StabilizedMpc::<3, 1, 1, 5>::new(&design, &usual, 1.0),
        Err(DesignError::Dimension { name: "S_ηη with slack", expected: (5, 5), actual: (6, 6) })
    ));
    assert!(StabilizedMpc::<4, 1, 1, 6>::new(&design, &usual, 1.0).is_err());
    let wide = |components: usize, samples: usize| SignalLimit {
        state: DMatrix::from_element(components, 3, 1.0),
        input: DMatrix::zeros(components, 1),
        directions: SignalLimit::range(components),
        samples: (1..=samples).collect(),
        relaxation: 1.0,
    };
    assert!(Law::new(&design, &[wide(3, 213)], 1.0).is_ok());
    assert!(matches!(Law::new(&design, &[wide(4, 1)], 1.0), Err(DesignError::Dimension { .. })));
    assert!(matches!(
        Law::new(&design, &[wide(3, 214)], 1.0),
        Err(DesignError::Dimension { name: "limited signals on all samples", expected: (640, 1), .. })
    ));
    let mut wrong = wide(1, 3);
    wrong.input = DMatrix::zeros(1, 2);
    assert!(matches!(
        Law::new(&design, &[wrong], 1.0),
        Err(DesignError::Dimension { name: "D of a limit", .. })
    ));
}

/// What the linear loop costs under the regulator's gain is xᵀPx (Riccati), and a limit that is broken costs its share.
#[test]
fn the_cost_of_a_flight_is_riccatis() {
    let design = usual().design(1);
    let limits = limits(0..1, 0.5);
    let regulator = lmpc::StateFeedback::<3, 1, 1>::new(design.dlqr().gain()).unwrap();
    let trial = Trial::<3, 1, 1>::step(Vector1::new(2.0));
    let fly = |upper: [f64; 4]| {
        let closed = ClosedLoop::new(design.model(), design.weights(), &limits, &upper, 100.0).unwrap();
        closed.fly::<3, 1, 1, 0>(&regulator, &trial, 50).unwrap()
    };
    let free = fly([1e3; 4]);
    let expected = 4.0 * design.dlqr().cost()[(3, 3)];
    assert!((free.stage_cost - expected).abs() < 1e-9 * expected, "{} {expected}", free.stage_cost);
    assert_eq!((free.violation, free.violation_cost), (0.0, 0.0));
    let fastest = fly([1e3, 1e3, 0.0, 1e3]);
    let slower = fly([1e3, 1e3, 0.1, 1e3]);
    // A relaxation of 0.5: so much of it less.
    assert!((fastest.violation - slower.violation - 0.2).abs() < 1e-12);
    assert!(fastest.violation_cost > 100.0 * fastest.violation * fastest.violation);
    assert!(ClosedLoop::new(design.model(), design.weights(), &limits, &[1.0; 3], 1.0).is_err());
}
