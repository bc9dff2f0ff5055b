//! Laguerre MPC designs: the paper's claims, published numbers, and the limits.

#![allow(clippy::excessive_precision)] // As the other implementation printed them.

use lmpc::{
    Augmented, DesignError, Discretization, Dlqr, LaguerreBasis, LmpcDesign, Prediction, StateSpace,
    Weighting, Weights, condition_number,
};
use nalgebra::{DMatrix, DVector, dmatrix};
use proptest::prelude::*;

use crate::common::{bases, double_integrators, paper_plants, relative_difference};

fn paper_design(
    model: &Augmented,
    terms: usize,
    horizon: usize,
    weighting: Weighting,
) -> Result<LmpcDesign, DesignError> {
    let weights = Weights::output(model, 1.0, 1.0).unwrap();
    LmpcDesign::new(model, &weights, &bases(model, terms, 0.8187), horizon, weighting)
}

#[test]
fn gain_converges_to_the_regulators_as_terms_are_added() {
    let weighting = Weighting::exponential(1.2, 1.0);
    for (name, model) in paper_plants() {
        let error = |terms: usize| {
            let design = paper_design(&model, terms, 100, weighting).unwrap();
            relative_difference(design.gain(), design.dlqr().gain())
        };
        let errors: Vec<f64> = [1, 3, 5, 7, 9, 15].into_iter().map(error).collect();
        assert!(errors[5] < 1e-5, "{name}: {errors:?}");
        assert!(errors[5] < errors[2] && errors[2] < errors[0], "{name}: {errors:?}");
    }
}

/// Figure 4: with N = 5, a = 0.8187, α = 1.2 all eigenvalues lie inside the unit circle and coincide with
/// the regulator's.
#[test]
fn eigenvalues_are_the_regulators() {
    for (name, model) in paper_plants() {
        let design = paper_design(&model, 5, 100, Weighting::exponential(1.2, 1.0)).unwrap();
        assert!(design.spectral_radius() < 1.0);
        let regulated = lmpc::eigenvalues("A − BK", &(model.a() - model.b() * design.dlqr().gain())).unwrap();
        for eigenvalue in design.closed_loop_eigenvalues().unwrap() {
            let nearest = regulated
                .iter()
                .map(|other| libm::hypot(eigenvalue.re - other.re, eigenvalue.im - other.im))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.02, "{name}: {eigenvalue} is {nearest} off");
        }
    }
}

#[test]
fn weighting_keeps_omega_well_conditioned_and_its_absence_does_not() {
    for (name, model) in paper_plants() {
        for horizon in [50, 100, 200, 500, 1000] {
            let design = paper_design(&model, 5, horizon, Weighting::exponential(1.2, 1.0)).unwrap();
            assert!(
                design.condition_number() < 1e3,
                "{name}, N_p = {horizon}: {}",
                design.condition_number()
            );
        }
        // The plain cost (48) at N_p = 1000.
        let q = model.c().transpose() * model.c();
        let r = DMatrix::identity(model.inputs(), model.inputs());
        let plain =
            Prediction::new(model.a(), model.b(), &q, &r, &bases(&model, 5, 0.8187), 1000, None).unwrap();
        assert!(condition_number(plain.omega()) > 1e8, "{name}: {}", condition_number(plain.omega()));
    }
}

/// The recipe as (51)–(55) print it has K_w of (54) as its gain when there are terms enough and samples enough, whether
/// that is stable, as here, or not.
#[test]
fn the_literal_recipe_approaches_the_weighted_regulator() {
    let inertia = [1.0 / 0.1063, 1.0 / 0.1063, 1.0 / 0.2122];
    let model = Augmented::new(&double_integrators(&inertia, 0.05, Discretization::ForwardEuler));
    let weights = Weights::output(&model, 1.0, 0.1).unwrap();
    for alpha in [1.0, 1.1, 1.2] {
        let regulator =
            Dlqr::exponentially_weighted(model.a(), model.b(), weights.q(), weights.r(), alpha).unwrap();
        let error = |terms: usize| {
            let bases = bases(&model, terms, 0.7);
            let design =
                LmpcDesign::new(&model, &weights, &bases, 200, Weighting::Literal { alpha }).unwrap();
            relative_difference(design.gain(), regulator.gain())
        };
        assert!(error(14) < 1e-4 && error(14) < error(5), "α = {alpha}: {:e}, {:e}", error(14), error(5));
    }
}

