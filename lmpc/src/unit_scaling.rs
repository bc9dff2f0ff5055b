//! What inputs reach through the elements of a pair (A, B), in units in which these have one size.

use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector};

/// An element is rounding when it is this small beside its row and its column …
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// … and what goes around through it comes back this small, which does not depend on units.
const WEAK_CYCLE: f64 = 1e-14;
/// Below the binary logarithm of every positive number, and finite.
const LEAST_LOGARITHM: f64 = -1e4;

/// A pair (A, B) by the states that a way of non-zero elements leads to from an input, and those that none leads to.
///
/// Of the reached states, x = D x̃ and u = F ũ with diagonal D and F of powers of two, which lose no digit. A state's
/// unit is how far the inputs move it on the strongest way to it: the largest product of the elements along one, cycles
/// apart. In other units of the states and inputs these products change alike, so that Ã = D⁻¹ A D and B̃ = D⁻¹ B F are
/// the same whatever units A and B were given in, but for the rounding to powers of two. Each row has an element of the
/// size of the strongest cycle of A, and none has a much larger one: LAPACK's balancing of a matrix alone (`dgebal`) leaves
/// chains of integrators as they are, which have no cycle through two states.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct UnitScaling {
    /// Ã, of the reached states.
    pub(crate) a: DMatrix<f64>,
    /// B̃, of the reached states.
    pub(crate) b: DMatrix<f64>,
    /// A of the states that are not reached.
    pub(crate) rest: DMatrix<f64>,
}

impl UnitScaling {
    /// For finite A, n×n, and B, n×p.
    pub(crate) fn new(a: &DMatrix<f64>, b: &DMatrix<f64>) -> Self {
        let ways = Ways::new(a);
        let mut states = DVector::repeat(a.nrows(), f64::NEG_INFINITY);
        let mut inputs = Vec::new();
        for column in b.column_iter() {
            let reached = ways.strongest_from(&column.into_owned());
            // Inputs that reach the same states are made to reach them equally far.
            let level = common_level(&states, &reached);
            states = states.zip_map(&reached, |one, other| one.max(other + level));
            inputs.push(power_of_two(level));
        }
        let (is_reached, others): (Vec<usize>, Vec<usize>) =
            (0..a.nrows()).partition(|&i| states[i].is_finite());
        let unit: Vec<f64> = is_reached.iter().map(|&i| power_of_two(states[i])).collect();
        let size = is_reached.len();
        Self {
            a: DMatrix::from_fn(size, size, |i, j| a[(is_reached[i], is_reached[j])] / unit[i] * unit[j]),
            b: DMatrix::from_fn(size, b.ncols(), |i, j| b[(is_reached[i], j)] / unit[i] * inputs[j]),
            rest: DMatrix::from_fn(others.len(), others.len(), |i, j| a[(others[i], others[j])]),
        }
    }
}

/// log₂ of products of elements along ways through a matrix, over the mean of the strongest cycle, so that no way grows
/// without end; −∞ where there is no way.
struct Ways {
    /// From state j to state i, of any length, 0 from a state to itself.
    strongest: DMatrix<f64>,
}

impl Ways {
    fn new(a: &DMatrix<f64>) -> Self {
        let elements = a.map(logarithm);
        let cycle = strongest_cycle(&elements);
        let steps = elements.map(|element| element - cycle);
        let all = closure(&steps);
        let is_rounding = |i: usize, j: usize| {
            let there_and_back = steps[(i, j)] + all[(j, i)];
            there_and_back.is_finite()
                && there_and_back < libm::log2(WEAK_CYCLE)
                && libm::fabs(a[(i, j)]) <= ROUNDING * a.row(i).amax().min(a.column(j).amax())
        };
        let counted = DMatrix::from_fn(a.nrows(), a.ncols(), |i, j| {
            if is_rounding(i, j) { f64::NEG_INFINITY } else { steps[(i, j)] }
        });
        Self { strongest: closure(&counted) }
    }

