//! The signals that a stabilized Laguerre MPC keeps within limits, on all samples on which it does.

use alloc::vec::Vec;
use core::ops::Range;

use nalgebra::{DMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::placed_limit::{COMPONENTS, PlacedLimit};
use crate::product::product;
use crate::sparse_columns::SparseColumns;
use crate::sparse_rows::SparseRows;
use crate::{DesignError, Precision, Sample, SignalLimit, StabilizedDesign, validate};

/// Most directions of a limit.
const DIRECTIONS: usize = u16::MAX as usize;
/// Most values of signals on all samples together: what a step keeps on the stack.
pub(crate) const SIGNALS: usize = 640;
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

/// How z stands for a plan: η = η₀ + L⁻ᵀ z with S_ηη = L Lᵀ, in which η₀ = −S_ηη⁻¹ S_ηx x is the plan without limits.
pub(crate) struct PlanCoordinates {
    /// −S_ηη⁻¹ S_ηx.
    pub(crate) unlimited: DMatrix<f64>,
    /// L⁻ᵀ.
    pub(crate) by_z: DMatrix<f64>,
}

impl PlanCoordinates {
    /// Those of a design.
    ///
    /// # Errors
    /// [`DesignError::NotPositiveDefinite`]: S_ηη.
    pub(crate) fn of(design: &StabilizedDesign) -> Result<Self, DesignError> {
        let (hessian, coupling) = design.coefficient_cost();
        let inverse = validate::inverse_factor("S_ηη", &hessian)?;
        // S_ηη⁻¹ = L⁻ᵀ L⁻¹
        let by_z = inverse.transpose();
        let unlimited = -(&by_z * (&inverse * coupling));
        Ok(Self { unlimited, by_z })
    }
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
        let elements = |matrix: &DMatrix<f64>| {
            SparseRows::new(components, matrix.ncols(), |row, column| matrix[(row, column)])
        };
        let (state, input) = (elements(&limit.state), elements(&limit.input));
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
        let most_by = |columns: Range<usize>| {
            SparseRows::new(components, columns.len(), |component, column| {
                largest(&signals, (component, columns.start + column))
            })
        };
        let states = limit.state.ncols();
        let (most_by_increment, most_by_error) = (most_by(0..states), most_by(states..augmented));
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
            most_by_increment,
            most_by_error,
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

    /// Whether it is plain that the plan without limits keeps them, `input` being u_r(k) + v(k−1). If it is not, its signals tell.
    pub(crate) fn are_surely_kept<const N: usize, const P: usize, const Q: usize>(
        &self,
        sample: &Sample<'_, N, P, Q, T>,
        input: &SVector<T, P>,
    ) -> bool {
        self.limits.iter().all(|limit| limit.is_surely_kept(sample, input))
    }

    /// Writes each signal of the plan without limits, `input` being u_r(k) + v(k−1), to where there is room for all of them.
    pub(crate) fn write_unlimited<const N: usize, const P: usize, const Q: usize>(
        &self,
        sample: &Sample<'_, N, P, Q, T>,
        input: &SVector<T, P>,
        known: &mut [T],
    ) {
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
        self.of_increment.add_product(sample.increment.as_slice(), known);
        self.of_error.add_product(sample.error.as_slice(), known);
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

    /// By how much a reference moves the signals: `ahead` tells x_r(k+m) − x_r(k) and u_r(k+m) − u_r(k). `None` when there is no room
    /// for all of them.
    pub(crate) fn moved<'a, const N: usize, const P: usize>(
        &self,
        room: &'a mut [T],
        ahead: impl Fn(usize) -> (SVector<T, N>, SVector<T, P>),
    ) -> Option<&'a [T]> {
        let moved = room.get_mut(..self.count)?;
        let mut latest = (usize::MAX, (SVector::zeros(), SVector::zeros()));
        for &(m, limit, sample) in &self.by_sample {
            if m != latest.0 {
                latest = (m, ahead(m));
            }
            let (state, input) = &latest.1;
            let limit = &self.limits[limit];
            let signal = limit.signal(state.as_slice(), input.as_slice());
            for (component, value) in signal.iter().enumerate().take(limit.components) {
                moved[limit.first_moved + component * limit.samples + sample] = *value;
            }
        }
        Some(moved)
    }
}

