//! The matrix exponential; nalgebra's own needs the standard library.

use nalgebra::DMatrix;

use crate::product::product;

/// exp(M) for a finite square M, by scaling, Taylor's series and squaring (Moler and Van Loan 2003,
/// method 3). Exact but for rounding when M is nilpotent, as integrator chains are.
pub(crate) fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    /// With ‖M‖ ≤ 1/2 the twentieth term is below 1e-24.
    const TERMS: u32 = 20;
    /// Squarings that the largest double needs; a matrix of them has a norm beyond it.
    const MAXIMUM_SQUARINGS: f64 = 1026.0;
    // Squares of large elements overflow: the norm of the matrix over its largest element does not.
    let largest = matrix.amax().max(f64::MIN_POSITIVE);
    let norm = largest * matrix.unscale(largest).norm();
    let squarings = libm::ceil(libm::log2(norm / 0.5)).clamp(0.0, MAXIMUM_SQUARINGS) as u32;
    let scaled = matrix * libm::ldexp(1.0, -(squarings as i32));

    let identity = DMatrix::identity(matrix.nrows(), matrix.ncols());
    let mut term = identity.clone();
    let mut sum = identity;
    for k in 1..=TERMS {
        term = product(&term, &scaled) / f64::from(k);
        sum += &term;
    }
    for _ in 0..squarings {
        sum = product(&sum, &sum);
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

    /// To the rounding of as many squarings as the size of the number needs.
    #[test]
    fn of_a_number_is_the_exponential_function() {
        for exponent in [-64.0, -3.7, -0.51, -0.5, -1e-3, 0.0, 0.2, 0.5, 0.51, 1.0, 7.3, 63.0, 64.0, 700.0] {
            let expected: f64 = libm::exp(exponent);
            let relative = exponential(&dmatrix![exponent])[0] / expected - 1.0;
            assert!(libm::fabs(relative) < 1e-15 * (10.0 + libm::fabs(exponent)), "{exponent}: {relative:e}");
        }
    }

    /// Beyond the range of a double there is infinity above and zero below.
    #[test]
    fn of_a_huge_number_is_the_limit() {
        for large in [1e3, 1e160, f64::MAX] {
            assert_eq!(exponential(&dmatrix![large])[0], f64::INFINITY, "{large:e}");
            assert_eq!(exponential(&dmatrix![-large])[0], 0.0, "{large:e}");
        }
    }

    #[test]
    fn of_a_nilpotent_matrix_is_its_finite_series() {
        let exact = dmatrix![1.0, 3.0, 7.5; 0.0, 1.0, 5.0; 0.0, 0.0, 1.0];
        let chain = dmatrix![0.0, 3.0, 0.0; 0.0, 0.0, 5.0; 0.0, 0.0, 0.0];
        assert!((exponential(&chain) - exact).amax() < 1e-13);
    }
}
