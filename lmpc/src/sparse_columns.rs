//! Matrices without their zeros, for products of some rows side by side.

use alloc::vec::Vec;
use core::ops::Range;

use serde::{Deserialize, Serialize};

use crate::Precision;

/// Rows that are summed up side by side: as many as a processor has room for while it goes through the columns.
const ROWS: usize = 8;

/// A matrix in tiles of a few neighbouring rows, of which each holds the columns that are not zero in all of its rows.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub(crate) struct SparseColumns<T> {
    tiles: Vec<Tile>,
    columns: Vec<Column<T>>,
}

/// Neighbouring rows, at most [`ROWS`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Tile {
    rows: Range<usize>,
    /// Where its columns are.
    columns: Range<usize>,
}

/// A column of a tile, with zeros in the rows that the tile does not have.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
struct Column<T> {
    /// Element of the vector that it is multiplied by.
    source: usize,
    values: [T; ROWS],
}

impl SparseColumns<f64> {
    /// Adds the elements that `value` tells of a block of rows, from `first_row` on, and of all columns. Returns where they are, for
    /// [`SparseColumns::for_each_in_row`].
    pub(crate) fn add_block(
        &mut self,
        first_row: usize,
        rows: usize,
        columns: usize,
        value: impl Fn(usize, usize) -> f64,
    ) -> Range<usize> {
        let before = self.tiles.len();
        for first in (0..rows).step_by(ROWS) {
            let last = rows.min(first + ROWS);
            let first_column = self.columns.len();
            for source in 0..columns {
                let row = |row: usize| if first + row < last { value(first + row, source) } else { 0.0 };
                let values: [f64; ROWS] = core::array::from_fn(row);
                if values.iter().any(|value| *value != 0.0) {
                    self.columns.push(Column { source, values });
                }
            }
            self.tiles.push(Tile {
                rows: first_row + first..first_row + last,
                columns: first_column..self.columns.len(),
            });
        }
        before..self.tiles.len()
    }
}

impl<T: Precision> SparseColumns<T> {
    /// The same matrix in another precision.
    pub(crate) fn to_precision<U: Precision>(&self) -> SparseColumns<U> {
        let column = |column: &Column<T>| Column {
            source: column.source,
            values: column.values.map(|value| U::of(value.to_f64())),
        };
        SparseColumns { tiles: self.tiles.clone(), columns: self.columns.iter().map(column).collect() }
    }

    /// sums ← sums + A x.
    pub(crate) fn add_product(&self, x: &[T], sums: &mut [T]) {
        for tile in &self.tiles {
            if tile.columns.is_empty() {
                continue;
            }
            let product = product(&self.columns[tile.columns.clone()], x);
            let sums = &mut sums[tile.rows.clone()];
            if let Some(sums) = sums.first_chunk_mut() {
                add_whole(sums, &product);
            } else {
                for (sum, product) in sums.iter_mut().zip(&product) {
                    *sum += *product;
                }
            }
        }
    }

    /// A row of the block that is at `block`, told element by element.
    pub(crate) fn for_each_in_row(&self, block: Range<usize>, row: usize, mut tell: impl FnMut(usize, T)) {
        let tiles = &self.tiles[block];
        let Some(first) = tiles.first() else { return };
        let tile = &tiles[(row - first.rows.start) / ROWS];
        for column in &self.columns[tile.columns.clone()] {
            tell(column.source, column.values[row - tile.rows.start]);
        }
    }
}

/// The sum of a whole tile, whose size the compiler knows.
#[inline]
fn add_whole<T: Precision>(sums: &mut [T; ROWS], product: &[T; ROWS]) {
    for (sum, product) in sums.iter_mut().zip(product) {
        *sum += *product;
    }
}

/// The product of a tile. Its sums are kept in registers, and put together only where they are returned.
#[inline(never)]
fn product<T: Precision>(columns: &[Column<T>], x: &[T]) -> [T; ROWS] {
    let mut sums = [T::zero(); ROWS];
    for column in columns {
        let factor = x[column.source];
        for (sum, value) in sums.iter_mut().zip(&column.values) {
            *sum += *value * factor;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::SparseColumns;
    use alloc::vec::Vec;
    use nalgebra::DMatrix;

    /// Two blocks below one another, the first of more than one tile, with columns of zeros in a tile and in a block.
    #[test]
    fn products_and_rows_are_those_of_the_whole_matrix() {
        let upper = DMatrix::from_fn(11, 4, |row, column| match column {
            0 => row as f64,
            1 if row == 9 => 5.0,
            3 if row < 8 => 2.0 - row as f64,
            _ => 0.0,
        });
        let lower = DMatrix::from_row_slice(2, 4, &[0., 0., 6., 0., 7., 0., 0., 8.]);
        let mut sparse = SparseColumns::default();
        let above = sparse.add_block(0, 11, 4, |row, column| upper[(row, column)]);
        let below = sparse.add_block(11, 2, 4, |row, column| lower[(row, column)]);
        let whole =
            DMatrix::from_fn(
                13,
                4,
                |row, column| {
                    if row < 11 { upper[(row, column)] } else { lower[(row - 11, column)] }
                },
            );
        let x = [1.0, -2.0, 3.0, 0.5];
        let mut sums = [10.0; 13];
        sparse.add_product(&x, &mut sums);
        let expected = &whole * DMatrix::from_column_slice(4, 1, &x);
        assert!((0..13).all(|row| sums[row] == 10.0 + expected[row]), "{sums:?}");
        for row in 0..13 {
            let mut told = Vec::from([0.0; 4]);
            let block = if row < 11 { above.clone() } else { below.clone() };
            sparse.for_each_in_row(block, row, |column, value| told[column] += value);
            assert!((0..4).all(|column| told[column] == whole[(row, column)]), "{row}: {told:?}");
        }
    }
}
