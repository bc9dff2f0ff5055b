//! Inner loops over slices of equal length.

use nalgebra::SVector;

use crate::Precision;

/// Σ aᵢ bᵢ in four partial sums, which the compiler turns into vector instructions.
#[inline]
pub(crate) fn dot<T: Precision>(a: &[T], b: &[T]) -> T {
    let mut sums = [T::zero(); 4];
    let (a_chunks, a_rest) = a.as_chunks::<4>();
    let (b_chunks, b_rest) = b.as_chunks::<4>();
    for (x, y) in a_chunks.iter().zip(b_chunks) {
        for lane in 0..4 {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let rest: T = a_rest.iter().zip(b_rest).map(|(x, y)| *x * *y).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// Σ |aᵢ bᵢ|: what the rounding of their dot product is relative to.
pub(crate) fn dot_of_magnitudes<T: Precision>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).map(|(x, y)| (*x * *y).abs()).sum()
}

/// a ← a − t b.
#[inline]
pub(crate) fn subtract_scaled<T: Precision>(a: &mut [T], b: &[T], t: T) {
    for (x, y) in a.iter_mut().zip(b) {
        *x -= t * *y;
    }
}

/// sum ← sum + A x, column by column, with the elements of A in this order.
// One copy for all sizes: with known ones it would be unrolled, however long they are.
#[inline(never)]
pub(crate) fn add_product<T: Precision>(sum: &mut [T], matrix: &[T], x: &[T]) {
    for (column, factor) in matrix.chunks_exact(sum.len()).zip(x) {
        subtract_scaled(sum, column, -*factor);
    }
}

/// Turns two vectors towards each other: a ← a cos + b sin, b ← b cos − a sin.
#[inline]
pub(crate) fn turn<T: Precision>(a: &mut [T], b: &mut [T], cosine: T, sine: T) {
    for (x, y) in a.iter_mut().zip(b) {
        (*x, *y) = (*x * cosine + *y * sine, *y * cosine - *x * sine);
    }
}

/// Σ tⱼ bⱼ, a few elements at a time, which stay in registers through the sum.
#[inline]
pub(crate) fn combination<const N: usize, T: Precision>(b: &[SVector<T, N>], t: &[T]) -> SVector<T, N> {
    const FEW: usize = 8;
    let mut sum = SVector::<T, N>::zeros();
    let whole = N / FEW * FEW;
    for first in (0..whole).step_by(FEW) {
        let mut few = [T::zero(); FEW];
        for (b_j, t_j) in b.iter().zip(t) {
            for (x, y) in few.iter_mut().zip(&b_j.as_slice()[first..first + FEW]) {
                *x += *t_j * *y;
            }
        }
        sum.as_mut_slice()[first..first + FEW].copy_from_slice(&few);
    }
    for element in whole..N {
        sum[element] = b.iter().zip(t).map(|(b_j, t_j)| *t_j * b_j[element]).sum();
    }
    sum
}

/// The least of some numbers, infinity of none; NaN counts as none.
#[inline]
pub(crate) fn least<T: Precision>(values: &[T]) -> T {
    let smaller = |a: T, b: T| if b < a { b } else { a };
    let mut lanes = [T::INFINITY; 4];
    let (chunks, rest) = values.as_chunks::<4>();
    for chunk in chunks {
        for lane in 0..4 {
            lanes[lane] = smaller(lanes[lane], chunk[lane]);
        }
    }
    rest.iter().chain(&lanes).fold(T::INFINITY, |least, value| smaller(least, *value))
}

#[cfg(test)]
mod tests {
    use super::{combination, dot, dot_of_magnitudes, least, subtract_scaled, turn};
    use alloc::vec::Vec;
    use nalgebra::SVector;

    /// Whole numbers, whose sums are exact in any order: Σ i (i + 1) = n (n + 1)(n + 2) / 3.
    #[test]
    fn dot_products_of_any_length_are_exact_sums() {
        for n in 0_u32..14 {
            let (a, b): (Vec<f64>, Vec<f64>) = (1..=n).map(|i| (f64::from(i), f64::from(i + 1))).unzip();
            assert_eq!(dot(&a, &b), f64::from(n * (n + 1) * (n + 2) / 3), "{n} elements");
        }
    }

    #[test]
    fn magnitudes_do_not_cancel() {
        assert_eq!(dot_of_magnitudes(&[1.0, -2.0, 3.0], &[4.0, 5.0, -6.0]), 32.0);
    }

    #[test]
    fn the_least_is_found_at_any_place() {
        assert_eq!(least::<f64>(&[]), f64::INFINITY);
        for place in 0..11 {
            let mut values = [2.0, f64::NAN, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, f64::INFINITY, 2.5];
            values[place] = -1.0;
            assert_eq!(least(&values), -1.0, "at {place}");
        }
    }

    #[test]
    fn a_combination_is_summed_up_element_by_element() {
        let columns: [SVector<f64, 11>; 3] =
            core::array::from_fn(|column| SVector::from_fn(|row, _| (row * (column + 1)) as f64));
        // row (2 · 1 − 3 · 2)
        let expected = SVector::<f64, 11>::from_fn(|row, _| -4.0 * row as f64);
        assert_eq!(combination(&columns[..2], &[2.0, -3.0, 7.0]), expected);
    }

    #[test]
    fn a_quarter_turn_takes_one_vector_to_the_other() {
        let (mut a, mut b) = ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]);
        turn(&mut a, &mut b, 0.0, 1.0);
        assert_eq!((a, b), ([4.0, 5.0, 6.0], [-1.0, -2.0, -3.0]));
        turn(&mut a, &mut b, 0.5, 2.0);
        assert_eq!((a, b), ([0.0, -1.5, -3.0], [-8.5, -11.0, -13.5]));
    }

    #[test]
    fn a_multiple_is_subtracted() {
        let mut a = [1.0, 10.0, -4.0];
        subtract_scaled(&mut a, &[2.0, 3.0, 5.0], 0.5);
        assert_eq!(a, [0.0, 8.5, -6.5]);
    }
}