    /// The strongest ways to each state from an input with this column of B.
    fn strongest_from(&self, column: &DVector<f64>) -> DVector<f64> {
        let n = column.len();
        let first = column.map(logarithm);
        // What an element adds to the other states, beside what the input does to them without it.
        let onwards = |i: usize| {
            // Where the input does nothing there is no share. The bound keeps the compiler, which may compute it all the same,
            // from subtracting infinity from infinity.
            let beside = |j: usize| self.strongest[(j, i)] + first[i] - first[j].max(LEAST_LOGARITHM);
            let others = (0..n).filter(|&j| j != i && first[j].is_finite());
            others.map(beside).filter(|share| share.is_finite()).reduce(f64::max)
        };
        let is_rounding = |i: usize| {
            libm::fabs(column[i]) <= ROUNDING * column.amax()
                && onwards(i).is_some_and(|share| share < libm::log2(WEAK_CYCLE))
        };
        let counted = DVector::from_fn(n, |i, _| if is_rounding(i) { f64::NEG_INFINITY } else { first[i] });
        DVector::from_fn(n, |i, _| {
            (0..n).map(|j| self.strongest[(i, j)] + counted[j]).fold(f64::NEG_INFINITY, f64::max)
        })
    }
}

/// The largest mean along a cycle, 0 where there is none, from the powers of the matrix in the max-plus algebra.
fn strongest_cycle(elements: &DMatrix<f64>) -> f64 {
    let n = elements.nrows();
    let mut power = elements.clone();
    let mut strongest = f64::NEG_INFINITY;
    for length in 1..=n {
        strongest = strongest.max(power.diagonal().max() / length as f64);
        power = max_plus(elements, &power);
    }
    if strongest.is_finite() { strongest } else { 0.0 }
}

/// The strongest ways of any length where no cycle is positive (Floyd and Warshall).
fn closure(steps: &DMatrix<f64>) -> DMatrix<f64> {
    let n = steps.nrows();
    let mut ways = steps.clone();
    ways.fill_diagonal(0.0);
    for through in 0..n {
        let from_there = ways.column(through).into_owned();
        for mut to in ways.column_iter_mut() {
            let there = to[through];
            raise(to.as_mut_slice(), from_there.as_slice(), there);
        }
    }
    ways
}

/// The product of two square matrices in the max-plus algebra.
fn max_plus(one: &DMatrix<f64>, other: &DMatrix<f64>) -> DMatrix<f64> {
    let mut product = DMatrix::repeat(one.nrows(), other.ncols(), f64::NEG_INFINITY);
    for (mut sums, factors) in product.column_iter_mut().zip(other.column_iter()) {
        for (elements, factor) in one.column_iter().zip(&factors) {
            raise(sums.as_mut_slice(), elements.as_slice(), *factor);
        }
    }
    product
}

/// Raises numbers to what leads further: the sums of `steps` and `further`. None of them is a NaN.
fn raise(numbers: &mut [f64], steps: &[f64], further: f64) {
    if further == f64::NEG_INFINITY {
        return;
    }
    for (number, step) in numbers.iter_mut().zip(steps) {
        let sum = step + further;
        // Not `max`, which looks for NaNs.
        *number = if sum > *number { sum } else { *number };
    }
}

/// By how much `reached` must be raised to agree in the mean with `states` where both have a value.
fn common_level(states: &DVector<f64>, reached: &DVector<f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (one, other) in states.iter().zip(reached) {
        if one.is_finite() && other.is_finite() {
            sum += one - other;
            count += 1.0;
        }
    }
    if count > 0.0 { sum / count } else { 0.0 }
}

/// log₂ |x|
fn logarithm(value: f64) -> f64 {
    if value == 0.0 { f64::NEG_INFINITY } else { libm::log2(libm::fabs(value)) }
}

/// The power of two nearest to 2^`logarithm`, in a range whose squares are doubles.
fn power_of_two(logarithm: f64) -> f64 {
    const LARGEST: f64 = 400.0;
    libm::ldexp(1.0, libm::round(logarithm).clamp(-LARGEST, LARGEST) as i32)
}
