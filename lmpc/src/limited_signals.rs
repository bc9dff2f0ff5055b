//! The signals that a stabilized Laguerre MPC keeps within limits, on all samples on which it does.

use alloc::vec::Vec;
use core::ops::Range;

use nalgebra::{DMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::product::product;
use crate::sparse_columns::SparseColumns;
use crate::{DesignError, Precision, Sample, SignalLimit, StabilizedDesign, validate};

/// Most components of a limited signal.
pub(crate) const COMPONENTS: usize = 3;
/// Most directions of a limit.
const DIRECTIONS: usize = u16::MAX as usize;
/// Most values of signals on all samples together: what a step keeps on the stack.
pub(crate) const SIGNALS: usize = 640;
/// Samples that are looked at side by side.
const BLOCK: usize = 8;
/// So many are kept in less room, which takes less time to clear.
pub(crate) const FEW_SIGNALS: usize = 96;

/// The limited signals as linear maps, for a plant of N states, P inputs and Q outputs and at most E unknowns. Component by
/// component, limit by limit, sample by sample, so that a column of a map is long. With the plan η = η₀ + L⁻ᵀ z of
/// [`PlanCoordinates`]:
///
/// ```text
/// signal = C x_m(k) + D (u_r(k) + v(k−1)) + of_increment Δx_m(k) + of_error (y − r) + of_plan z
/// ```
///
/// What does not depend on z are the signals of the plan without limits: whether it keeps them is a plain comparison.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub(crate) struct LimitedSignals<T> {
    limits: Vec<PlacedLimit<T>>,
    count: usize,
    of_increment: SparseColumns<T>,
    of_error: SparseColumns<T>,
    of_plan: SparseColumns<T>,
    /// Where the columns of each component are in [`LimitedSignals::of_plan`].
    plan_of_component: [Range<usize>; COMPONENTS],
    /// m, which limit, and which of its samples that is, in the order of m.
    by_sample: Vec<(usize, usize, usize)>,
    /// Limit, sample and direction of each row.
    places: Vec<[u16; 3]>,
    /// One over the length of each row in z and the slack, limit by limit, direction by direction, sample by sample.
    scales: Vec<T>,
}

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
    first_bound: usize,
    /// Index of its first value among [`Sample::moved`].
    first_moved: usize,
    /// Where the samples of each component begin among all signals.
    first: [usize; COMPONENTS],
    first_row: usize,
    /// C and D.
    state: SparseColumns<T>,
    input: SparseColumns<T>,
}

impl<T: Precision> PlacedLimit<T> {
    /// The same limit in another precision.
    fn to_precision<U: Precision>(&self) -> PlacedLimit<U> {
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

    /// C x + D u.
    fn signal(&self, state: &[T], input: &[T]) -> [T; COMPONENTS] {
        let mut signal = [T::zero(); COMPONENTS];
        self.state.add_product(state, &mut signal);
        self.input.add_product(input, &mut signal);
        signal
    }
}

/// How z stands for a plan: η = η₀ + L⁻ᵀ z with S_ηη = L Lᵀ, in which η₀ = −S_ηη⁻¹ S_ηx x is the plan without limits.
pub(crate) struct PlanCoordinates {
    /// −S_ηη⁻¹ S_ηx.
    pub(crate) unlimited: DMatrix<f64>,
    /// L⁻ᵀ.
    pub(crate) by_z: DMatrix<f64>,
}

/// The components of a limit at one of its samples.
struct SignalAt {
    /// Of \[Δx_m; y − r\], under the plan without limits.
    of_state: DMatrix<f64>,
    /// Of z.
    of_plan: DMatrix<f64>,
}

/// A constraint: a direction of a limit at a sample.
pub(crate) struct Place<'a, T> {
    pub(crate) limit: &'a PlacedLimit<T>,
    pub(crate) sample: usize,
    pub(crate) direction: usize,
    /// One over the length of its normal in z and the slack.
    pub(crate) scale: T,
}

