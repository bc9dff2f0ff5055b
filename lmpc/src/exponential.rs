//! The matrix exponential; nalgebra's own needs the standard library.

use nalgebra::DMatrix;

/// exp(M) for a finite square M, by scaling, Taylor's series and squaring (Moler and Van Loan 2003,
/// method 3). Exact but for rounding when M is nilpotent, as integrator chains are.
pub(crate) fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    /// With ‖M‖ ≤ 1/2 the twentieth term is below 1e-24.
    const TERMS: u32 = 20;
    let norm = matrix.norm();
    let squarings = if norm > 0.5 { libm::ceil(libm::log2(norm / 0.5)).min(1100.0) as u32 } else { 0 };
    let scaled = matrix * libm::ldexp(1.0, -(squarings as i32));

    let identity = DMatrix::identity(matrix.nrows(), matrix.ncols());
    let mut term = identity.clone();
    let mut sum = identity;
    for k in 1..=TERMS {
        term = &term * &scaled / f64::from(k);
        sum += &term;
    }
    for _ in 0..squarings {
        sum = &sum * &sum;
    }
    sum
}

#[cfg(test)]
mod tests {
    use alloc::vec; // used by dmatrix!

    use super::exponential;
    use nalgebra::dmatrix;

    #[test]
    fn of_a_rotation_is_a_rotation() {
        // exp([0 −w; w 0]) = [cos w −sin w; sin w cos w]
        let w = 40.0;
        let rotation = exponential(&dmatrix![0.0, -w; w, 0.0]);
        let (sine, cosine) = (libm::sin(w), libm::cos(w));
        assert!((rotation - dmatrix![cosine, -sine; sine, cosine]).amax() < 1e-12);
    }

    #[test]
    fn of_a_nilpotent_matrix_is_its_finite_series() {
        let exact = dmatrix![1.0, 3.0, 7.5; 0.0, 1.0, 5.0; 0.0, 0.0, 1.0];
        let chain = dmatrix![0.0, 3.0, 0.0; 0.0, 0.0, 5.0; 0.0, 0.0, 0.0];
        assert!((exponential(&chain) - exact).amax() < 1e-13);
    }
}
