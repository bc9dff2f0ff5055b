//! Gains against the same design in numbers of 32 digits: those that are wrong are refused.

use lmpc::{
    Augmented, DesignError, Discretization, Dlqr, LaguerreBasis, LmpcDesign, StateSpace, StateSpaceMpcDesign,
    Weighting, Weights,
};
use nalgebra::{DMatrix, dmatrix};
use proptest::prelude::*;

use crate::common::double_double::DoubleDouble;
use crate::common::{double_integrators, paper_plants, relative_difference};

type Rows = Vec<Vec<DoubleDouble>>;

fn zeros(rows: usize, columns: usize) -> Rows {
    vec![vec![DoubleDouble::new(0.0); columns]; rows]
}

fn exact(matrix: &DMatrix<f64>) -> Rows {
    matrix.row_iter().map(|row| row.iter().map(|&value| DoubleDouble::new(value)).collect()).collect()
}

fn product(a: &Rows, b: &Rows) -> Rows {
    let mut c = zeros(a.len(), b[0].len());
    for (row, out) in a.iter().zip(&mut c) {
        for (value, b_row) in row.iter().zip(b) {
            for (sum, other) in out.iter_mut().zip(b_row) {
                *sum = *sum + *value * *other;
            }
        }
    }
    c
}

fn transposed(a: &Rows) -> Rows {
    (0..a[0].len()).map(|j| a.iter().map(|row| row[j]).collect()).collect()
}

fn add(sum: &mut Rows, other: &Rows) {
    for (row, other) in sum.iter_mut().zip(other) {
        for (value, other) in row.iter_mut().zip(other) {
            *value = *value + *other;
        }
    }
}

/// A⁻¹ B by elimination with pivots.
fn solved(mut a: Rows, mut b: Rows) -> Rows {
    let n = a.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].value().abs().total_cmp(&a[j][k].value().abs())).unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in (0..n).filter(|&i| i != k) {
            let factor = a[i][k] / a[k][k];
            for rows in [&mut a, &mut b] {
                let pivot_row = rows[k].clone();
                for (value, pivot) in rows[i].iter_mut().zip(pivot_row) {
                    *value = *value - factor * pivot;
                }
            }
        }
    }
    for (row, a) in b.iter_mut().zip(a.iter().enumerate().map(|(i, row)| row[i])) {
        for value in row {
            *value = *value / a;
        }
    }
    b
}

/// L(0)ᵀ Ω⁻¹ Ψ (38)–(50) of one input under a terminal weight, from the same A, B, Q, R, P and a.
fn terminal_gain(
    model: &Augmented,
    q: &DMatrix<f64>,
    r: f64,
    terms: usize,
    scale: f64,
    horizon: usize,
) -> DMatrix<f64> {
    let dlqr = Dlqr::new(model.a(), model.b(), q, &dmatrix![r], 1.0).unwrap();
    let (a, b, q, p) = (exact(model.a()), exact(model.b()), exact(q), exact(dlqr.cost()));
    let scale = DoubleDouble::new(scale);
    let beta = DoubleDouble::new(1.0) - scale * scale;
    let power = |exponent: usize| (0..exponent).fold(DoubleDouble::new(1.0), |product, _| product * -scale);
    let a_l: Rows = (0..terms)
        .map(|i| {
            let below = (0..i).map(|j| power(i - j - 1) * beta);
            let above = (i + 1..terms).map(|_| DoubleDouble::new(0.0));
            below.chain([scale]).chain(above).collect()
        })
        .collect();
    let mut l: Rows = (0..terms).map(|i| vec![beta.sqrt() * power(i)]).collect();
    let first = transposed(&l);
    let n = model.states();
    let (mut phi_t, mut a_m) = (zeros(n, terms), exact(&DMatrix::identity(n, n)));
    let (mut omega, mut psi) = (zeros(terms, terms), zeros(terms, n));
    for m in 1..=horizon {
        let l_t = transposed(&l);
        add(&mut omega, &product(&product(&l, &vec![vec![DoubleDouble::new(r)]]), &l_t));
        let mut next = product(&a, &phi_t);
        add(&mut next, &product(&b, &l_t));
        phi_t = next;
        a_m = product(&a, &a_m);
        let phi_q = product(&transposed(&phi_t), if m == horizon { &p } else { &q });
        add(&mut omega, &product(&phi_q, &phi_t));
        add(&mut psi, &product(&phi_q, &a_m));
        l = product(&a_l, &l);
    }
    let gain = product(&first, &solved(omega, psi));
    DMatrix::from_fn(1, n, |_, j| gain[0][j].value())
}

fn altitude(time: f64) -> Augmented {
    Augmented::new(&double_integrators(&[1.0], time, Discretization::ZeroOrderHold))
}

