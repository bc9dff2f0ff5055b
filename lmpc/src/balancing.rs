//! Balancing of a matrix before its eigenvalues are computed.

use nalgebra::DMatrix;

/// A change of scale must lessen the norms of a row and its column by this factor.
const WORTHWHILE: f64 = 0.95;
/// A sweep changes few scales after the first ones. This bounds matrices whose numbers span the range of a double.
const MAXIMUM_SWEEPS: usize = 100;

/// D⁻¹ M D with a diagonal D of powers of two, so that each row has about the norm of its column: the same eigenvalues
/// without rounding, and less of it in what follows when the states have different units.
///
/// The loop of LAPACK's `dgebal` since version 3.5 (James, Langou and Lowery 2014), in Euclidean norms with the diagonal.
pub(crate) fn balanced(mut matrix: DMatrix<f64>) -> DMatrix<f64> {
    for _ in 0..MAXIMUM_SWEEPS {
        let mut settled = true;
        for i in 0..matrix.nrows() {
            let exponent = exponent(matrix.column(i).norm(), matrix.row(i).norm());
            if exponent != 0 {
                let scale = libm::ldexp(1.0, exponent);
                matrix.column_mut(i).scale_mut(scale);
                matrix.row_mut(i).scale_mut(1.0 / scale);
                settled = false;
            }
        }
        if settled {
            break;
        }
    }
    matrix
}

/// Of the power of two by which a column and the inverse of which its row is to be multiplied.
fn exponent(column: f64, row: f64) -> i32 {
    // Far below what would overflow in a square.
    const LARGEST: f64 = 400.0;
    if !(column > 0.0 && row > 0.0 && column.is_finite() && row.is_finite()) {
        return 0;
    }
    let exponent = libm::round(0.5 * (libm::log2(row) - libm::log2(column))).clamp(-LARGEST, LARGEST) as i32;
    let scale = libm::ldexp(1.0, exponent);
    if libm::hypot(column * scale, row / scale) < WORTHWHILE * libm::hypot(column, row) {
        exponent
    } else {
        0
    }
}
