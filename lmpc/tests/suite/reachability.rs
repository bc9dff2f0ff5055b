//! What inputs cannot reach and outputs do not show, in states, inputs and outputs of any unit.

use lmpc::{
    Augmented, Discretization, Dlqr, KalmanDesign, NoiseCovariance, StateSpace, spectral_radius,
    uncontrollable_eigenvalues, unobservable_eigenvalues,
};
use nalgebra::{Complex, DMatrix, DVector, dmatrix};
use proptest::prelude::*;

use crate::common::{double_integrators, relative_difference};

fn matrix(rows: usize, columns: usize) -> impl Strategy<Value = DMatrix<f64>> {
    prop::collection::vec(-1.0..1.0, rows * columns)
        .prop_map(move |entries| DMatrix::from_vec(rows, columns, entries))
}

/// Units from 10⁻¹² to 10¹².
fn units(count: usize) -> impl Strategy<Value = DVector<f64>> {
    prop::collection::vec(-12.0..12.0, count).prop_map(|exponents| {
        DVector::from_iterator(exponents.len(), exponents.into_iter().map(|e| 10_f64.powf(e)))
    })
}

/// x̃ = T x, ũ = F u.
fn in_units(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    states: &DVector<f64>,
    inputs: &DVector<f64>,
) -> (DMatrix<f64>, DMatrix<f64>) {
    (
        DMatrix::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] * states[i] / states[j]),
        DMatrix::from_fn(b.nrows(), b.ncols(), |i, j| b[(i, j)] * states[i] / inputs[j]),
    )
}

