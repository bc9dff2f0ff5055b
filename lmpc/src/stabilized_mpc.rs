//! Stabilized Laguerre MPC under limits, at run time.

use alloc::vec::Vec;

use nalgebra::{DMatrix, SMatrix, SVector};

use crate::active_set::ActiveSet;
use crate::controller_state::Decision;
use crate::dense::dot;
use crate::dual_search::{Constraints, DualSearch};
use crate::{
    Controller, ControllerState, DesignError, Outcome, Sample, SignalLimit, StabilizedDesign, StateFeedback,
    Status, Step, WarmStart, validate,
};

/// Most components of a limited signal.
const COMPONENTS: usize = 3;
/// Most values of signals on all samples together: what a step keeps on the stack.
const SIGNALS: usize = 512;
/// How far beyond its bound a limit counts as met, relative to the size of the numbers in it.
const FEASIBILITY: f64 = 1e-9;
/// The slack from which limits count as relaxed: a thousandth of their relaxations.
const RELAXED: f64 = 1e-3;
/// Iterations after which a program is given up; those at hand take fewer than twenty.
const ITERATIONS: u32 = 100;

/// Constrained Laguerre MPC on a [`StabilizedDesign`], for a plant of N states, P inputs and Q outputs, with E ≥ ΣN + 1
/// unknowns: the Laguerre coefficients and one slack.
///
/// The first move of min V(x, η) + c σ² under D · signal ≤ upper + relaxation · σ. All limits share the slack σ and give way in
/// proportion to their relaxations, so that every program has a solution. When the unconstrained optimum keeps the limits, the
/// step is one matrix–vector product; else an exact dual active-set method runs, warm-started from the last active set.
///
/// ```text
/// u(k+m)   = u_r(k) + v(k−1) + Σ_{i ≤ m} Δu(k+i)
/// x_m(k+m) = x_m(k) + Σ_{1 ≤ i ≤ m} Δx_m(k+i)
/// ```
///
/// What the reference itself will move by is not in these sums: [`Sample::moved`] tells it where it is known.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilizedMpc<const N: usize, const P: usize, const Q: usize, const E: usize> {
    unconstrained: StateFeedback<N, P, Q>,
    /// K_s.
    stabilizing: StateFeedback<N, P, Q>,
    unknowns: usize,
    /// z₀ = −L⁻¹ S_ηx x with S_ηη = L Lᵀ, z = Lᵀη.
    start_state: SMatrix<f64, E, N>,
    start_output: SMatrix<f64, E, Q>,
    /// L(0)ᵀ L⁻ᵀ: what z adds to the first move.
    first_move: SMatrix<f64, P, E>,
    limits: Vec<Directions>,
    blocks: Vec<Block<N, P, Q, E>>,
    /// The block of each row.
    block_of_row: Vec<u32>,
    /// One over the length of each row in z.
    scales: Vec<f64>,
    /// 1/√c: the slack per element of z that stands for it.
    slack_unit: f64,
}

/// How far the motion of a reference moves the limited signals of a controller: see [`StabilizedMpc::moved`].
#[derive(Clone, Debug, PartialEq)]
pub struct MovedSignals {
    values: [f64; SIGNALS],
    count: usize,
}

