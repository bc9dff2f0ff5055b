//! Matrices column by column, without the zeros above and below.

use alloc::vec::Vec;
use core::ops::Range;

/// A matrix of which each column is stored from its first to its last element that is not zero.
///
/// Its product with a vector is a sum of columns: each addition runs over neighbouring elements, however few columns there are, and
/// columns of nothing but zeros cost nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SparseColumns {
    columns: Vec<Column>,
    values: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Column {
    /// Element of the vector that it is multiplied by.
    source: usize,
    first_row: usize,
    /// Where its values are.
    first_value: usize,
    length: usize,
}

impl SparseColumns {
    /// Adds the elements that `value` tells of a block of rows, from `first_row` on, and of all columns. Returns where they are, for
    /// [`SparseColumns::for_each_in_row`].
    pub(crate) fn add_block(
        &mut self,
        first_row: usize,
        rows: usize,
        columns: usize,
        value: impl Fn(usize, usize) -> f64,
    ) -> Range<usize> {
        let before = self.columns.len();
        for source in 0..columns {
            let is_used = |row: &usize| value(*row, source) != 0.0;
            let Some(first) = (0..rows).find(is_used) else { continue };
            let last = (first..rows).rfind(is_used).unwrap_or(first);
            self.columns.push(Column {
                source,
                first_row: first_row + first,
                first_value: self.values.len(),
                length: last + 1 - first,
            });
            self.values.extend((first..=last).map(|row| value(row, source)));
        }
        before..self.columns.len()
    }

    /// sums ← sums + A x.
    pub(crate) fn add_product(&self, x: &[f64], sums: &mut [f64]) {
        for column in &self.columns {
            let factor = x[column.source];
            let values = &self.values[column.first_value..][..column.length];
            let sums = &mut sums[column.first_row..][..column.length];
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += value * factor;
            }
        }
    }

    /// A row of the block that is at `block`, told element by element.
    pub(crate) fn for_each_in_row(&self, block: Range<usize>, row: usize, mut tell: impl FnMut(usize, f64)) {
        for column in &self.columns[block] {
            if (column.first_row..column.first_row + column.length).contains(&row) {
                tell(column.source, self.values[column.first_value + row - column.first_row]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::SparseColumns;
    use alloc::vec::Vec;
    use nalgebra::DMatrix;

    /// Two blocks below one another, with zeros at the ends of columns, within them, and in all of one.
    #[test]
    fn products_and_rows_are_those_of_the_whole_matrix() {
        let upper = DMatrix::from_row_slice(3, 4, &[0., 1., 0., 2., 3., 0., 0., 0., 4., 5., 0., 0.]);
        let lower = DMatrix::from_row_slice(2, 4, &[0., 0., 6., 0., 7., 0., 0., 8.]);
        let mut sparse = SparseColumns::default();
        let above = sparse.add_block(0, 3, 4, |row, column| upper[(row, column)]);
        let below = sparse.add_block(3, 2, 4, |row, column| lower[(row, column)]);
        let whole =
            DMatrix::from_fn(
                5,
                4,
                |row, column| {
                    if row < 3 { upper[(row, column)] } else { lower[(row - 3, column)] }
                },
            );
        let x = [1.0, -2.0, 3.0, 0.5];
        let mut sums = [10.0; 5];
        sparse.add_product(&x, &mut sums);
        let expected = &whole * DMatrix::from_column_slice(4, 1, &x);
        assert!((0..5).all(|row| sums[row] == 10.0 + expected[row]), "{sums:?}");
        for row in 0..5 {
            let mut told = Vec::from([0.0; 4]);
            let block = if row < 3 { above.clone() } else { below.clone() };
            sparse.for_each_in_row(block, row, |column, value| told[column] += value);
            assert!((0..4).all(|column| told[column] == whole[(row, column)]), "{row}: {told:?}");
        }
    }
}
