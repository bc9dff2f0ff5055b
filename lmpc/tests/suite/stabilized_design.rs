//! Plans about a stabilizing feedback without limits: their cost, their shifts, and the gain that follows.

use lmpc::{Augmented, DesignError, Dlqr, LaguerreBasis, StabilizedDesign, Weights, spectral_radius};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

use crate::common::explicit_plan::{Start, simulate, simulated_cost};
use crate::common::lagged_integrators::{Case, case};
use crate::common::relative_difference;

/// Samples after which every plan here has settled.
const SETTLED: usize = 3000;

fn vector(values: &[f64], size: usize) -> DVector<f64> {
    DVector::from_fn(size, |i, _| values[i % values.len()])
}

/// In motion and away from the set-point, as eight values tell.
fn start(values: &[f64], channels: usize) -> Start {
    Start {
        measured: vector(&values[1..], 3 * channels),
        increment: vector(values, 3 * channels) * 0.1,
        error: vector(&values[5..], channels),
        input: vector(&values[2..], channels),
    }
}

fn usual() -> Case {
    Case { sample_time_s: 0.05, lag_s: 0.1, increment_weight: 1.0, slower: 100.0, terms: 5, scale: 0.7 }
}

fn difference_to_regulator(case: &Case) -> f64 {
    let design = case.design(1);
    relative_difference(design.gain(), design.dlqr().gain())
}

/// More terms can do all that fewer can: a plan from any state costs no more, and in the end what the regulator's does. The gain
/// follows, though not monotonically.
#[test]
fn plans_become_the_regulators_with_more_terms() {
    let x = DVector::from_column_slice(&[0.02, -0.1, 0.2, 1.0]);
    let excess = [1, 3, 5, 8, 12].map(|terms| {
        let design = Case { terms, ..usual() }.design(1);
        let best = -(design.coefficient_gain() * &x);
        design.cost_of(&x, &best) / x.dot(&(design.dlqr().cost() * &x)) - 1.0
    });
    assert!(excess[0] > 1e-2, "{excess:?}");
    assert!(excess.windows(2).all(|pair| pair[1] < pair[0]), "{excess:?}");
    assert!(excess[4] < 5e-4, "{excess:?}");
    assert!(difference_to_regulator(&Case { terms: 1, ..usual() }) > 0.1);
    assert!(difference_to_regulator(&Case { terms: 12, ..usual() }) < 1e-3);
}