impl MovedSignals {
    /// In the order of [`Sample::moved`].
    pub fn values(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// The bounds of one limit.
#[derive(Clone, Debug, PartialEq)]
struct Directions {
    directions: Vec<[f64; COMPONENTS]>,
    /// Index of its first bound among [`Sample::upper`].
    first_bound: usize,
    relaxation: f64,
}

/// The components of one signal at one future sample.
#[derive(Clone, Debug, PartialEq)]
struct Block<const N: usize, const P: usize, const Q: usize, const E: usize> {
    limit: usize,
    /// m.
    sample: usize,
    first_row: usize,
    /// Where its components are among all signals.
    first_signal: usize,
    components: usize,
    /// In z, in Δx_m(k), in y − r, in u_r(k) + v(k−1), and in x_m(k).
    decision: [SVector<f64, E>; COMPONENTS],
    increment: [SVector<f64, N>; COMPONENTS],
    error: [SVector<f64, Q>; COMPONENTS],
    input: [SVector<f64, P>; COMPONENTS],
    state: [SVector<f64, N>; COMPONENTS],
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize> StabilizedMpc<N, P, Q, E> {
    /// The controller of a design under some limits. `slack_cost` c > 0 is what a slack of 1 costs, in units of V.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the sizes differ from the const generics, E is too small, a signal has more than three
    /// components or there are more than 512 components on all samples together; [`DesignError::NotFinite`],
    /// [`DesignError::NotPositiveDefinite`] (the cost of the slack).
    pub fn new(
        design: &StabilizedDesign,
        limits: &[SignalLimit],
        slack_cost: f64,
    ) -> Result<Self, DesignError> {
        if !(slack_cost > 0.0 && slack_cost.is_finite()) {
            return Err(DesignError::NotPositiveDefinite { name: "the cost of the slack" });
        }
        let states = design.model().states();
        let terms = design.cost().nrows() - states;
        if terms + 1 > E {
            return Err(DesignError::Dimension {
                name: "S_ηη with slack",
                expected: (E, E),
                actual: (terms + 1, terms + 1),
            });
        }
        let hessian = design.cost().view((states, states), (terms, terms)).into_owned();
        let name = "S_ηη";
        let factor = hessian.cholesky().ok_or(DesignError::NotPositiveDefinite { name })?;
        // L⁻¹
        let inverse = factor
            .l()
            .solve_lower_triangular(&DMatrix::identity(terms, terms))
            .ok_or(DesignError::NotPositiveDefinite { name })?;
        let start = -(&inverse * design.cost().view((states, 0), (terms, states)));
        let plan = design.plan();
        let first_move = plan.move_of.columns(states, terms) * inverse.transpose();

        let mut controller = Self {
            unconstrained: StateFeedback::new(design.gain())?,
            stabilizing: StateFeedback::new(design.stabilizing_gain())?,
            unknowns: terms + 1,
            start_state: SMatrix::from_fn(|i, j| if i < terms { start[(i, j)] } else { 0.0 }),
            start_output: SMatrix::from_fn(|i, j| if i < terms { start[(i, N + j)] } else { 0.0 }),
            first_move: SMatrix::from_fn(|i, j| if j < terms { first_move[(i, j)] } else { 0.0 }),
            limits: Vec::new(),
            blocks: Vec::new(),
            block_of_row: Vec::new(),
            scales: Vec::new(),
            slack_unit: 1.0 / libm::sqrt(slack_cost),
        };
        controller.place(design, limits, &inverse)?;
        Ok(controller)
    }

    /// Places the limits on their samples.
    fn place(
        &mut self,
        design: &StabilizedDesign,
        limits: &[SignalLimit],
        inverse: &DMatrix<f64>,
    ) -> Result<(), DesignError> {
        let mut bounds = 0;
        for limit in limits {
            let components = limit.directions.ncols();
            validate::shape("C of a limit", &limit.state, (components, N))?;
            validate::shape("D of a limit", &limit.input, (components, P))?;
            validate::shape(
                "directions of a limit",
                &limit.directions,
                (limit.directions.nrows(), components.min(COMPONENTS)),
            )?;
            self.limits.push(Directions {
                directions: (0..limit.directions.nrows())
                    .map(|row| {
                        core::array::from_fn(|column| {
                            if column < components { limit.directions[(row, column)] } else { 0.0 }
                        })
                    })
                    .collect(),
                first_bound: bounds,
                relaxation: limit.relaxation,
            });
            bounds += limit.directions.nrows();
        }
        let plan = design.plan();
        let size = plan.transition.nrows();
        let end = limits.iter().flat_map(|limit| &limit.samples).max().map_or(0, |last| last + 1);
        // χ(m) = Fᵐ [x; η], and the sums over it.
        let mut power = DMatrix::identity(size, size);
        let mut moves = DMatrix::zeros(P, size);
        let mut motion = DMatrix::zeros(N, size);
        let mut signals = 0;
        for m in 0..end {
            moves += &plan.move_of * &power;
            for (index, limit) in limits.iter().enumerate() {
                if limit.samples.contains(&m) {
                    let signal = &limit.state * &motion + &limit.input * &moves;
                    signals += self.add_block((index, m), limit, &signal, inverse, signals);
                }
            }
            power = &plan.transition * power;
            motion += power.rows(0, N);
        }
        if signals > SIGNALS {
            return Err(DesignError::Dimension {
                name: "limited signals on all samples",
                expected: (SIGNALS, 1),
                actual: (signals, 1),
            });
        }
        Ok(())
    }

    /// Adds the rows of one limit at one sample; returns how many signals that are. A signal that no decision moves is left out.
    fn add_block(
        &mut self,
        (index, sample): (usize, usize),
        limit: &SignalLimit,
        signal: &DMatrix<f64>,
        inverse: &DMatrix<f64>,
        first_signal: usize,
    ) -> usize {
        let terms = inverse.nrows();
        let components = signal.nrows();
        let decided = signal.columns(N + Q, terms) * inverse.transpose();
        if decided.amax() == 0.0 {
            return 0;
        }
        let column = |row: usize, from: usize, matrix: &DMatrix<f64>, at: usize| {
            if row < components { matrix[(row, from + at)] } else { 0.0 }
        };
        let block = Block {
            limit: index,
            sample,
            first_row: self.scales.len(),
            first_signal,
            components,
            decision: core::array::from_fn(|row| {
                SVector::from_fn(|at, _| if at < terms { column(row, 0, &decided, at) } else { 0.0 })
            }),
            increment: core::array::from_fn(|row| SVector::from_fn(|at, _| column(row, 0, signal, at))),
            error: core::array::from_fn(|row| SVector::from_fn(|at, _| column(row, N, signal, at))),
            input: core::array::from_fn(|row| SVector::from_fn(|at, _| column(row, 0, &limit.input, at))),
            state: core::array::from_fn(|row| SVector::from_fn(|at, _| column(row, 0, &limit.state, at))),
        };
        for direction in &self.limits[index].directions {
            let along: SVector<f64, E> = combined(direction, &block.decision);
            let give = limit.relaxation * self.slack_unit;
            let length = libm::sqrt(along.norm_squared() + give * give);
            self.scales.push(if length > 0.0 { 1.0 / length } else { 0.0 });
            self.block_of_row.push(u32::try_from(self.blocks.len()).unwrap_or(u32::MAX));
        }
        self.blocks.push(block);
        components
    }

    /// The law without limits.
    pub fn unconstrained(&self) -> &StateFeedback<N, P, Q> {
        &self.unconstrained
    }

    /// By how much a reference moves the limited signals, for [`Sample::moved`]: `ahead` tells x_r(k+m) − x_r(k) and
    /// u_r(k+m) − u_r(k). It is called once for each limited sample m, in their order.
    pub fn moved(&self, ahead: impl Fn(usize) -> (SVector<f64, N>, SVector<f64, P>)) -> MovedSignals {
        let mut moved = MovedSignals { values: [0.0; SIGNALS], count: 0 };
        let mut latest = (usize::MAX, (SVector::zeros(), SVector::zeros()));
        for block in &self.blocks {
            if block.sample != latest.0 {
                latest = (block.sample, ahead(block.sample));
            }
            let (state, input) = &latest.1;
            for component in 0..block.components {
                moved.values[moved.count] = dot(block.state[component].as_slice(), state.as_slice())
                    + dot(block.input[component].as_slice(), input.as_slice());
                moved.count += 1;
            }
        }
        moved
    }

    /// How many bounds hold, on all samples together.
    pub fn rows(&self) -> usize {
        self.scales.len()
    }

    /// The program of one sample.
    fn program<'a>(
        &'a self,
        sample: &'a Sample<'_, N, P, Q>,
        input: &SVector<f64, P>,
    ) -> Program<'a, N, P, Q, E> {
        let mut known = [0.0; SIGNALS];
        for block in &self.blocks {
            for component in 0..block.components {
                let index = block.first_signal + component;
                known[index] = dot(block.increment[component].as_slice(), sample.increment.as_slice())
                    + dot(block.error[component].as_slice(), sample.error.as_slice())
                    + dot(block.input[component].as_slice(), input.as_slice())
                    + dot(block.state[component].as_slice(), sample.measured.as_slice())
                    + sample.moved.get(index).copied().unwrap_or(0.0);
            }
        }
        Program { controller: self, upper: sample.upper, known }
    }
}

/// The limits of one sample, as constraints of z.
struct Program<'a, const N: usize, const P: usize, const Q: usize, const E: usize> {
    controller: &'a StabilizedMpc<N, P, Q, E>,
    upper: &'a [f64],
    /// The part of each signal that is known before z is chosen.
    known: [f64; SIGNALS],
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize> Program<'_, N, P, Q, E> {
    /// The components of a signal at z.
    fn signal(&self, block: &Block<N, P, Q, E>, z: &SVector<f64, E>) -> [f64; COMPONENTS] {
        core::array::from_fn(|component| {
            if component < block.components {
                self.known[block.first_signal + component]
                    + dot(block.decision[component].as_slice(), z.as_slice())
            } else {
                0.0
            }
        })
    }