/// χ(m) = Fᵐ \[x; η\] summed up: where the moves, and the states that they move, come from.
struct Motion {
    moves: Vec<DMatrix<f64>>,
    states: Vec<DMatrix<f64>>,
}

impl Motion {
    fn new(design: &StabilizedDesign, end: usize) -> Self {
        let plan = design.plan();
        let (size, inputs) = (plan.transition.nrows(), plan.move_of.nrows());
        let states = design.model().plant().states();
        let mut power = DMatrix::identity(size, size);
        let mut moves = DMatrix::zeros(inputs, size);
        let mut motion = DMatrix::zeros(states, size);
        let mut sums = Self { moves: Vec::with_capacity(end), states: Vec::with_capacity(end) };
        for _ in 0..end {
            moves += product(&plan.move_of, &power);
            sums.moves.push(moves.clone());
            sums.states.push(motion.clone());
            power = product(&plan.transition, &power);
            motion += power.rows(0, states);
        }
        sums
    }
}

impl LimitedSignals<f64> {
    /// Places limits on their samples. `slack_unit` is the slack that its element of z stands for.
    ///
    /// # Errors
    /// [`DesignError::Dimension`]: see [`StabilizedMpc::new`](crate::StabilizedMpc::new).
    pub(crate) fn new(
        design: &StabilizedDesign,
        limits: &[SignalLimit],
        coordinates: &PlanCoordinates,
        slack_unit: f64,
    ) -> Result<Self, DesignError> {
        let mut placed = Self {
            limits: Vec::new(),
            count: 0,
            of_increment: SparseColumns::default(),
            of_error: SparseColumns::default(),
            of_plan: SparseColumns::default(),
            plan_of_component: Default::default(),
            by_sample: Vec::new(),
            places: Vec::new(),
            scales: Vec::new(),
        };
        let end = limits.iter().flat_map(|limit| &limit.samples).max().map_or(0, |last| last + 1);
        let plant = design.model().plant();
        let motion = Motion::new(design, end);
        let mut bounds = 0;
        let mut signals = Vec::new();
        for limit in limits {
            let components = limit.directions.ncols();
            validate::shape("C of a limit", &limit.state, (components, plant.states()))?;
            validate::shape("D of a limit", &limit.input, (components, plant.inputs()))?;
            validate::shape(
                "directions of a limit",
                &limit.directions,
                (limit.directions.nrows().min(DIRECTIONS), components.min(COMPONENTS)),
            )?;
            signals.push(placed.add(limit, &motion, coordinates, slack_unit, bounds));
            bounds += limit.directions.nrows();
        }
        for component in 0..COMPONENTS {
            placed.add_component(component, [plant.states(), plant.outputs()], &signals);
        }
        if placed.count > SIGNALS {
            return Err(DesignError::Dimension {
                name: "limited signals on all samples",
                expected: (SIGNALS, 1),
                actual: (placed.count, 1),
            });
        }
        placed.by_sample.sort_unstable();
        Ok(placed)
    }

