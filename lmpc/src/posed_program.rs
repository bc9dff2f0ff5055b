//! The program of a stabilized Laguerre MPC written out as matrices, for another solver.

use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector, SVector};

use crate::{DesignError, Sample, SignalLimit, StabilizedDesign, validate};

/// The program that a [`StabilizedMpc`](crate::StabilizedMpc) of the same arguments solves at a sample, as matrices:
///
/// ```text
/// min ½ |z − z₀|²   under   G z ≤ b,        z = [Lᵀη; σ √c],   S_ηη = L Lᵀ
/// ```
///
/// Rows of G have length 1 and stand in the order limit, sample, direction; G is the same at every sample, z₀ and b are not. It
/// serves to compare and to check solvers. It allocates, and walks the prediction as the controller does: a check of the solver, not of
/// the prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct PosedProgram {
    /// L⁻¹.
    inverse: DMatrix<f64>,
    /// S_ηx.
    coupling: DMatrix<f64>,
    /// L(0)ᵀ, and K_s.
    first_move: DMatrix<f64>,
    stabilizing_gain: DMatrix<f64>,
    left: DMatrix<f64>,
    rows: Vec<PosedRow>,
}

/// Where the bound of a row comes from.
#[derive(Clone, Debug, PartialEq)]
struct PosedRow {
    /// What the signal along the direction is of x_m(k), of u_r(k) + v(k−1) and of \[Δx_m; y − r\].
    of_measured: DVector<f64>,
    of_input: DVector<f64>,
    of_state: DVector<f64>,
    /// Index into [`Sample::upper`].
    bound: usize,
    /// Index into [`Sample::moved`] of each component with its factor.
    moved: Vec<(usize, f64)>,
    /// One over the length of the row.
    scale: f64,
}

/// χ(m) = Fᵐ \[x; η\] of the plan: Δu(k+i) summed to m, and Δx_m(k+i) before m.
struct PlanSums {
    moves: DMatrix<f64>,
    states: DMatrix<f64>,
}

impl PosedProgram {
    /// The program of a design under limits, of which a slack of 1 costs `slack_cost`.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when a limit does not fit the design, [`DesignError::NotPositiveDefinite`] (S_ηη),
    /// [`DesignError::SlackCost`].
    pub fn new(
        design: &StabilizedDesign,
        limits: &[SignalLimit],
        slack_cost: f64,
    ) -> Result<Self, DesignError> {
        validate::slack_cost(slack_cost)?;
        let plan = design.plan();
        let (states, terms) = (design.model().states(), plan.terms);
        let (hessian, coupling) = design.coefficient_cost();
        let inverse = validate::inverse_factor("S_ηη", &hessian)?;
        let mut program = Self {
            coupling,
            first_move: plan.move_of.columns(states, terms).into_owned(),
            stabilizing_gain: design.stabilizing_gain().clone(),
            left: DMatrix::zeros(0, terms + 1),
            rows: Vec::new(),
            inverse,
        };
        let end = limits.iter().flat_map(|limit| &limit.samples).max().map_or(0, |last| last + 1);
        let sums = sums(design, end);
        let (mut bound, mut moved) = (0, 0);
        for limit in limits {
            let inputs = design.model().inputs();
            validate::shape(
                "C of a limit",
                &limit.state,
                (limit.state.nrows(), design.model().plant().states()),
            )?;
            validate::shape("D of a limit", &limit.input, (limit.state.nrows(), inputs))?;
            moved += program.add(limit, &sums, slack_cost, (bound, moved));
            bound += limit.directions.nrows();
        }
        Ok(program)
    }

