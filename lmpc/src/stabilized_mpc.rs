//! Stabilized Laguerre MPC under limits, at run time.

use nalgebra::{DMatrix, SMatrix, SVector};

use crate::controller_state::Decision;
use crate::dual_search::{Constraints, DualSearch};
use crate::limited_signals::{COMPONENTS, FEW_SIGNALS, LimitedSignals, MovedSignals, SIGNALS};
use crate::{
    Controller, ControllerState, DesignError, Outcome, Sample, SignalLimit, StabilizedDesign, StateFeedback,
    Status, Step, WarmStart,
};

/// How far beyond its bound a limit counts as met, relative to the size of the numbers in it.
const FEASIBILITY: f64 = 1e-9;
/// The slack from which limits count as relaxed: a thousandth of their relaxations.
const RELAXED: f64 = 1e-3;
/// Limits of which the least bound is known beforehand. Those beyond are looked at side by side.
const LEAST: usize = 8;
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
    signals: LimitedSignals,
    /// 1/√c: the slack per element of z that stands for it.
    slack_unit: f64,
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize> StabilizedMpc<N, P, Q, E> {
    /// The controller of a design under some limits. `slack_cost` c > 0 is what a slack of 1 costs, in units of V.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the sizes differ from the const generics, E is too small, a signal has more than three
    /// components or there are more than 640 components on all samples together; [`DesignError::NotFinite`],
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

        let slack_unit = 1.0 / libm::sqrt(slack_cost);
        Ok(Self {
            unconstrained: StateFeedback::new(design.gain())?,
            stabilizing: StateFeedback::new(design.stabilizing_gain())?,
            unknowns: terms + 1,
            start_state: SMatrix::from_fn(|i, j| if i < terms { start[(i, j)] } else { 0.0 }),
            start_output: SMatrix::from_fn(|i, j| if i < terms { start[(i, N + j)] } else { 0.0 }),
            first_move: SMatrix::from_fn(|i, j| if j < terms { first_move[(i, j)] } else { 0.0 }),
            signals: LimitedSignals::new::<N, P, Q>(design, limits, &inverse, slack_unit)?,
            slack_unit,
        })
    }

    /// The law without limits.
    pub fn unconstrained(&self) -> &StateFeedback<N, P, Q> {
        &self.unconstrained
    }

    /// By how much a reference moves the limited signals, for [`Sample::moved`]: `ahead` tells x_r(k+m) − x_r(k) and
    /// u_r(k+m) − u_r(k). It is called once for each limited sample m, in their order.
    pub fn moved(&self, ahead: impl Fn(usize) -> (SVector<f64, N>, SVector<f64, P>)) -> MovedSignals {
        self.signals.moved(ahead)
    }

    /// How many bounds hold, on all samples together.
    pub fn rows(&self) -> usize {
        self.signals.rows()
    }

    /// σ that an element of z stands for.
    fn slack_of(&self, z: &SVector<f64, E>) -> f64 {
        z[self.unknowns - 1] * self.slack_unit
    }

    /// What limits make of the unconstrained optimum z₀, with room for S signals; `None` when it keeps them.
    fn limited<const W: usize, const S: usize>(
        &self,
        state: &mut ControllerState<N, P, W>,
        sample: &Sample<'_, N, P, Q>,
        z_0: SVector<f64, E>,
    ) -> Option<Decision<P>> {
        let mut program = self.program::<S>(sample, &(sample.input_reference + state.feedback()));
        let warm_start = state.warm_start.strict();
        if warm_start.is_empty() && program.most_violated(&z_0, &[]).is_none() {
            return None;
        }
        let mut search = DualSearch::new(&mut program, z_0, warm_start);
        let outcome = search.run(ITERATIONS);
        if outcome == Outcome::Optimal {
            warm_start.remember(search.active.constraints());
            if warm_start.is_empty() {
                return None;
            }
        } else {
            *warm_start = WarmStart::default();
        }
        // Δu = −K_s x + L(0)ᵀη
        let stabilizing =
            self.stabilizing.state_gain() * sample.increment + self.stabilizing.output_gain() * sample.error;
        let increment = self.first_move * search.z - stabilizing;
        let status = match outcome {
            Outcome::Optimal if self.slack_of(&search.z) > RELAXED => Status::Relaxed,
            Outcome::Optimal => Status::Optimal,
            // The slack meets all limits; in floating point they may come out as if not.
            Outcome::Infeasible | Outcome::IterationLimit | Outcome::NotFinite => Status::IterationLimit,
        };
        let active = search.active.constraints().len();
        Some(Decision::program(state.feedback() + increment, status, search.iterations, active))
    }

    /// The program of one sample.
    fn program<'a, const S: usize>(
        &'a self,
        sample: &'a Sample<'_, N, P, Q>,
        input: &SVector<f64, P>,
    ) -> Program<'a, N, P, Q, E, S> {
        let limits = self.signals.limits();
        let least = |index: usize| {
            let Some(limit) = limits.get(index) else { return f64::NEG_INFINITY };
            let bounds = limit.first_bound..limit.first_bound + limit.directions.len();
            bounds.map(|bound| upper(sample.upper, bound)).fold(f64::INFINITY, f64::min)
        };
        Program {
            controller: self,
            upper: sample.upper,
            least: core::array::from_fn(least),
            known: self.signals.known(sample, input),
            signals: [0.0; S],
        }
    }
}