#[test]
fn the_gain_becomes_the_regulators_as_the_feedback_does() {
    let off: Vec<f64> = [1000.0, 100.0, 10.0, 1.0]
        .map(|slower| difference_to_regulator(&Case { slower, terms: 2, ..usual() }))
        .to_vec();
    assert!(off.windows(2).all(|pair| pair[1] < pair[0]), "{off:?}");
    assert!(off[3] < 1e-9, "{off:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, ..ProptestConfig::default() })]

    /// V = [x; η]ᵀ S [x; η] is what the plan costs when it is flown.
    #[test]
    fn the_cost_is_that_of_the_simulated_plan(
        case in case(),
        channels in 1_usize..3,
        x in prop::collection::vec(-1.0..1.0, 8),
        eta in prop::collection::vec(-1.0..1.0, 5),
    ) {
        let design = case.design(channels);
        let start = start(&x, channels);
        let eta = vector(&eta, case.terms * channels);
        let planned = simulate(&design, &start, &eta, SETTLED);
        let (cost, simulated) = (design.cost_of(&start.augmented(), &eta), simulated_cost(&design, &planned));
        prop_assert!((cost - simulated).abs() <= 1e-7 * simulated, "{cost} {simulated}");
    }

    /// V(x⁺, A_lᵀη) = V(x, η) − xᵀQx − ΔuᵀRΔu, and what is left of the plan is flown as planned.
    #[test]
    fn the_shifted_plan_costs_the_stage_less(
        case in case(),
        channels in 1_usize..3,
        x in prop::collection::vec(-1.0..1.0, 8),
        eta in prop::collection::vec(-1.0..1.0, 5),
    ) {
        let design = case.design(channels);
        let states = 3 * channels;
        let start = start(&x, channels);
        let eta = vector(&eta, case.terms * channels);
        let planned = simulate(&design, &start, &eta, 30);
        let first = simulated_cost(&design, &simulate(&design, &start, &eta, 1));
        let before = design.cost_of(&planned.augmented[0], &eta);
        let shifted = design.shifted(&eta);
        let after = design.cost_of(&planned.augmented[1], &shifted);
        prop_assert!((after - (before - first)).abs() <= 1e-9 * before, "{after} {before} {first}");

        let next = &planned.augmented[1];
        let later = Start {
            measured: planned.states[1].clone(),
            increment: next.rows(0, states).into_owned(),
            error: next.rows(states, channels).into_owned(),
            input: planned.inputs[0].clone(),
        };
        let left = simulate(&design, &later, &shifted, 29);
        for m in 0..29 {
            let size = 1.0 + planned.states[m + 1].amax() + planned.inputs[m + 1].amax();
            prop_assert!((&left.states[m] - &planned.states[m + 1]).amax() <= 1e-9 * size);
            prop_assert!((&left.inputs[m] - &planned.inputs[m + 1]).amax() <= 1e-9 * size);
        }
    }

    /// No coefficients cost less than η = −S_ηη⁻¹ S_ηx x, and the gain makes the first move of that plan.
    #[test]
    fn the_gain_flies_the_cheapest_plan(
        case in case(),
        x in prop::collection::vec(-1.0..1.0, 4),
        other in prop::collection::vec(-1.0..1.0, 6),
    ) {
        let design = case.design(1);
        let start = Start {
            measured: DVector::zeros(3),
            increment: vector(&x, 3),
            error: vector(&x[3..], 1),
            input: DVector::zeros(1),
        };
        let x = start.augmented();
        let best = -(design.coefficient_gain() * &x);
        let least = design.cost_of(&x, &best);
        prop_assert!(design.cost_of(&x, &(&best + vector(&other, case.terms))) >= least);
        let first = &simulate(&design, &start, &best, 1).moves[0];
        prop_assert!((first + design.gain() * &x).amax() <= 1e-9 * (1.0 + first.amax()));
        // Nothing is cheaper than the regulator.
        prop_assert!(least >= (x.transpose() * design.dlqr().cost() * &x)[0] * (1.0 - 1e-9));
    }
}

#[test]
fn each_precondition_has_its_error() {
    let case = usual();
    let model = Augmented::new(&case.plant(1));
    let weights = Weights::output(&model, 1.0, 1.0).unwrap();
    let regulator = Dlqr::new(model.a(), model.b(), weights.q(), weights.r(), 1.0).unwrap();
    let basis = LaguerreBasis::new(4, 0.6).unwrap();
    let design = |gain: &DMatrix<f64>, bases: &[LaguerreBasis], lambda: f64| {
        StabilizedDesign::new(&model, &weights, gain, bases, lambda)
    };
    let gain = regulator.gain();
    assert!(design(gain, std::slice::from_ref(&basis), 1.0).is_ok());
    assert!(matches!(
        design(&DMatrix::zeros(1, 3), std::slice::from_ref(&basis), 1.0),
        Err(DesignError::Dimension { name: "K_s", expected: (1, 4), actual: (1, 3) })
    ));
    assert!(matches!(design(gain, &[], 1.0), Err(DesignError::BasisCount { expected: 1, actual: 0 })));
    // The paper's plan: three integrators that nobody stabilizes.
    let Err(DesignError::Unstable { spectral_radius }) =
        design(&DMatrix::zeros(1, 4), std::slice::from_ref(&basis), 1.0)
    else {
        panic!("an unstable plan has a design")
    };
    assert!((spectral_radius - 1.0).abs() < 1e-3);
    // A plan must decay faster than λᵐ.
    assert!(matches!(
        design(gain, &[LaguerreBasis::new(4, 0.95).unwrap()], 0.9),
        Err(DesignError::LaguerreDecay { .. })
    ));
    assert!(matches!(design(gain, std::slice::from_ref(&basis), 1.5), Err(DesignError::Lambda { .. })));
    let nan = DMatrix::from_element(1, 4, f64::NAN);
    assert!(design(&nan, std::slice::from_ref(&basis), 1.0).is_err());
    // A regulator that is known already is one of the same model, and stable.
    let beside = |regulator: &Dlqr| {
        StabilizedDesign::beside(regulator, &model, &weights, gain, std::slice::from_ref(&basis))
    };
    let (a, b, q, r) = (model.a(), model.b(), weights.q(), weights.r());
    assert_eq!(beside(&regulator), design(gain, std::slice::from_ref(&basis), 1.0));
    let growing = Dlqr::exponentially_weighted(a, b, q, r, 1.1).unwrap();
    assert!(matches!(beside(&growing), Err(DesignError::Lambda { .. })));
    let unit = DMatrix::identity(1, 1);
    let smaller = Dlqr::new(&unit, &unit, &unit, &unit, 1.0).unwrap();
    assert!(matches!(
        beside(&smaller),
        Err(DesignError::Dimension { name: "K of the regulator", expected: (1, 4), actual: (1, 1) })
    ));
}

/// A degree of stability λ: about a feedback that has it, so does the loop.
#[test]
fn a_degree_of_stability_bounds_the_closed_loop() {
    let model = Augmented::new(&usual().plant(1));
    let weights = Weights::output(&model, 1.0, 10.0).unwrap();
    let basis = LaguerreBasis::new(8, 0.7).unwrap();
    let free = Dlqr::new(model.a(), model.b(), weights.q(), weights.r(), 1.0).unwrap();
    let slow = Dlqr::new(model.a(), model.b(), weights.q(), &(weights.r() * 100.0), 0.9).unwrap();
    let bases = std::slice::from_ref(&basis);
    let design = StabilizedDesign::new(&model, &weights, slow.gain(), bases, 0.9).unwrap();
    let free = spectral_radius("A − BK", &(model.a() - model.b() * free.gain())).unwrap();
    assert!(free > 0.9 && design.spectral_radius() < 0.9, "{free} {}", design.spectral_radius());
    assert!(relative_difference(design.gain(), design.dlqr().gain()) < 1e-2);
}