    /// Adds a limit on those of its samples on which a decision moves it: its signals there.
    fn add(
        &mut self,
        limit: &SignalLimit,
        motion: &Motion,
        coordinates: &PlanCoordinates,
        slack_unit: f64,
        first_bound: usize,
    ) -> Vec<SignalAt> {
        let (terms, augmented) = (coordinates.by_z.nrows(), coordinates.unlimited.ncols());
        let mut signals = Vec::new();
        let mut samples = limit.samples.clone();
        samples.sort_unstable();
        samples.dedup();
        for m in samples {
            let signal = product(&limit.state, &motion.states[m]) + product(&limit.input, &motion.moves[m]);
            let of_eta = signal.columns(augmented, terms);
            let of_plan = of_eta * &coordinates.by_z;
            if of_plan.amax() > 0.0 {
                let of_state = signal.columns(0, augmented) + of_eta * &coordinates.unlimited;
                self.by_sample.push((m, self.limits.len(), signals.len()));
                signals.push(SignalAt { of_state, of_plan });
            }
        }
        let components = limit.directions.ncols();
        let (mut state, mut input) = (SparseColumns::default(), SparseColumns::default());
        state.add_block(0, components, limit.state.ncols(), |row, at| limit.state[(row, at)]);
        input.add_block(0, components, limit.input.ncols(), |row, at| limit.input[(row, at)]);
        let first_row = self.scales.len();
        for sample in 0..signals.len() {
            let row = |side| [self.limits.len(), sample, side].map(|index| index as u16);
            self.places.extend((0..limit.directions.nrows()).map(row));
        }
        for direction in limit.directions.row_iter() {
            for signal in &signals {
                let along = direction * &signal.of_plan;
                let give = limit.relaxation * slack_unit;
                let length = libm::sqrt(along.norm_squared() + give * give);
                self.scales.push(if length > 0.0 { 1.0 / length } else { 0.0 });
            }
        }
        self.limits.push(PlacedLimit {
            directions: directions(&limit.directions),
            longest: limit.directions.row_iter().map(|row| row.norm()).fold(0.0, f64::max),
            relaxation: limit.relaxation,
            largest_scale: self.scales[first_row..].iter().copied().fold(0.0, f64::max),
            smallest_scale: self.scales[first_row..].iter().copied().fold(f64::INFINITY, f64::min),
            samples: signals.len(),
            components,
            first_bound,
            first_moved: self.count,
            first: [0; COMPONENTS],
            first_row,
            state,
            input,
        });
        self.count += components * signals.len();
        signals
    }

    /// Places a component of all limits that have it behind those before, `signals` being those of each limit.
    fn add_component(&mut self, component: usize, [states, outputs]: [usize; 2], signals: &[Vec<SignalAt>]) {
        let before: usize =
            self.limits.iter().map(|limit| limit.samples * limit.components.min(component)).sum();
        let mut rows = Vec::new();
        for (limit, signals) in self.limits.iter_mut().zip(signals) {
            if component < limit.components {
                limit.first[component] = before + rows.len();
                rows.extend(signals);
            }
        }
        let terms = rows.first().map_or(0, |signal| signal.of_plan.ncols());
        let count = rows.len();
        self.of_increment.add_block(before, count, states, |row, at| rows[row].of_state[(component, at)]);
        self.of_error
            .add_block(before, count, outputs, |row, at| rows[row].of_state[(component, states + at)]);
        self.plan_of_component[component] =
            self.of_plan.add_block(before, count, terms, |row, at| rows[row].of_plan[(component, at)]);
    }
}

impl<T: Precision> LimitedSignals<T> {
    /// The same signals in another precision.
    pub(crate) fn to_precision<U: Precision>(&self) -> LimitedSignals<U> {
        LimitedSignals {
            limits: self.limits.iter().map(PlacedLimit::to_precision).collect(),
            count: self.count,
            of_increment: self.of_increment.to_precision(),
            of_error: self.of_error.to_precision(),
            of_plan: self.of_plan.to_precision(),
            plan_of_component: self.plan_of_component.clone(),
            by_sample: self.by_sample.clone(),
            places: self.places.clone(),
            scales: self.scales.iter().map(|scale| U::of(scale.to_f64())).collect(),
        }
    }

    pub(crate) fn limits(&self) -> &[PlacedLimit<T>] {
        &self.limits
    }

    /// How many constraints there are.
    pub(crate) fn rows(&self) -> usize {
        self.places.len()
    }

    /// One over the length of each normal in z and the slack, for [`PlacedLimit::scales`].
    pub(crate) fn scales(&self) -> &[T] {
        &self.scales
    }