fn designed(
    model: &Augmented,
    rate: f64,
    r: f64,
    (terms, scale, horizon): (usize, f64, usize),
) -> (Result<LmpcDesign, DesignError>, DMatrix<f64>) {
    let q = dmatrix![0.0, 0.0, 0.0; 0.0, rate, 0.0; 0.0, 0.0, 1.0];
    let weights = Weights::new(model, q.clone(), dmatrix![r]).unwrap();
    let bases = [LaguerreBasis::new(terms, scale).unwrap()];
    let design = LmpcDesign::new(model, &weights, &bases, horizon, Weighting::Terminal { lambda: 1.0 });
    (design, terminal_gain(model, &q, r, terms, scale, horizon))
}

/// Numbers of 32 digits have them.
#[test]
fn the_reference_has_its_digits() {
    let (one, three) = (DoubleDouble::new(1.0), DoubleDouble::new(3.0));
    let third = one / three;
    assert!((third * three - one).value().abs() < 1e-31);
    assert!((three.sqrt() * three.sqrt() - three).value().abs() < 1e-30);
    assert!(((one + DoubleDouble::new(1e-25)) - one).value() == 1e-25);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Whatever is accepted has a gain that is right to 10⁻⁴, and to its own estimate.
    #[test]
    fn accepted_gains_are_right(
        time in -2.5..-0.5, rate in 0.0..5.0, weight in -3.0..2.0, terms in 1usize..11, horizon in 11usize..150,
        scale in prop_oneof![0.0..0.95, (-3.5..-1.0).prop_map(|exponent| 1.0 - 10_f64.powf(exponent))],
    ) {
        let model = altitude(10_f64.powf(time));
        let (design, reference) = designed(&model, rate, 10_f64.powf(weight), (terms, scale, horizon));
        match design {
            Ok(design) => {
                let error = relative_difference(design.gain(), &reference);
                prop_assert!(error < 1e-4, "{error:e}");
                prop_assert!(error < 1e-12 + 10.0 * design.gain_error(), "{error:e} of {:e}", design.gain_error());
            }
            Err(DesignError::IllConditioned { error, allowed, .. }) => prop_assert!(error > allowed && allowed == 1e-4),
            Err(error) => prop_assert!(matches!(error, DesignError::Unstable { .. }), "{error}"),
        }
    }
}

/// a = 0.999 over 60 samples: five functions that hardly differ, whose gain would be wrong in the first digit.
#[test]
fn functions_that_hardly_differ_are_refused() {
    for (time, horizon) in [(0.05, 60), (0.05, 150), (0.01, 60)] {
        match designed(&altitude(time), 0.0, 1.0, (5, 0.999, horizon)).0 {
            Err(error @ DesignError::IllConditioned { condition, .. }) => {
                assert!(condition > 1e15, "{condition:e}");
                let message = error.to_string();
                assert!(message.contains("Omega") && message.contains("fewer terms"), "{message}");
            }
            other => panic!("{time} s, {horizon} samples: {other:?}"),
        }
    }
}

/// A large condition number of Ω alone does no harm: the first move is well determined.
#[test]
fn a_large_condition_number_alone_is_accepted() {
    let (design, reference) = designed(&altitude(0.01), 0.0, 1.0, (8, 0.97, 60));
    let design = design.unwrap();
    assert!(design.condition_number() > 1e12, "{:e}", design.condition_number());
    assert!(relative_difference(design.gain(), &reference) < 1e-9);
}

/// The paper's designs and the tables' are far from refused.
#[test]
fn the_papers_designs_lose_nothing() {
    for (name, model) in paper_plants() {
        let weights = Weights::output(&model, 1.0, 1.0).unwrap();
        for weighting in [Weighting::exponential(1.2, 1.0), Weighting::Terminal { lambda: 1.0 }] {
            for terms in [1, 3, 5, 7, 9] {
                let basis = LaguerreBasis::for_control_horizon(terms, 30.0).unwrap();
                let bases = vec![basis; model.inputs()];
                match LmpcDesign::new(&model, &weights, &bases, 100, weighting) {
                    Ok(design) => assert!(
                        design.gain_error() < 1e-6,
                        "{name}, N = {terms}, {weighting:?}: {:e}",
                        design.gain_error()
                    ),
                    Err(error) => {
                        assert!(
                            terms == 1 && matches!(error, DesignError::Unstable { .. }),
                            "{name}: {error}"
                        );
                    }
                }
            }
        }
    }
}

/// An unstable plant over a long horizon: H holds numbers from 1 to 4⁶⁰.
#[test]
fn a_state_space_mpc_whose_gain_is_lost_is_refused() {
    let plant = StateSpace::new(dmatrix![2.0], dmatrix![1.0], dmatrix![1.0]).unwrap();
    let design = |horizon| {
        StateSpaceMpcDesign::new(&plant, &dmatrix![1.0], &dmatrix![1.0], horizon, horizon - 1).map(|_| ())
    };
    assert_eq!(design(8), Ok(()));
    let error = design(60).unwrap_err();
    assert!(matches!(error, DesignError::IllConditioned { name: "H", .. }), "{error}");
}
