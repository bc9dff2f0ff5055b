//! Products of matrices of any size.

use nalgebra::DMatrix;

/// A B.
///
/// nalgebra's own product multiplies zeros, too, of which models of several axes mostly consist. This one sums up in the same order, so
/// that the result is the same but for the signs of zeros, as long as all elements are finite.
///
/// # Panics
/// Unless A has as many columns as B has rows.
pub(crate) fn product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    assert_eq!(a.ncols(), b.nrows(), "columns of A and rows of B");
    let rows = a.nrows();
    let mut sums = DMatrix::zeros(rows, b.ncols());
    if sums.is_empty() || b.is_empty() {
        return sums;
    }
    let columns = sums.as_mut_slice().chunks_exact_mut(rows);
    for (sums, factors) in columns.zip(b.as_slice().chunks_exact(b.nrows())) {
        for (factor, elements) in factors.iter().zip(a.as_slice().chunks_exact(rows)) {
            if *factor != 0.0 {
                for (sum, element) in sums.iter_mut().zip(elements) {
                    *sum += *element * *factor;
                }
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::product;

    /// To the bit; shapes without elements too.
    #[test]
    fn it_is_the_sum_in_the_order_of_the_columns() {
        for (rows, inner, columns) in [(1, 1, 1), (3, 7, 2), (12, 12, 12), (2, 0, 3), (0, 2, 2), (2, 2, 0)] {
            let element = |row: usize, column: usize| {
                let number = (7 * row + 5 * column) % 11;
                if number.is_multiple_of(3) { 0.0 } else { libm::sin(number as f64) }
            };
            let (a, b) = (DMatrix::from_fn(rows, inner, element), DMatrix::from_fn(inner, columns, element));
            let expected = DMatrix::from_fn(rows, columns, |row, column| {
                (0..inner).fold(0.0, |sum, k| sum + a[(row, k)] * b[(k, column)])
            });
            assert_eq!(product(&a, &b), expected, "{rows}×{inner} by {inner}×{columns}");
        }
    }
}
