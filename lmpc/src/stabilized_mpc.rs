//! Stabilized Laguerre MPC under limits, at run time.

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::active_set::{ActiveSet, Start};
use crate::controller_state::Decision;
use crate::dense::{dot, least};
use crate::dual_search::{Constraints, DualSearch};
use crate::limited_signals::{FEW_SIGNALS, LimitedSignals, PlanCoordinates, SIGNALS};
use crate::placed_limit::along;
use crate::precision::converted;
use crate::worst_constraint::Worst;
use crate::{
    Controller, ControllerState, DesignError, Outcome, Precision, Sample, SignalLimit, StabilizedDesign,
    StateFeedback, Status, Step, WarmStart, validate,
};

/// The slack from which limits count as relaxed: a thousandth of their relaxations.
const RELAXED: f64 = 1e-3;
/// Limits of which the least bound is known beforehand. Those beyond are looked at direction by direction.
const LEAST: usize = 8;
/// Iterations after which a program is given up; those at hand take fewer than twenty.
const ITERATIONS: u32 = 100;

/// Constrained Laguerre MPC on a [`StabilizedDesign`], for a plant of N states, P inputs and Q outputs, with E ≥ ΣN + 1
/// unknowns: the Laguerre coefficients and one slack.
///
/// The first move of min V(x, η) + c σ² under D · signal ≤ upper + relaxation · σ. All limits share the slack σ and give way in
/// proportion to their relaxations, so that every program has a solution. When the plan without limits keeps them, the
/// step is that of the linear law; else an exact dual active-set method looks for what to add to this plan, warm-started from the last
/// active set. A [`ControllerState`] with K ≥ ΣN + 1 keeps the factors of that set, which saves half of such a step or more.
///
/// ```text
/// u(k+m)   = u_r(k) + v(k−1) + Σ_{i ≤ m} Δu(k+i)
/// x_m(k+m) = x_m(k) + Σ_{1 ≤ i ≤ m} Δx_m(k+i)
/// ```
///
/// What the reference itself will move by is not in these sums: [`Sample::moved`] tells it where it is known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub struct StabilizedMpc<const N: usize, const P: usize, const Q: usize, const E: usize, T = f64> {
    unconstrained: StateFeedback<N, P, Q, T>,
    unknowns: usize,
    /// L(0)ᵀ L⁻ᵀ: what z adds to the first move of the plan without limits.
    first_move: SMatrix<T, P, E>,
    signals: LimitedSignals<T>,
    /// 1/√c: the slack per element of z that stands for it.
    slack_unit: T,
    /// A hash of the normals of all constraints: factors that were kept are of these if theirs is the same.
    identity: u64,
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize> StabilizedMpc<N, P, Q, E> {
    /// The controller of a design under some limits. `slack_cost` c > 0 is what a slack of 1 costs, in units of V.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the sizes differ from the const generics, E is too small, a signal has more than three
    /// components or there are more than 640 components on all samples together; [`DesignError::ElementNotFinite`],
    /// [`DesignError::NotPositiveDefinite`] (S_ηη), [`DesignError::SlackCost`].
    pub fn new(
        design: &StabilizedDesign,
        limits: &[SignalLimit],
        slack_cost: f64,
    ) -> Result<Self, DesignError> {
        validate::slack_cost(slack_cost)?;
        let states = design.model().states();
        let terms = design.cost().nrows() - states;
        if terms + 1 > E {
            return Err(DesignError::Dimension {
                name: "S_ηη with slack",
                expected: (E, E),
                actual: (terms + 1, terms + 1),
            });
        }
        let coordinates = PlanCoordinates::of(design)?;
        let first_move = design.plan().move_of.columns(states, terms) * &coordinates.by_z;
        let slack_unit = 1.0 / libm::sqrt(slack_cost);
        let controller = Self {
            unconstrained: StateFeedback::new(design.gain())?,
            unknowns: terms + 1,
            first_move: SMatrix::from_fn(|i, j| if j < terms { first_move[(i, j)] } else { 0.0 }),
            signals: LimitedSignals::new(design, limits, &coordinates, slack_unit)?,
            slack_unit,
            identity: 0,
        };
        Ok(controller.identified())
    }
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize, T: Precision>
    StabilizedMpc<N, P, Q, E, T>
{
    /// The same controller in another precision.
    pub fn to_precision<U: Precision>(&self) -> StabilizedMpc<N, P, Q, E, U> {
        let controller = StabilizedMpc {
            unconstrained: self.unconstrained.to_precision(),
            unknowns: self.unknowns,
            first_move: converted(&self.first_move),
            signals: self.signals.to_precision(),
            slack_unit: U::of(self.slack_unit.to_f64()),
            identity: 0,
        };
        controller.identified()
    }

    /// With the hash of all normals (FNV-1a, number by number).
    fn identified(self) -> Self {
        let mut identity = 0xcbf2_9ce4_8422_2325_u64;
        for constraint in 0..self.signals.rows() {
            for element in &self.normal::<E>(constraint) {
                identity = (identity ^ element.to_f64().to_bits()).wrapping_mul(0x0100_0000_01b3);
            }
        }
        Self { identity, ..self }
    }

    /// The law without limits.
    pub fn unconstrained(&self) -> &StateFeedback<N, P, Q, T> {
        &self.unconstrained
    }

    /// By how much a reference moves the limited signals, for [`Sample::moved`]: `ahead` tells x_r(k+m) − x_r(k) and
    /// u_r(k+m) − u_r(k). It is called once for each limited sample m, in their order. The values go to the beginning of `room`; `None`
    /// when it has less than [`moved_signals`](Self::moved_signals).
    pub fn moved<'a>(
        &self,
        room: &'a mut [T],
        ahead: impl Fn(usize) -> (SVector<T, N>, SVector<T, P>),
    ) -> Option<&'a [T]> {
        self.signals.moved(room, ahead)
    }

    /// How many limited signals [`moved`](Self::moved) tells: components of limits on samples.
    pub fn moved_signals(&self) -> usize {
        self.signals.count()
    }

    /// How many bounds hold, on all samples together.
    pub fn rows(&self) -> usize {
        self.signals.rows()
    }

    /// σ that an element of z stands for.
    fn slack_of<const D: usize>(&self, z: &SVector<T, D>) -> T {
        z[self.unknowns - 1] * self.slack_unit
    }

    /// The unit normal of a constraint, with room for D ≥ n elements.
    fn normal<const D: usize>(&self, constraint: usize) -> SVector<T, D> {
        let place = self.signals.place(constraint);
        let mut normal: SVector<T, D> = self.signals.normal(&place);
        normal[self.unknowns - 1] = -place.limit.relaxation * self.slack_unit;
        normal * place.scale
    }

    /// What limits make of the plan without them; `None` when it keeps them.
    fn limited<const W: usize, const K: usize>(
        &self,
        state: &mut ControllerState<N, P, W, T, K>,
        sample: &Sample<'_, N, P, Q, T>,
    ) -> Option<Decision<P, T>> {
        let input = sample.input_reference + state.feedback();
        // Far from all limits, as most samples are, their signals need not be known one by one.
        if state.warm_start.strict().is_empty() && self.signals.are_surely_kept(sample, &input) {
            return None;
        }
        if self.signals.count() <= FEW_SIGNALS {
            self.planned(
                [&mut [T::zero(); FEW_SIGNALS], &mut [T::zero(); FEW_SIGNALS]],
                state,
                sample,
                &input,
            )
        } else {
            self.planned([&mut [T::zero(); SIGNALS], &mut [T::zero(); SIGNALS]], state, sample, &input)
        }
    }

    /// The same with the signals one by one, with room for those of the plan without limits and for those of a plan with them.
    // One copy for rooms of any size.
    #[inline(never)]
    fn planned<const W: usize, const K: usize>(
        &self,
        [unlimited, signals]: [&mut [T]; 2],
        state: &mut ControllerState<N, P, W, T, K>,
        sample: &Sample<'_, N, P, Q, T>,
        input: &SVector<T, P>,
    ) -> Option<Decision<P, T>> {
        let warm_start = state.warm_start.strict();
        self.signals.write_unlimited(sample, input, unlimited);
        let mut program = self.program(sample, unlimited, signals);
        if !program.is_finite() {
            return None;
        }
        if warm_start.is_empty() && program.worst(program.unlimited, T::zero(), &[]).is_none() {
            return None;
        }
        // E ≥ unknowns: where there is surely room, the other search is not compiled.
        let found = if E <= K || self.unknowns <= K {
            program.search(&mut state.kept.0, warm_start)
        } else {
            program.search(&mut ActiveSet::<E, T>::empty(), warm_start)
        }?;
        // Δu = −K [Δx; y − r] + L(0)ᵀ L⁻ᵀ z
        let increment = found.first_move
            - self.unconstrained.state_gain() * sample.increment
            - self.unconstrained.output_gain() * sample.error;
        Some(Decision::program(state.feedback() + increment, found.status, found.iterations, found.active))
    }

    /// The program of one sample.
    fn program<'a>(
        &'a self,
        sample: &'a Sample<'_, N, P, Q, T>,
        unlimited: &'a [T],
        signals: &'a mut [T],
    ) -> Program<'a, N, P, Q, E, T> {
        let limits = self.signals.limits();
        let least_of = |index: usize| match limits.get(index) {
            // Those of one component are looked at without it.
            Some(limit) if limit.components > 1 => least(limit.bounds(sample.upper)),
            _ => -T::INFINITY,
        };
        Program {
            controller: self,
            upper: sample.upper,
            least: core::array::from_fn(least_of),
            unlimited,
            signals,
        }
    }
}