    fn upper(&self, bound: usize) -> f64 {
        self.upper.get(bound).copied().unwrap_or(f64::INFINITY)
    }

    fn slack_of(&self, z: &SVector<f64, E>) -> f64 {
        z[self.controller.unknowns - 1] * self.controller.slack_unit
    }
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize> Constraints<E>
    for Program<'_, N, P, Q, E>
{
    fn unknowns(&self) -> usize {
        self.controller.unknowns
    }

    fn count(&self) -> usize {
        self.controller.scales.len()
    }

    fn normal(&self, constraint: usize) -> SVector<f64, E> {
        let controller = self.controller;
        let block = &controller.blocks[controller.block_of_row[constraint] as usize];
        let limit = &controller.limits[block.limit];
        let mut normal = combined(&limit.directions[constraint - block.first_row], &block.decision);
        normal[controller.unknowns - 1] = -limit.relaxation * controller.slack_unit;
        normal * controller.scales[constraint]
    }

    fn slack(&self, constraint: usize, z: &SVector<f64, E>) -> f64 {
        let controller = self.controller;
        let block = &controller.blocks[controller.block_of_row[constraint] as usize];
        let limit = &controller.limits[block.limit];
        let row = constraint - block.first_row;
        let value = along(&limit.directions[row], &self.signal(block, z));
        let room = self.upper(limit.first_bound + row) + limit.relaxation * self.slack_of(z) - value;
        room * controller.scales[constraint]
    }

    fn most_violated(&self, z: &SVector<f64, E>, active: &ActiveSet<E>) -> Option<usize> {
        let controller = self.controller;
        let slack = self.slack_of(z);
        let (mut worst, mut least) = (None, 0.0);
        for block in &controller.blocks {
            let limit = &controller.limits[block.limit];
            let signal = self.signal(block, z);
            for (row, direction) in limit.directions.iter().enumerate() {
                let value = along(direction, &signal);
                let upper = self.upper(limit.first_bound + row) + limit.relaxation * slack;
                // Most rows end here.
                if value <= upper {
                    continue;
                }
                let constraint = block.first_row + row;
                let room = (upper - value) * controller.scales[constraint];
                let size = libm::fabs(signal[0]) + libm::fabs(signal[1]) + libm::fabs(signal[2]);
                let rounding = FEASIBILITY * (libm::fabs(upper) + size) * controller.scales[constraint];
                if room < least && room < -rounding && !active.contains(constraint) {
                    (worst, least) = (Some(constraint), room);
                }
            }
        }
        worst
    }
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize, const W: usize> Controller<N, P, Q, W>
    for StabilizedMpc<N, P, Q, E>
{
    fn step(&self, state: &mut ControllerState<N, P, W>, sample: &Sample<'_, N, P, Q>) -> Step<P> {
        // z₀ = −L⁻¹ S_ηx x
        let z_0 = self.start_state * sample.increment + self.start_output * sample.error;
        if !(z_0.norm_squared().is_finite() && sample.upper.iter().all(|upper| !upper.is_nan())) {
            return self.unconstrained.step(state, sample);
        }
        let program = self.program(sample, &(sample.input_reference + state.feedback()));
        if program.most_violated(&z_0, &ActiveSet::empty(self.unknowns)).is_none() {
            return self.unconstrained.step(state, sample);
        }
        let warm_start = state.warm_start.strict();
        let mut search = DualSearch::new(&program, z_0, warm_start);
        let outcome = search.run(ITERATIONS);
        if outcome == Outcome::Optimal {
            warm_start.remember(search.active.constraints());
        } else {
            *warm_start = WarmStart::default();
        }
        // Δu = −K_s x + L(0)ᵀη
        let stabilizing =
            self.stabilizing.state_gain() * sample.increment + self.stabilizing.output_gain() * sample.error;
        let increment = self.first_move * search.z - stabilizing;
        let status = match outcome {
            Outcome::Optimal if program.slack_of(&search.z) > RELAXED => Status::Relaxed,
            Outcome::Optimal => Status::Optimal,
            // The slack meets all limits; in floating point they may come out as if not.
            Outcome::Infeasible | Outcome::IterationLimit | Outcome::NotFinite => Status::IterationLimit,
        };
        let decision = Decision::program(
            state.feedback() + increment,
            status,
            search.iterations,
            search.active.constraints().len(),
        );
        state.take(sample, &decision)
    }
}

/// Σ direction_i rows_i.
fn combined<const E: usize>(
    direction: &[f64; COMPONENTS],
    rows: &[SVector<f64, E>; COMPONENTS],
) -> SVector<f64, E> {
    rows[0] * direction[0] + rows[1] * direction[1] + rows[2] * direction[2]
}

fn along(direction: &[f64; COMPONENTS], signal: &[f64; COMPONENTS]) -> f64 {
    direction[0] * signal[0] + direction[1] * signal[1] + direction[2] * signal[2]
}