fn upper(values: &[f64], bound: usize) -> f64 {
    values.get(bound).copied().unwrap_or(f64::INFINITY)
}

/// The limits of one sample, as constraints of z, with room for S signals.
struct Program<'a, const N: usize, const P: usize, const Q: usize, const E: usize, const S: usize> {
    controller: &'a StabilizedMpc<N, P, Q, E>,
    upper: &'a [f64],
    /// The least bound of each of the first limits.
    least: [f64; LEAST],
    /// The part of each signal that is known before z is chosen.
    known: [f64; S],
    /// The signals at the z that was looked at last.
    signals: [f64; S],
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize, const S: usize> Constraints<E>
    for Program<'_, N, P, Q, E, S>
{
    fn unknowns(&self) -> usize {
        self.controller.unknowns
    }

    fn count(&self) -> usize {
        self.controller.signals.rows()
    }

    fn normal(&self, constraint: usize) -> SVector<f64, E> {
        let controller = self.controller;
        let place = controller.signals.place(constraint);
        let mut normal: SVector<f64, E> = controller.signals.normal(&place);
        normal[controller.unknowns - 1] = -place.limit.relaxation * controller.slack_unit;
        normal * controller.signals.scale(constraint)
    }

    fn bound(&self, constraint: usize) -> f64 {
        let signals = &self.controller.signals;
        let place = signals.place(constraint);
        let known =
            along(&place.limit.directions[place.direction], &place.limit.at(place.sample, &self.known));
        (upper(self.upper, place.limit.first_bound + place.direction) - known) * signals.scale(constraint)
    }

    fn most_violated(&mut self, z: &SVector<f64, E>, active: &[usize]) -> Option<usize> {
        let signals = &self.controller.signals;
        signals.set_at(&self.known, z.as_slice(), &mut self.signals);
        let slack = self.controller.slack_of(z);
        let (mut worst, mut least) = (None, 0.0);
        for (index, limit) in signals.limits().iter().enumerate() {
            let give = limit.relaxation * slack;
            let least_bound = self.least.get(index).map_or(f64::NEG_INFINITY, |bound| bound + give);
            // Up to this length no signal breaks the limit by more than rounding, and more than the worst so far:
            // |direction · signal| ≤ |direction| |signal|.
            let kept = |worst: f64| {
                let room = least_bound * (1.0 + FEASIBILITY) - worst / limit.largest_scale;
                if room > 0.0 { room * room } else { f64::NEG_INFINITY }
            };
            let mut squared_room = kept(least);
            let squared_longest = limit.longest * limit.longest;
            let bounds = self.upper.get(limit.first_bound..).unwrap_or_default();
            for sample in 0..limit.samples {
                let signal = limit.at(sample, &self.signals);
                // Most samples end here.
                if squared_longest * squared(&signal) <= squared_room {
                    continue;
                }
                // What is not bounded is not violated.
                for (side, (direction, bound)) in limit.directions.iter().zip(bounds).enumerate() {
                    let (value, upper) = (along(direction, &signal), bound + give);
                    if value <= upper {
                        continue;
                    }
                    let constraint = limit.row(sample, side);
                    let scale = signals.scale(constraint);
                    let room = (upper - value) * scale;
                    let size: f64 = signal.iter().map(|component| libm::fabs(*component)).sum();
                    let rounding = FEASIBILITY * (libm::fabs(upper) + size) * scale;
                    if room < least && room < -rounding && !active.contains(&constraint) {
                        (worst, least) = (Some(constraint), room);
                        squared_room = kept(least);
                    }
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
        let decision = if self.signals.count() <= FEW_SIGNALS {
            self.limited::<W, FEW_SIGNALS>(state, sample, z_0)
        } else {
            self.limited::<W, SIGNALS>(state, sample, z_0)
        };
        match decision {
            Some(decision) => state.take(sample, &decision),
            None => self.unconstrained.step(state, sample),
        }
    }
}

fn along(direction: &[f64; COMPONENTS], signal: &[f64; COMPONENTS]) -> f64 {
    direction[0] * signal[0] + direction[1] * signal[1] + direction[2] * signal[2]
}

fn squared(signal: &[f64; COMPONENTS]) -> f64 {
    along(signal, signal)
}
