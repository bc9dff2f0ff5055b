//! A limit on the signals of some samples.

use alloc::vec::Vec;

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

use crate::sparse_rows::SparseRows;
use crate::{Precision, Sample};

/// Most components of a limited signal.
pub(crate) const COMPONENTS: usize = 3;
/// Samples that are looked at side by side.
const BLOCK: usize = 8;

/// A limit on the samples on which a plan moves it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub(crate) struct PlacedLimit<T> {
    pub(crate) directions: Vec<[T; COMPONENTS]>,
    /// Length of the longest direction.
    pub(crate) longest: T,
    pub(crate) relaxation: T,
    /// The largest and the smallest of [`PlacedLimit::scales`].
    pub(crate) largest_scale: T,
    pub(crate) smallest_scale: T,
    pub(crate) samples: usize,
    pub(crate) components: usize,
    /// Index of its first bound among [`Sample::upper`].
    pub(crate) first_bound: usize,
    /// Index of its first value among [`Sample::moved`].
    pub(crate) first_moved: usize,
    /// Where the samples of each component begin among all signals.
    pub(crate) first: [usize; COMPONENTS],
    pub(crate) first_row: usize,
    /// C and D.
    pub(crate) state: SparseRows<T>,
    pub(crate) input: SparseRows<T>,
    /// The largest magnitudes, on any sample, of what Δx_m and y − r are multiplied by in the plan without limits.
    pub(crate) most_by_increment: SparseRows<T>,
    pub(crate) most_by_error: SparseRows<T>,
}

impl<T: Precision> PlacedLimit<T> {
    /// The same limit in another precision.
    pub(crate) fn to_precision<U: Precision>(&self) -> PlacedLimit<U> {
        let number = |value: T| U::of(value.to_f64());
        PlacedLimit {
            directions: self.directions.iter().map(|direction| direction.map(number)).collect(),
            longest: number(self.longest),
            relaxation: number(self.relaxation),
            largest_scale: number(self.largest_scale),
            smallest_scale: number(self.smallest_scale),
            samples: self.samples,
            components: self.components,
            first_bound: self.first_bound,
            first_moved: self.first_moved,
            first: self.first,
            first_row: self.first_row,
            state: self.state.to_precision(),
            input: self.input.to_precision(),
            most_by_increment: self.most_by_increment.to_precision(),
            most_by_error: self.most_by_error.to_precision(),
        }
    }

    /// The constraint of a direction at a sample.
    pub(crate) fn row(&self, sample: usize, direction: usize) -> usize {
        self.first_row + sample * self.directions.len() + direction
    }

    /// Its values among those of [`Sample::upper`](crate::Sample::upper), as far as there are.
    pub(crate) fn bounds<'a>(&self, upper: &'a [T]) -> &'a [T] {
        let bounds = upper.get(self.first_bound..).unwrap_or_default();
        &bounds[..bounds.len().min(self.directions.len())]
    }

    /// The largest |signal|². Several samples are looked at side by side.
    #[inline]
    pub(crate) fn largest_square(&self, signals: &[T]) -> T {
        let mut largest = [T::zero(); BLOCK];
        for first in (0..self.samples).step_by(BLOCK) {
            let samples = BLOCK.min(self.samples - first);
            let mut squares = [T::zero(); BLOCK];
            for component in 0..self.components {
                let values = &signals[self.first[component] + first..][..samples];
                for (square, value) in squares.iter_mut().zip(values) {
                    *square += *value * *value;
                }
            }
            for (largest, square) in largest.iter_mut().zip(squares) {
                *largest = if square > *largest { square } else { *largest };
            }
        }
        largest.into_iter().fold(T::zero(), |a, b| if b > a { b } else { a })
    }

    /// One over the length of the rows of a direction, sample by sample; `scales` being those of all limits.
    #[inline]
    pub(crate) fn scales<'a>(&self, side: usize, scales: &'a [T]) -> &'a [T] {
        &scales[self.first_row + side * self.samples..][..self.samples]
    }

    /// The values of its first C components.
    #[inline]
    pub(crate) fn components<'a, const C: usize>(&self, signals: &'a [T]) -> [&'a [T]; C] {
        core::array::from_fn(|component| &signals[self.first[component]..][..self.samples])
    }

    /// The components at a sample among all signals.
    #[inline]
    pub(crate) fn at(&self, sample: usize, signals: &[T]) -> [T; COMPONENTS] {
        core::array::from_fn(|component| {
            if component < self.components { signals[self.first[component] + sample] } else { T::zero() }
        })
    }

    /// Whether the plan without limits keeps it whatever its samples are: by the most that all of them can differ from C x + D u.
    pub(crate) fn is_surely_kept<const N: usize, const P: usize, const Q: usize>(
        &self,
        sample: &Sample<'_, N, P, Q, T>,
        input: &SVector<T, P>,
    ) -> bool {
        let held = self.signal(sample.measured.as_slice(), input.as_slice());
        let mut beside = sum(
            self.most_by_increment.product_of_magnitudes(sample.increment.as_slice()),
            self.most_by_error.product_of_magnitudes(sample.error.as_slice()),
        );
        let moved = sample.moved.get(self.first_moved..).unwrap_or_default();
        for (sum, moved) in beside.iter_mut().zip(moved.chunks(self.samples.max(1))).take(self.components) {
            *sum += moved.iter().fold(T::zero(), |most, by| if by.abs() > most { by.abs() } else { most });
        }
        self.directions.iter().zip(self.bounds(sample.upper)).all(|(direction, bound)| {
            along(direction, &held) + along(&direction.map(|share| share.abs()), &beside) <= *bound
        })
    }

    /// C x + D u.
    pub(crate) fn signal(&self, state: &[T], input: &[T]) -> [T; COMPONENTS] {
        sum(self.state.product(state), self.input.product(input))
    }
}

pub(crate) fn along<T: Precision>(direction: &[T; COMPONENTS], signal: &[T; COMPONENTS]) -> T {
    direction[0] * signal[0] + direction[1] * signal[1] + direction[2] * signal[2]
}

fn sum<T: Precision>(one: [T; COMPONENTS], other: [T; COMPONENTS]) -> [T; COMPONENTS] {
    core::array::from_fn(|component| one[component] + other[component])
}
