//! A few rows of a matrix without their zeros.

use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use crate::Precision;
use crate::placed_limit::COMPONENTS;

/// As many rows as a limited signal has components, mostly of zeros.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub(crate) struct SparseRows<T> {
    /// Columns and values, row by row.
    elements: Vec<(usize, T)>,
    /// Where each row ends.
    ends: [usize; COMPONENTS],
}

impl SparseRows<f64> {
    /// Of the elements that `value` tells of `rows` rows and of some columns.
    pub(crate) fn new(rows: usize, columns: usize, value: impl Fn(usize, usize) -> f64) -> Self {
        let mut elements = Vec::new();
        let ends = core::array::from_fn(|row| {
            if row < rows {
                let of_row = (0..columns).map(|column| (column, value(row, column)));
                elements.extend(of_row.filter(|(_, value)| *value != 0.0));
            }
            elements.len()
        });
        Self { elements, ends }
    }
}

impl<T: Precision> SparseRows<T> {
    /// The same rows in another precision.
    pub(crate) fn to_precision<U: Precision>(&self) -> SparseRows<U> {
        let element = |(column, value): &(usize, T)| (*column, U::of(value.to_f64()));
        SparseRows { elements: self.elements.iter().map(element).collect(), ends: self.ends }
    }

    /// A x.
    pub(crate) fn product(&self, x: &[T]) -> [T; COMPONENTS] {
        self.sums(|column, value| value * x[column])
    }

    /// |A| |x|, element by element.
    pub(crate) fn product_of_magnitudes(&self, x: &[T]) -> [T; COMPONENTS] {
        self.sums(|column, value| (value * x[column]).abs())
    }

    /// The sum of each row.
    #[inline]
    fn sums(&self, part: impl Fn(usize, T) -> T) -> [T; COMPONENTS] {
        // Signals of states alone, or of inputs alone.
        if self.elements.is_empty() {
            return [T::zero(); COMPONENTS];
        }
        let mut first = 0;
        self.ends.map(|end| {
            let row = &self.elements[first..end];
            first = end;
            row.iter().fold(T::zero(), |sum, (column, value)| sum + part(*column, *value))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::SparseRows;

    #[test]
    fn products_are_those_of_the_whole_matrix() {
        let matrix = [[0.0, 2.0, -3.0], [0.0, 0.0, 0.0]];
        let sparse = SparseRows::new(2, 3, |row, column| matrix[row][column]);
        assert_eq!(sparse.elements.len(), 2);
        let x = [7.0, -1.0, 5.0];
        assert_eq!(sparse.product(&x), [-17.0, 0.0, 0.0]);
        assert_eq!(sparse.product_of_magnitudes(&x), [17.0, 0.0, 0.0]);
        let last = SparseRows::new(3, 1, |row, _| row as f64);
        assert_eq!(
            (last.product(&[2.0]), last.to_precision::<f32>().product(&[2.0])),
            ([0.0, 2.0, 4.0], [0.0, 2.0, 4.0])
        );
    }
}