#[test]
fn the_literal_recipe_is_refused_where_it_is_unstable() {
    // Altitude at 0.05 s with R = 1: spectral radius 1.019.
    let [(_, altitude), ..] = paper_plants();
    match paper_design(&altitude, 5, 100, Weighting::Literal { alpha: 1.2 }) {
        Err(DesignError::Unstable { spectral_radius }) => {
            assert!((spectral_radius - 1.019).abs() < 5e-4, "{spectral_radius}");
        }
        other => panic!("{other:?}"),
    }
    // Where it happens to be stable it is accepted: attitude at 0.05 s, R = 0.1 (numpy: 0.9912).
    let inertia = [1.0 / 0.1063, 1.0 / 0.1063, 1.0 / 0.2122];
    let model = Augmented::new(&double_integrators(&inertia, 0.05, Discretization::ForwardEuler));
    let weights = Weights::output(&model, 1.0, 0.1).unwrap();
    let design =
        LmpcDesign::new(&model, &weights, &bases(&model, 5, 0.8187), 100, Weighting::Literal { alpha: 1.2 })
            .unwrap();
    assert!((design.spectral_radius() - 0.9912).abs() < 1e-4, "{}", design.spectral_radius());
}

/// An independent NumPy implementation of the three recipes, for a plant whose two inputs have different
/// N, a and weights.
#[test]
fn numpy_val_two_inputs_with_their_own_bases() {
    let model = Augmented::new(&double_integrators(&[-9.81, 9.81], 0.05, Discretization::ForwardEuler));
    let q = model.c().transpose() * model.c();
    let weights = Weights::new(&model, q, dmatrix![2.0, 0.0; 0.0, 5.0]).unwrap();
    let bases = [LaguerreBasis::new(4, 0.6).unwrap(), LaguerreBasis::new(6, 0.8).unwrap()];
    let cases = [
        (
            Weighting::exponential(1.15, 1.0),
            [
                4.4801490381815228,
                1.0468561889803589,
                0.53808595530817027,
                3.4210306142946938,
                0.90253857099422174,
                0.35837801047059165,
            ],
            273.8583058314259,
        ),
        (
            Weighting::exponential(1.15, 0.97),
            [
                5.4493246462580132,
                1.2068481135436833,
                0.66124493759713399,
                4.3242232011366237,
                1.070244464289005,
                0.4569376922574398,
            ],
            416.84556470911286,
        ),
        (
            Weighting::Terminal { lambda: 1.0 },
            [
                4.8985843704711165,
                1.1122718141458883,
                0.57542108110920964,
                3.4242849546198988,
                0.90806153489501951,
                0.3537732333914867,
            ],
            265355.9300060319,
        ),
    ];
    for (weighting, [kx, kvx, kix, ky, kvy, kiy], condition) in cases {
        let design = LmpcDesign::new(&model, &weights, &bases, 60, weighting).unwrap();
        let expected = dmatrix![-kx, -kvx, 0.0, 0.0, -kix, 0.0; 0.0, 0.0, ky, kvy, 0.0, kiy];
        let difference = relative_difference(design.gain(), &expected);
        assert!(difference < 1e-9, "{weighting:?}: {difference:e}");
        assert!((design.condition_number() / condition - 1.0).abs() < 1e-6, "{weighting:?}");
    }
}

/// A terminal weight makes even a short horizon cost what the infinite one costs: with enough terms to
/// span the horizon the gain is the regulator's exactly.
#[test]
fn terminal_weight_gives_the_regulator_at_any_horizon() {
    for (name, model) in paper_plants() {
        for horizon in [6, 10, 30] {
            let weights = Weights::output(&model, 1.0, 1.0).unwrap();
            // a = 0 and N = N_p: every trajectory of moves can be represented.
            let pulses = bases(&model, horizon, 0.0);
            let design =
                LmpcDesign::new(&model, &weights, &pulses, horizon, Weighting::Terminal { lambda: 1.0 })
                    .unwrap();
            let difference = relative_difference(design.gain(), design.dlqr().gain());
            assert!(difference < 1e-8, "{name}, N_p = {horizon}: {difference:e}");
        }
    }
}