    /// Adds a limit and returns how many values of [`Sample::moved`] it has.
    fn add(
        &mut self,
        limit: &SignalLimit,
        sums: &[PlanSums],
        slack_cost: f64,
        (first_bound, first_moved): (usize, usize),
    ) -> usize {
        let (terms, components) = (self.inverse.nrows(), limit.state.nrows());
        let known = self.coupling.ncols();
        let mut samples = limit.samples.clone();
        samples.sort_unstable();
        samples.dedup();
        let signals = samples.iter().map(|&m| &limit.state * &sums[m].states + &limit.input * &sums[m].moves);
        // What no plan moves is not limited.
        let signals: Vec<DMatrix<f64>> =
            signals.filter(|signal| signal.columns(known, terms).amax() > 0.0).collect();
        for (sample, signal) in signals.iter().enumerate() {
            for (at, direction) in limit.directions.row_iter().enumerate() {
                let of_plan = direction * signal.columns(known, terms) * self.inverse.transpose();
                let give = limit.relaxation / libm::sqrt(slack_cost);
                let length = libm::sqrt(of_plan.norm_squared() + give * give);
                let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
                let row = self.rows.len();
                self.left.resize_vertically_mut(row + 1, 0.0);
                self.left.view_mut((row, 0), (1, terms)).copy_from(&(of_plan * scale));
                self.left[(row, terms)] = -give * scale;
                self.rows.push(PosedRow {
                    of_measured: (direction * &limit.state).transpose(),
                    of_input: (direction * &limit.input).transpose(),
                    of_state: (direction * signal.columns(0, known)).transpose(),
                    bound: first_bound + at,
                    moved: (0..components)
                        .map(|component| {
                            (first_moved + component * signals.len() + sample, direction[component])
                        })
                        .collect(),
                    scale,
                });
            }
        }
        components * signals.len()
    }

    /// G, one row per constraint, one column per unknown, the slack last.
    pub fn left(&self) -> &DMatrix<f64> {
        &self.left
    }

    /// z₀ and b at a sample, `feedback` being v(k−1). A bound that is missing is infinite.
    pub fn at<const N: usize, const P: usize, const Q: usize>(
        &self,
        sample: &Sample<'_, N, P, Q>,
        feedback: &SVector<f64, P>,
    ) -> (DVector<f64>, DVector<f64>) {
        let x = augmented(sample);
        let start = -(&self.inverse * (&self.coupling * &x));
        let input = sample.input_reference + feedback;
        let upper = self.rows.iter().map(|row| {
            let moved = |(index, factor): &(usize, f64)| {
                factor * sample.moved.get(*index).copied().unwrap_or_default()
            };
            let known: f64 = dot(&row.of_measured, sample.measured.as_slice())
                + dot(&row.of_input, input.as_slice())
                + row.of_state.dot(&x)
                + row.moved.iter().map(moved).sum::<f64>();
            (sample.upper.get(row.bound).copied().unwrap_or(f64::INFINITY) - known) * row.scale
        });
        let upper = DVector::from_iterator(self.rows.len(), upper);
        (start.insert_row(self.inverse.nrows(), 0.0), upper)
    }

    /// Δu(k), the first move of a z.
    pub fn increment<const N: usize, const P: usize, const Q: usize>(
        &self,
        sample: &Sample<'_, N, P, Q>,
        z: &DVector<f64>,
    ) -> SVector<f64, P> {
        let eta = self.inverse.transpose() * z.rows(0, self.inverse.nrows());
        let increment = &self.first_move * eta - &self.stabilizing_gain * augmented(sample);
        SVector::from_fn(|input, _| increment[input])
    }
}

/// \[Δx_m; y − r\].
fn augmented<const N: usize, const P: usize, const Q: usize>(sample: &Sample<'_, N, P, Q>) -> DVector<f64> {
    DVector::from_iterator(N + Q, sample.increment.iter().chain(sample.error.iter()).copied())
}

fn dot(factors: &DVector<f64>, values: &[f64]) -> f64 {
    factors.iter().zip(values).map(|(factor, value)| factor * value).sum()
}

/// At m = 0, 1, … before `end`.
fn sums(design: &StabilizedDesign, end: usize) -> Vec<PlanSums> {
    let plan = design.plan();
    let plant_states = design.model().plant().states();
    let size = plan.transition.nrows();
    let mut at = DMatrix::identity(size, size);
    let mut moves = DMatrix::zeros(design.model().inputs(), size);
    let mut states = DMatrix::zeros(plant_states, size);
    let mut all = Vec::with_capacity(end);
    for _ in 0..end {
        moves += &plan.move_of * &at;
        all.push(PlanSums { moves: moves.clone(), states: states.clone() });
        at = &plan.transition * at;
        states += at.rows(0, plant_states);
    }
    all
}
