//! The Stein (discrete Lyapunov) equation by doubling.

use nalgebra::DMatrix;

use crate::product::product;

/// Solves X = A X Bᵀ + C for square, stable A and B, X = Σ Aᵏ C (Bᵀ)ᵏ, by doubling the number of
/// summed terms in each step (Smith's squared method). With A = B and C = W it is the stationary covariance of
/// x(k+1) = A x(k) + w(k), the covariance of w being W.
///
/// `None` when the sum does not converge, that is when ρ(A) ρ(B) ≥ 1. The shapes must fit: A and C n×n, B of the same size.
pub fn solve_stein(a: &DMatrix<f64>, b: &DMatrix<f64>, c: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    /// 2^60 terms: more than any stable pair in double precision needs.
    const MAXIMUM_DOUBLINGS: usize = 60;
    let is_one = a == b;
    let (mut a_k, mut b_k_t, mut x) = (a.clone(), b.transpose(), c.clone());
    for _ in 0..MAXIMUM_DOUBLINGS {
        let increment = product(&product(&a_k, &x), &b_k_t);
        x += &increment;
        if !x.iter().all(|value| value.is_finite()) {
            return None;
        }
        if increment.amax() <= f64::EPSILON * x.amax() {
            return Some(x);
        }
        a_k = product(&a_k, &a_k);
        b_k_t = if is_one { a_k.transpose() } else { product(&b_k_t, &b_k_t) };
    }
    None
}

#[cfg(test)]
mod tests {
    use alloc::vec; // used by dmatrix!

    use super::solve_stein;
    use nalgebra::dmatrix;

    /// x = a x b + c has the solution c / (1 − a b), however slowly its sum converges.
    #[test]
    fn scalar_equations_have_their_closed_form() {
        for (a, b, c) in [(0.5, -0.8, 3.0), (0.0, 0.9, 1.0), (0.999, 0.9999, 2.0), (3.0, 0.2, -1.0)] {
            let x = solve_stein(&dmatrix![a], &dmatrix![b], &dmatrix![c]).unwrap()[0];
            assert!(libm::fabs(x * (1.0 - a * b) / c - 1.0) < 1e-12, "a = {a}, b = {b}: {x}");
        }
    }

    #[test]
    fn a_sum_that_does_not_converge_has_no_solution() {
        assert!(solve_stein(&dmatrix![1.0], &dmatrix![1.0], &dmatrix![1.0]).is_none());
        assert!(solve_stein(&dmatrix![-1.5], &dmatrix![1.0], &dmatrix![1.0]).is_none());
    }

    /// A is 2×2, B 1×1: X = A X b + C.
    #[test]
    fn the_two_matrices_may_differ_in_size() {
        let (a, c) = (dmatrix![0.5, 1.0; 0.0, -0.4], dmatrix![1.0; 2.0]);
        let x = solve_stein(&a, &dmatrix![0.7], &c).unwrap();
        assert!((&x - (&a * &x * 0.7 + c)).amax() < 1e-14);
    }
}