proptest! {
    /// Ω and Ψ are the quadratic form of the cost (48): simulate the prediction (46) for random η and x,
    /// add up the cost, compare.
    #[test]
    fn omega_and_psi_are_the_cost_of_the_simulated_prediction(
        terms in 1usize..5, scale in 0.0..0.9, horizon in 5usize..30,
        eta in prop::collection::vec(-1.0..1.0, 8), x in prop::collection::vec(-1.0..1.0, 6),
        with_terminal in any::<bool>(),
    ) {
        let model = Augmented::new(&double_integrators(&[-2.0, 3.0], 0.1, Discretization::ForwardEuler));
        let q = DMatrix::from_diagonal(&DVector::from_column_slice(&[0.1, 0.0, 0.3, 0.2, 1.0, 2.0]));
        let r = dmatrix![1.0, 0.3; 0.3, 2.0];
        let terminal = with_terminal.then(|| DMatrix::<f64>::identity(6, 6) * 7.0);
        let basis = [LaguerreBasis::new(terms, scale).unwrap(), LaguerreBasis::new(3, 0.5).unwrap()];
        let prediction =
            Prediction::new(model.a(), model.b(), &q, &r, &basis, horizon, terminal.as_ref()).unwrap();

        let total = terms + 3;
        let eta = DVector::from_column_slice(&eta[..total]);
        let x0 = DVector::from_column_slice(&x);
        let cost_of = |eta: &DVector<f64>| {
            // Without a terminal weight the moves are charged for ever: 400 samples are.
            let charged = if with_terminal { horizon } else { 400 };
            let mut state = x0.clone();
            let mut cost = 0.0;
            for m in 0..charged {
                let moves = DVector::from_column_slice(&[
                    basis[0].at(m).dot(&eta.rows(0, terms)),
                    basis[1].at(m).dot(&eta.rows(terms, 3)),
                ]);
                cost += (moves.transpose() * &r * &moves)[0];
                if m < horizon {
                    state = model.a() * state + model.b() * moves;
                    let weight = if m + 1 == horizon { terminal.as_ref().unwrap_or(&q) } else { &q };
                    cost += (state.transpose() * weight * &state)[0];
                }
            }
            cost
        };
        let simulated = cost_of(&eta) - cost_of(&DVector::zeros(total));
        let predicted = (eta.transpose() * prediction.omega() * &eta)[0]
            + 2.0 * (eta.transpose() * prediction.psi() * &x0)[0];
        prop_assert!((simulated - predicted).abs() < 1e-8 * (1.0 + simulated.abs()), "{simulated} and {predicted}");
    }

    /// Whatever is designed is stable; whatever is refused is refused with a reason.
    #[test]
    fn accepted_designs_are_stable(
        terms in 1usize..10, scale in 0.0..0.95, horizon in 10usize..120,
        alpha in 1.0..1.4, lambda in 0.8..1.0, weight in 1e-3..1e3, time in 0.002..0.2,
    ) {
        let model = Augmented::new(&double_integrators(&[1.0], time, Discretization::ZeroOrderHold));
        let weights = Weights::output(&model, 1.0, weight).unwrap();
        let design =
            LmpcDesign::new(&model, &weights, &bases(&model, terms, scale), horizon, Weighting::exponential(alpha, lambda));
        match design {
            Ok(design) => prop_assert!(design.spectral_radius() < 1.0),
            Err(error) => prop_assert!(
                matches!(error, DesignError::Unstable { .. } | DesignError::IllConditioned { .. }), "{error}"
            ),
        }
    }
}

/// Q = 4 CᵀC and R = 9 I: the output error is the last of the states.
#[test]
fn output_weights_are_multiples_of_the_papers() {
    let [(_, model), ..] = paper_plants();
    let weights = Weights::output(&model, 4.0, 9.0).unwrap();
    assert_eq!(*weights.q(), DMatrix::from_diagonal(&DVector::from_column_slice(&[0.0, 0.0, 4.0])));
    assert_eq!(*weights.r(), dmatrix![9.0]);
}

#[test]
fn violated_preconditions_are_named() {
    let [(_, model), ..] = paper_plants();
    let weights = Weights::output(&model, 1.0, 1.0).unwrap();
    let basis = [LaguerreBasis::new(5, 0.8187).unwrap()];
    let refused = |bases: &[LaguerreBasis], horizon, weighting| {
        LmpcDesign::new(&model, &weights, bases, horizon, weighting).unwrap_err()
    };
    let exponential = Weighting::exponential(1.2, 1.0);
    assert_eq!(refused(&[], 100, exponential), DesignError::BasisCount { expected: 1, actual: 0 });
    assert_eq!(refused(&basis, 4, exponential), DesignError::HorizonTooShort { horizon: 4, terms: 5 });
    for alpha in [0.9, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            refused(&basis, 100, Weighting::exponential(alpha, 1.0)),
            DesignError::Alpha { .. }
        ));
        assert!(matches!(refused(&basis, 100, Weighting::Literal { alpha }), DesignError::Alpha { .. }));
    }
    for lambda in [0.0, 1.01, f64::NAN] {
        assert!(matches!(
            refused(&basis, 100, Weighting::exponential(1.2, lambda)),
            DesignError::Lambda { .. }
        ));
        assert!(matches!(refused(&basis, 100, Weighting::Terminal { lambda }), DesignError::Lambda { .. }));
    }
    assert_eq!(
        Weights::output(&model, 1.0, 0.0).unwrap_err(),
        DesignError::NotPositiveDefinite { name: "R", eigenvalue: 0.0 }
    );
    assert!(matches!(
        Weights::output(&model, f64::NAN, 1.0),
        Err(DesignError::ElementNotFinite { name: "Q", .. })
    ));
    // Two states for one measured output that integrates nothing: y = 0 · x can never be steered.
    let blind =
        StateSpace::new(dmatrix![1.0, 1.0; 0.0, 1.0], dmatrix![0.0; 1.0], dmatrix![0.0, 0.0]).unwrap();
    let blind = Augmented::new(&blind);
    let error =
        LmpcDesign::new(&blind, &Weights::output(&blind, 1.0, 1.0).unwrap(), &basis, 100, exponential)
            .unwrap_err();
    assert!(matches!(error, DesignError::Uncontrollable { .. }), "{error}");
}