/// The largest magnitude of an element on any sample.
fn largest(signals: &[SignalAt], at: (usize, usize)) -> f64 {
    signals.iter().map(|signal| signal.of_state[at].abs()).fold(0.0, f64::max)
}

/// The rows of a matrix.
fn directions(matrix: &DMatrix<f64>) -> Vec<[f64; COMPONENTS]> {
    let row = |row: usize| {
        core::array::from_fn(|column| if column < matrix.ncols() { matrix[(row, column)] } else { 0.0 })
    };
    (0..matrix.nrows()).map(row).collect()
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use nalgebra::{DMatrix, SVector, Vector1, dmatrix};
    use proptest::prelude::*;

    use super::{LimitedSignals, PlanCoordinates};
    use crate::placed_limit::along;
    use crate::{
        Augmented, Discretization, Dlqr, LaguerreBasis, Sample, SignalLimit, StabilizedDesign, StateSpace,
        Weights,
    };

    /// |u| and |v| of a double integrator on some samples, with coordinates in which the plan without limits is no moves at all.
    fn signals() -> LimitedSignals<f64> {
        let (a, b, c) = (dmatrix![0.0, 1.0; 0.0, 0.0], dmatrix![0.0; 1.0], dmatrix![1.0, 0.0]);
        let plant = StateSpace::from_continuous(&a, &b, &c, 0.1, Discretization::ZeroOrderHold).unwrap();
        let model = Augmented::new(&plant);
        let weights = Weights::output(&model, 1.0, 0.1).unwrap();
        let slow = Dlqr::new(model.a(), model.b(), weights.q(), &(weights.r() * 100.0), 1.0).unwrap();
        let basis = vec![LaguerreBasis::new(2, 0.5).unwrap()];
        let design = StabilizedDesign::new(&model, &weights, slow.gain(), &basis, 1.0).unwrap();
        let limits = [
            SignalLimit::of_inputs(2, 1, SignalLimit::range(1), vec![0, 2, 5]),
            SignalLimit::of_states(2, 1, &[1], SignalLimit::range(1), vec![1, 4, 9]),
        ];
        let coordinates =
            PlanCoordinates { unlimited: DMatrix::zeros(2, model.states()), by_z: DMatrix::identity(2, 2) };
        LimitedSignals::new(&design, &limits, &coordinates, 1.0).unwrap()
    }

    proptest! {
        /// Limits that are said to be kept leave room on each sample, and far from all limits it is said.
        #[test]
        fn what_is_surely_kept_is_kept(
            numbers in prop::array::uniform6(-1.0..1.0_f64), moved in prop::array::uniform6(-0.3..0.3_f64),
            upper in prop::array::uniform4(0.1..4.0_f64), far in any::<bool>(),
        ) {
            let signals = signals();
            let [x, v, dx, dv, error, input] = numbers;
            let upper = if far { [1e3; 4] } else { upper };
            let sample = Sample::<2, 1, 1> {
                measured: [x, v].into(),
                increment: [dx, dv].into(),
                error: Vector1::new(error),
                upper: &upper,
                moved: &moved,
                ..Sample::default()
            };
            let input = Vector1::new(input);
            let surely = signals.are_surely_kept(&sample, &input);
            prop_assert!(surely || !far);
            let mut values = [0.0; 6];
            signals.write_unlimited(&sample, &input, &mut values);
            let kept = signals.limits().iter().all(|limit| {
                (0..limit.samples).all(|at| {
                    let sides = limit.directions.iter().zip(limit.bounds(&upper));
                    sides.into_iter().all(|(side, bound)| along(side, &limit.at(at, &values)) <= bound + 1e-12)
                })
            });
            prop_assert!(kept || !surely, "{values:?} within {upper:?}");
        }
    }

    #[test]
    fn what_is_no_number_is_not_surely_kept() {
        let (signals, upper) = (signals(), [1.0; 4]);
        let increment = SVector::from([f64::NAN, 0.0]);
        let sample = Sample::<2, 1, 1> { increment, upper: &upper, ..Sample::default() };
        assert!(!signals.are_surely_kept(&sample, &Vector1::zeros()));
        let still = Sample::<2, 1, 1> { upper: &upper, ..Sample::default() };
        assert!(signals.are_surely_kept(&still, &Vector1::zeros()));
    }
}