/// What a search has found to add to the plan without limits.
struct Found<const P: usize, T> {
    first_move: SVector<T, P>,
    status: Status,
    iterations: u32,
    active: usize,
}

/// The limits of one sample, as constraints of z.
struct Program<'a, const N: usize, const P: usize, const Q: usize, const E: usize, T> {
    controller: &'a StabilizedMpc<N, P, Q, E, T>,
    upper: &'a [T],
    /// The least bound of each of the first limits.
    least: [T; LEAST],
    /// The signals of the plan without limits, z = 0.
    unlimited: &'a [T],
    /// The signals at the z that was looked at last.
    signals: &'a mut [T],
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize, T: Precision>
    Program<'_, N, P, Q, E, T>
{
    /// Whether its numbers can be calculated with.
    fn is_finite(&self) -> bool {
        let signals = &self.unlimited[..self.controller.signals.count()];
        dot(signals, signals).is_finite() && self.upper.iter().all(|upper| !upper.is_nan())
    }

    /// Looks for the plan that keeps the limits, beginning with those in `warm_start`; `None` if it is the one without limits.
    fn search<const W: usize, const D: usize>(
        &mut self,
        active: &mut ActiveSet<D, T>,
        warm_start: &mut WarmStart<W>,
    ) -> Option<Found<P, T>> {
        let controller = self.controller;
        let mut search = DualSearch::new(self, Start::Origin, active, warm_start);
        let outcome = search.run(ITERATIONS);
        if outcome == Outcome::Optimal {
            warm_start.remember(search.active.constraints());
            if warm_start.is_empty() {
                return None;
            }
        } else {
            *warm_start = WarmStart::default();
        }
        let mut first_move = SVector::<T, P>::zeros();
        for (of_element, element) in controller.first_move.column_iter().zip(&search.z) {
            first_move += of_element * *element;
        }
        let status = match outcome {
            Outcome::Optimal if controller.slack_of(&search.z) > T::of(RELAXED) => Status::Relaxed,
            Outcome::Optimal => Status::Optimal,
            // The slack meets all limits; in floating point they may come out as if not.
            Outcome::Infeasible | Outcome::IterationLimit | Outcome::NotFinite => Status::IterationLimit,
        };
        let active = search.active.constraints().len();
        Some(Found { first_move, status, iterations: search.iterations, active })
    }

    /// The constraint that some signals violate most under a slack σ, by more than rounding, among those that are not active.
    fn worst(&self, signals: &[T], slack: T, active: &[usize]) -> Option<usize> {
        let placed = &self.controller.signals;
        let mut worst = Worst { scales: placed.scales(), active, constraint: None, room: T::zero() };
        for (index, limit) in placed.limits().iter().enumerate() {
            let least_bound = self.least.get(index).copied().unwrap_or(-T::INFINITY);
            worst.look_at(limit, signals, (limit.bounds(self.upper), least_bound), limit.relaxation * slack);
        }
        worst.constraint
    }
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize, const D: usize, T: Precision>
    Constraints<D, T> for Program<'_, N, P, Q, E, T>
{
    fn unknowns(&self) -> usize {
        self.controller.unknowns
    }

    fn identity(&self) -> u64 {
        self.controller.identity
    }

    fn count(&self) -> usize {
        self.controller.signals.rows()
    }

    fn normal(&self, constraint: usize) -> SVector<T, D> {
        self.controller.normal(constraint)
    }

    fn bound(&self, constraint: usize) -> T {
        let signals = &self.controller.signals;
        let place = signals.place(constraint);
        let unlimited =
            along(&place.limit.directions[place.direction], &place.limit.at(place.sample, self.unlimited));
        let upper = place.limit.bounds(self.upper).get(place.direction).copied().unwrap_or(T::INFINITY);
        (upper - unlimited) * place.scale
    }

    fn most_violated(&mut self, z: &SVector<T, D>, active: &[usize]) -> Option<usize> {
        let controller = self.controller;
        controller.signals.set_at(self.unlimited, z.as_slice(), self.signals);
        self.worst(self.signals, controller.slack_of(z), active)
    }
}

impl<
    const N: usize,
    const P: usize,
    const Q: usize,
    const E: usize,
    const W: usize,
    T: Precision,
    const K: usize,
> Controller<N, P, Q, W, T, K> for StabilizedMpc<N, P, Q, E, T>
{
    fn step(
        &self,
        state: &mut ControllerState<N, P, W, T, K>,
        sample: &Sample<'_, N, P, Q, T>,
    ) -> Step<P, T> {
        match self.limited(state, sample) {
            Some(decision) => state.take(sample, &decision),
            None => self.unconstrained.step(state, sample),
        }
    }
}