fn is_among(value: f64, found: &[Complex<f64>]) -> bool {
    found.iter().any(|other| (other.re - value).hypot(other.im) < 1e-6)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// Chains of integrators, exactly and by forward Euler, at short and long sample times, with an output that
    /// integrates: reachable from their inputs, and visible in their outputs.
    #[test]
    fn chains_of_integrators_are_reachable_in_any_unit(
        time in -6.0..1.0, exact in any::<bool>(), gains in prop::array::uniform2(-4.0..4.0),
        states in units(6), inputs in units(2),
    ) {
        let discretization = if exact { Discretization::ZeroOrderHold } else { Discretization::ForwardEuler };
        let gains = gains.map(|gain| 10_f64.powf(gain));
        let model = Augmented::new(&double_integrators(&gains, 10_f64.powf(time), discretization));
        let (a, b) = in_units(model.a(), model.b(), &states, &inputs);
        prop_assert_eq!(uncontrollable_eigenvalues(&a, &b).unwrap(), vec![]);
        let plant = model.plant();
        let (a, c_t) = in_units(&plant.a().transpose(), &plant.c().transpose(), &states.rows(0, 4).into(), &inputs);
        prop_assert_eq!(unobservable_eigenvalues(&a.transpose(), &c_t.transpose()).unwrap(), vec![]);
    }

    /// Random pairs are reachable, in their own units and in any others.
    #[test]
    fn random_pairs_are_reachable_in_any_unit(
        (a, b, states, inputs) in (1usize..7, 1usize..3).prop_flat_map(|(n, p)| (matrix(n, n), matrix(n, p), units(n), units(p))),
    ) {
        let (n, p) = b.shape();
        // Far enough from not being so.
        let reach = DMatrix::from_columns(&(0..n).flat_map(|k| {
            let reached = (0..k).fold(b.clone(), |reached, _| &a * reached);
            (0..p).map(move |j| reached.column(j).into_owned()).collect::<Vec<_>>()
        }).collect::<Vec<_>>());
        prop_assume!(reach.singular_values().min() > 1e-3);
        let (a, b) = in_units(&a, &b, &states, &inputs);
        prop_assert_eq!(uncontrollable_eigenvalues(&a, &b).unwrap(), vec![]);
    }

    /// A part that the inputs do not reach is found, mixed into the others by a rotation and then given units.
    #[test]
    fn what_is_not_reachable_is_found_in_any_unit(
        (a, b, rest, coupling, root, states, inputs) in (1usize..5, 1usize..3, 1usize..3).prop_flat_map(|(n, p, u)| (
            matrix(n, n), matrix(n, p), prop::collection::vec(0.3..2.0, u), matrix(n, u), matrix(n + u, n + u),
            units(n + u), units(p),
        )),
        rotated in any::<bool>(),
    ) {
        let (n, u) = (a.nrows(), rest.len());
        let mut whole = a.resize(n + u, n + u, 0.0);
        whole.view_mut((0, n), (n, u)).copy_from(&coupling);
        for (i, value) in rest.iter().enumerate() {
            whole[(n + i, n + i)] = *value;
        }
        let whole_b = b.resize_vertically(n + u, 0.0);
        let rotation = if rotated { root.qr().q() } else { DMatrix::identity(n + u, n + u) };
        let (whole, whole_b) = (rotation.transpose() * whole * &rotation, rotation.transpose() * whole_b);
        let (whole, whole_b) = in_units(&whole, &whole_b, &states, &inputs);
        let found = uncontrollable_eigenvalues(&whole, &whole_b).unwrap();
        let dual = unobservable_eigenvalues(&whole.transpose(), &whole_b.transpose()).unwrap();
        for value in rest {
            prop_assert!(is_among(value, &found), "{value} in {found:?}");
            prop_assert!(is_among(value, &dual), "{value} in {dual:?}");
        }
    }

    /// A regulator and a predictor are designed in any unit, and are the same but for the unit.
    #[test]
    fn designs_are_the_same_in_any_unit(states in units(3), inputs in units(1), outputs in units(1)) {
        let plant = double_integrators(&[2.0], 0.05, Discretization::ZeroOrderHold);
        let model = Augmented::new(&plant);
        let weight = |units: &DVector<f64>, weights: &[f64]| {
            DMatrix::from_diagonal(&DVector::from_fn(units.len(), |i, _| weights[i] / units[i] / units[i]))
        };
        let ones = (DVector::repeat(3, 1.0), DVector::repeat(1, 1.0));
        let regulator = |states: &DVector<f64>, inputs: &DVector<f64>| {
            let (a, b) = in_units(model.a(), model.b(), states, inputs);
            let dlqr = Dlqr::new(&a, &b, &weight(states, &[0.0, 0.3, 1.0]), &weight(inputs, &[0.1]), 1.0).unwrap();
            let radius = spectral_radius("A − BK", &(&a - &b * dlqr.gain())).unwrap();
            // u = F⁻¹ ũ, x̃ = T x
            (DMatrix::from_fn(1, 3, |_, j| dlqr.gain()[j] * states[j] / inputs[0]), radius)
        };
        let (gain, radius) = regulator(&states, &inputs);
        let (expected, expected_radius) = regulator(&ones.0, &ones.1);
        prop_assert!(relative_difference(&gain, &expected) < 1e-9, "{gain} {expected}");
        prop_assert!((radius - expected_radius).abs() < 1e-9);

        let predictor = |states: &DVector<f64>, outputs: &DVector<f64>| {
            let (a, b) = in_units(plant.a(), plant.b(), states, &ones.1);
            let c = DMatrix::from_fn(1, 2, |i, j| plant.c()[(i, j)] * outputs[i] / states[j]);
            let noise = NoiseCovariance::uncorrelated(
                DMatrix::from_diagonal(&DVector::from_fn(2, |i, _| [1e-3, 1e-2][i] * states[i] * states[i])),
                dmatrix![1e-4 * outputs[0] * outputs[0]],
            );
            let design = KalmanDesign::new(&StateSpace::new(a, b, c).unwrap(), &noise).unwrap();
            DMatrix::from_fn(2, 1, |i, _| design.gain()[i] / states[i] * outputs[0])
        };
        let two = states.rows(0, 2).into_owned();
        let (gain, expected) = (predictor(&two, &outputs), predictor(&DVector::repeat(2, 1.0), &ones.1));
        prop_assert!(relative_difference(&gain, &expected) < 1e-9, "{gain} {expected}");
    }
}

/// What is left of a zero after rounding reaches nothing.
#[test]
fn rounding_does_not_reach() {
    let a = dmatrix![0.5, 1.0; 1e-17, 1.5];
    for (a, b) in [(a, dmatrix![1.0; 0.0]), (dmatrix![0.5, 1.0; 0.0, 1.5], dmatrix![1.0; 1e-17])] {
        let found = uncontrollable_eigenvalues(&a, &b).unwrap();
        assert!(found.len() == 1 && is_among(1.5, &found), "{found:?}");
    }
}
