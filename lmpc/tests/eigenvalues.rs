//! Eigenvalues, condition numbers and residuals against their closed forms.

use lmpc::{DesignError, condition_number, eigenvalues, riccati_residual, spectral_radius};
use nalgebra::{DMatrix, dmatrix};

#[test]
fn eigenvalues_of_a_companion_matrix_are_the_roots_of_its_polynomial() {
    // (x − 2)(x² − 2x + 5) = x³ − 4x² + 9x − 10: 2 and 1 ± 2i
    let companion = dmatrix![4.0, -9.0, 10.0; 1.0, 0.0, 0.0; 0.0, 1.0, 0.0];
    let mut roots: Vec<(f64, f64)> =
        eigenvalues("A", &companion).unwrap().iter().map(|root| (root.re, root.im)).collect();
    roots.sort_by(|one, other| one.1.total_cmp(&other.1));
    for (root, expected) in roots.iter().zip([(1.0, -2.0), (2.0, 0.0), (1.0, 2.0)]) {
        assert!((root.0 - expected.0).hypot(root.1 - expected.1) < 1e-12, "{root:?}");
    }
    assert!((spectral_radius("A", &companion).unwrap() - 5.0_f64.sqrt()).abs() < 1e-12);
}

/// The iteration has time for large matrices too. The sum of the eigenvalues is the trace.
#[test]
fn eigenvalues_of_a_large_matrix_are_found() {
    let matrix = DMatrix::from_fn(150, 150, |i, j| ((i * 37 + j * 101 + i * j * 7) as f64).sin());
    let sum: f64 = eigenvalues("A", &matrix).unwrap().iter().map(|value| value.re).sum();
    assert!((sum - matrix.trace()).abs() < 1e-8, "{sum}");
}

#[test]
fn a_matrix_without_rows_has_none_and_wrong_ones_are_refused() {
    assert!(eigenvalues("A", &DMatrix::zeros(0, 0)).unwrap().is_empty());
    assert_eq!(spectral_radius("A", &DMatrix::zeros(0, 0)), Ok(0.0));
    assert_eq!(
        eigenvalues("A", &dmatrix![1.0, 2.0]),
        Err(DesignError::Dimension { name: "A", expected: (1, 1), actual: (1, 2) })
    );
    assert_eq!(eigenvalues("A", &dmatrix![f64::NAN]), Err(DesignError::NotFinite { name: "A" }));
}

#[test]
fn condition_numbers_are_ratios_of_singular_values() {
    assert!((condition_number(&dmatrix![4.0, 0.0; 0.0, -0.5]) - 8.0).abs() < 1e-14);
    // [1 1; 0 1]: (3 + √5)/2
    let shear = condition_number(&dmatrix![1.0, 1.0; 0.0, 1.0]);
    assert!((shear - (3.0 + 5.0_f64.sqrt()) / 2.0).abs() < 1e-14, "{shear}");
    assert_eq!(condition_number(&dmatrix![1.0, 0.0; 0.0, 0.0]), f64::INFINITY);
}

/// ‖AᵀPA − AᵀPB (R + BᵀPB)⁻¹ BᵀPA + Q − P‖ / max(‖P‖, ‖Q‖), for numbers by hand.
#[test]
fn residuals_of_wrong_solutions_have_their_size() {
    let residual = |a: f64, b: f64, q: f64, r: f64, p: f64| {
        riccati_residual(&dmatrix![a], &dmatrix![b], &dmatrix![q], &dmatrix![r], &dmatrix![p])
    };
    // 4·1 − (2·3·1)²/(7 + 9·1) + 5 − 1 = 23/4, over 5
    assert!((residual(2.0, 3.0, 5.0, 7.0, 1.0) - 5.75 / 5.0).abs() < 1e-15);
    // 4·8 − (2·3·8)²/(7 + 9·8) + 5 − 8 = 29 − 2304/79, over 8
    assert!((residual(2.0, 3.0, 5.0, 7.0, 8.0) - (2304.0_f64 / 79.0 - 29.0).abs() / 8.0).abs() < 1e-14);
    // Nothing is the solution of nothing, and is compared with nothing.
    assert_eq!(residual(2.0, 3.0, 0.0, 7.0, 0.0), 0.0);
    // R + BᵀPB = 0 has no inverse.
    assert_eq!(residual(2.0, 1.0, 5.0, 7.0, -7.0), f64::INFINITY);
}

/// Two states, two inputs: the order of the factors matters.
#[test]
fn residuals_of_matrices_are_those_of_the_equation_written_out() {
    let (a, b) = (dmatrix![0.9, 0.4; -0.2, 1.1], dmatrix![1.0, 0.5; -0.3, 2.0]);
    let (q, r) = (dmatrix![2.0, 0.3; 0.3, 1.0], dmatrix![1.5, 0.2; 0.2, 0.7]);
    let p = dmatrix![3.0, -0.4; -0.4, 5.0];
    let inner = (&r + b.transpose() * &p * &b).try_inverse().unwrap();
    let right = a.transpose() * &p * &a - a.transpose() * &p * &b * inner * b.transpose() * &p * &a + &q;
    let expected = (right - &p).norm() / p.norm();
    assert!((riccati_residual(&a, &b, &q, &r, &p) - expected).abs() < 1e-14);
}
