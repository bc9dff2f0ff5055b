//! Eigenvalues, condition numbers and residuals against their closed forms.

use lmpc::{DesignError, condition_number, eigenvalues, riccati_residual, spectral_radius};
use nalgebra::{Complex, DMatrix, DVector, dmatrix};
use proptest::prelude::*;

/// The largest distance between two sets of as many eigenvalues, each taken once, nearest first.
fn distance(found: &[Complex<f64>], expected: &[Complex<f64>]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let mut left = found.to_vec();
    let mut largest = 0.0_f64;
    for value in expected {
        let apart = |other: &Complex<f64>| (other.re - value.re).hypot(other.im - value.im);
        let nearest = (0..left.len()).min_by(|&i, &j| apart(&left[i]).total_cmp(&apart(&left[j]))).unwrap();
        largest = largest.max(apart(&left.swap_remove(nearest)));
    }
    largest
}

/// x → the next one of n places, in a ring.
fn cyclic_permutation(n: usize) -> DMatrix<f64> {
    DMatrix::from_fn(n, n, |i, j| f64::from(u8::from((j + 1) % n == i)))
}

fn roots_of_unity(n: usize) -> Vec<Complex<f64>> {
    (0..n)
        .map(|k| (std::f64::consts::TAU * k as f64 / n as f64).sin_cos())
        .map(|(sine, cosine)| Complex::new(cosine, sine))
        .collect()
}

/// No shift that follows from a cyclic permutation's trailing block moves it.
#[test]
fn eigenvalues_of_cyclic_permutations_are_the_roots_of_unity() {
    for n in 1..=80 {
        let permutation = cyclic_permutation(n);
        for matrix in [permutation.clone(), permutation.transpose(), -&permutation] {
            let sign = if matrix.sum() < 0.0 { -1.0 } else { 1.0 };
            let expected: Vec<_> = roots_of_unity(n).iter().map(|root| root * sign).collect();
            let distance = distance(&eigenvalues("A", &matrix).unwrap(), &expected);
            assert!(distance < 1e-13, "n = {n}: {distance:e}");
        }
    }
}

/// Several rings in one permutation: the roots of unity of each.
#[test]
fn eigenvalues_of_permutations_are_those_of_their_cycles() {
    let mut matrix = DMatrix::zeros(33, 33);
    let mut expected = Vec::new();
    let mut start = 0;
    for n in [10, 12, 11] {
        matrix.view_mut((start, start), (n, n)).copy_from(&cyclic_permutation(n));
        expected.extend(roots_of_unity(n));
        start += n;
    }
    // The same places in another order.
    let order: Vec<usize> = (0..33).map(|i| i * 7 % 33).collect();
    let shuffled = DMatrix::from_fn(33, 33, |i, j| matrix[(order[i], order[j])]);
    assert!(distance(&eigenvalues("A", &shuffled).unwrap(), &expected) < 1e-13);
}

/// Jordan blocks: a chain of n integrators has the eigenvalue 0 or 1 n times, which rounding spreads by ε^(1/n).
#[test]
fn defective_eigenvalues_are_found() {
    for n in [2, 5, 12, 20] {
        let chain = DMatrix::from_fn(n, n, |i, j| f64::from(u8::from(i + 1 == j)));
        for (diagonal, matrix) in [(0.0, chain.clone()), (1.0, &chain + DMatrix::identity(n, n))] {
            let expected = vec![Complex::new(diagonal, 0.0); n];
            assert_eq!(distance(&eigenvalues("A", &matrix).unwrap(), &expected), 0.0, "n = {n}");
        }
    }
}

fn square(n: usize) -> impl Strategy<Value = DMatrix<f64>> {
    prop::collection::vec(-1.0..1.0, n * n).prop_map(move |entries| DMatrix::from_vec(n, n, entries))
}

proptest! {
    /// Orthogonal matrices have eigenvalues on the unit circle; their sum is the trace.
    #[test]
    fn eigenvalues_of_orthogonal_matrices_lie_on_the_unit_circle(matrix in (1usize..25).prop_flat_map(square)) {
        let orthogonal = matrix.qr().q();
        let values = eigenvalues("A", &orthogonal).unwrap();
        let sum: Complex<f64> = values.iter().sum();
        prop_assert!((sum.re - orthogonal.trace()).abs() < 1e-12 && sum.im.abs() < 1e-12);
        for value in values {
            prop_assert!((value.re.hypot(value.im) - 1.0).abs() < 1e-12, "{value}");
        }
    }

    /// A rotated block diagonal of numbers and pairs has them as its eigenvalues, in states of any unit.
    #[test]
    fn eigenvalues_do_not_depend_on_the_states(
        (n, root) in (2usize..14).prop_flat_map(|n| (Just(n), square(n))),
        values in prop::collection::vec((-2.0..2.0_f64, 0.1..2.0_f64), 7),
        units in prop::collection::vec(-12.0..12.0, 14),
    ) {
        let (mut blocks, mut expected) = (DMatrix::zeros(n, n), Vec::new());
        for (pair, &(re, im)) in values.iter().enumerate().take(n / 2) {
            blocks.view_mut((2 * pair, 2 * pair), (2, 2)).copy_from(&dmatrix![re, -im; im, re]);
            expected.extend([Complex::new(re, im), Complex::new(re, -im)]);
        }
        if n % 2 == 1 {
            blocks[(n - 1, n - 1)] = values[6].0;
            expected.push(Complex::new(values[6].0, 0.0));
        }
        let rotation = root.qr().q();
        let matrix = rotation.transpose() * blocks * rotation;
        let unit = DVector::from_fn(n, |i, _| 10_f64.powf(units[i]));
        let scaled = DMatrix::from_fn(n, n, |i, j| matrix[(i, j)] * unit[i] / unit[j]);
        let distance = distance(&eigenvalues("A", &scaled).unwrap(), &expected);
        prop_assert!(distance < 1e-10, "{distance:e}");
    }
}

/// (x − 1)(x − 2) … (x − 12), by its coefficients: roots as sensitive as ε · 12¹² / 6!² or so.
#[test]
fn eigenvalues_of_a_companion_matrix_of_high_degree_are_its_roots() {
    let n = 12;
    let mut coefficients = vec![1.0];
    for root in 1..=n {
        let mut product = coefficients.clone();
        product.push(0.0);
        for (i, coefficient) in coefficients.iter().enumerate() {
            product[i + 1] -= f64::from(root) * coefficient;
        }
        coefficients = product;
    }
    let size = n as usize;
    let companion = DMatrix::from_fn(size, size, |i, j| {
        if i == 0 { -coefficients[j + 1] } else { f64::from(u8::from(i == j + 1)) }
    });
    let expected: Vec<_> = (1..=n).map(|root| Complex::new(f64::from(root), 0.0)).collect();
    let distance = distance(&eigenvalues("A", &companion).unwrap(), &expected);
    assert!(distance < 1e-4, "{distance:e}");
}

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
    let told = eigenvalues("A", &dmatrix![0.0, 1.0; f64::NEG_INFINITY, 0.0]);
    assert_eq!(
        told,
        Err(DesignError::ElementNotFinite { name: "A", row: 1, column: 0, value: f64::NEG_INFINITY })
    );
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