    /// Where a constraint is.
    pub(crate) fn place(&self, row: usize) -> Place<'_, T> {
        let [limit, sample, direction] = self.places[row].map(usize::from);
        let limit = &self.limits[limit];
        Place { limit, sample, direction, scale: limit.scales(direction, &self.scales)[sample] }
    }

    /// How many values there are.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Each signal of the plan without limits, `input` being u_r(k) + v(k−1). S must be their number or more.
    pub(crate) fn unlimited<const N: usize, const P: usize, const Q: usize, const S: usize>(
        &self,
        sample: &Sample<'_, N, P, Q, T>,
        input: &SVector<T, P>,
    ) -> [T; S] {
        let mut known = [T::zero(); S];
        for limit in &self.limits {
            let held = limit.signal(sample.measured.as_slice(), input.as_slice());
            let moved = sample.moved.get(limit.first_moved..).unwrap_or_default();
            for component in 0..limit.components {
                let known = &mut known[limit.first[component]..][..limit.samples];
                known.fill(held[component]);
                let moved = moved.get(component * limit.samples..).unwrap_or_default();
                for (value, moved) in known.iter_mut().zip(moved) {
                    *value += *moved;
                }
            }
        }
        self.of_increment.add_product(sample.increment.as_slice(), &mut known);
        self.of_error.add_product(sample.error.as_slice(), &mut known);
        known
    }

    /// Sets the signals to those at z.
    pub(crate) fn set_at(&self, unlimited: &[T], z: &[T], signals: &mut [T]) {
        signals[..self.count].copy_from_slice(&unlimited[..self.count]);
        self.of_plan.add_product(z, signals);
    }

    /// What z adds to the left side of a constraint: a vector of the elements of z.
    pub(crate) fn normal<const E: usize>(&self, place: &Place<'_, T>) -> SVector<T, E> {
        let mut normal = SVector::zeros();
        let limit = place.limit;
        let direction = &limit.directions[place.direction];
        for (component, share) in direction.iter().enumerate().take(limit.components) {
            let row = limit.first[component] + place.sample;
            let columns = self.plan_of_component[component].clone();
            self.of_plan.for_each_in_row(columns, row, |at, factor| normal[at] += *share * factor);
        }
        normal
    }

    /// By how much a reference moves the signals: `ahead` tells x_r(k+m) − x_r(k) and u_r(k+m) − u_r(k).
    pub(crate) fn moved<const N: usize, const P: usize>(
        &self,
        ahead: impl Fn(usize) -> (SVector<T, N>, SVector<T, P>),
    ) -> MovedSignals<T> {
        let mut moved = MovedSignals { values: [T::zero(); SIGNALS], count: self.count };
        let mut latest = (usize::MAX, (SVector::zeros(), SVector::zeros()));
        for &(m, limit, sample) in &self.by_sample {
            if m != latest.0 {
                latest = (m, ahead(m));
            }
            let (state, input) = &latest.1;
            let limit = &self.limits[limit];
            let signal = limit.signal(state.as_slice(), input.as_slice());
            for (component, value) in signal.iter().enumerate().take(limit.components) {
                moved.values[limit.first_moved + component * limit.samples + sample] = *value;
            }
        }
        moved
    }
}

/// How far the motion of a reference moves the limited signals of a controller: see
/// [`StabilizedMpc::moved`](crate::StabilizedMpc::moved).
#[derive(Clone, Debug, PartialEq)]
pub struct MovedSignals<T = f64> {
    values: [T; SIGNALS],
    count: usize,
}

impl<T> MovedSignals<T> {
    /// In the order of [`Sample::moved`].
    pub fn values(&self) -> &[T] {
        &self.values[..self.count]
    }
}

pub(crate) fn along<T: Precision>(direction: &[T; COMPONENTS], signal: &[T; COMPONENTS]) -> T {
    direction[0] * signal[0] + direction[1] * signal[1] + direction[2] * signal[2]
}

/// The rows of a matrix.
fn directions(matrix: &DMatrix<f64>) -> Vec<[f64; COMPONENTS]> {
    let row = |row: usize| {
        core::array::from_fn(|column| if column < matrix.ncols() { matrix[(row, column)] } else { 0.0 })
    };
    (0..matrix.nrows()).map(row).collect()
}
