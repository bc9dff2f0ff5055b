//! The Stein (discrete Lyapunov) equation by doubling.

use nalgebra::DMatrix;

/// Solves X = A X Bᵀ + C for square, stable A and B, X = Σ Aᵏ C (Bᵀ)ᵏ, by doubling the number of
/// summed terms in each step (Smith's squared method). With A = B and C = W it is the stationary covariance of
/// x(k+1) = A x(k) + w(k), the covariance of w being W.
///
/// `None` when the sum does not converge, that is when ρ(A) ρ(B) ≥ 1. The shapes must fit: A and C n×n, B of the same size.
pub fn solve_stein(a: &DMatrix<f64>, b: &DMatrix<f64>, c: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    /// 2^60 terms: more than any stable pair in double precision needs.
    const MAXIMUM_DOUBLINGS: usize = 60;
    let (mut a_k, mut b_k, mut x) = (a.clone(), b.clone(), c.clone());
    for _ in 0..MAXIMUM_DOUBLINGS {
        let increment = &a_k * &x * b_k.transpose();
        x += &increment;
        if !x.iter().all(|value| value.is_finite()) {
            return None;
        }
        if increment.amax() <= f64::EPSILON * x.amax() {
            return Some(x);
        }
        a_k = &a_k * &a_k;
        b_k = &b_k * &b_k;
    }
    None
}
