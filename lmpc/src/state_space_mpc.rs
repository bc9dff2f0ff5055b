//! Linear state-space MPC (28)–(34), which the paper compares LMPC with: one unknown per move and input.

use alloc::vec::Vec;

use nalgebra::{DMatrix, SMatrix, SVector};

use crate::limit_row::{PredictionWalk, limit_rows};
use crate::moves_walk::MovesWalk;
use crate::relaxable::RelaxableProgram;
use crate::validate::symmetrized;
use crate::{
    ConstrainedState, ConstrainedStep, DesignError, Limit, Quantity, StateSpace, spectral_radius, validate,
};

/// Design of a state-space MPC.
///
/// The outputs over the horizon are Y = F x̂ + Φ U (32)–(33), without direct feed-through (D = 0). The
/// unknowns are the first N_c moves Δu; the input stays where it is after them. U = 1 u₋₁ + T ΔU makes the
/// cost (34) the quadratic form
///
/// ```text
/// J = ½ ‖Y − R‖²_Q + ½ ‖ΔU‖²_S = ½ ΔUᵀ H ΔU + ΔUᵀ (Φ T)ᵀ Q (F x̂ + Φ 1 u₋₁ − R) + const
/// H = (Φ T)ᵀ Q (Φ T) + S
/// ```
///
/// The paper's cost ends with the horizon; [`StateSpaceMpcWeights`] can add what the state at its end costs.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpaceMpcDesign {
    plant: StateSpace,
    moves: usize,
    hessian: DMatrix<f64>,
    /// (Φ T)ᵀ Q F, (Φ T)ᵀ Q Φ 1 and (Φ T)ᵀ Q, the gradient's parts in x̂, u₋₁ and −R.
    gradient_state: DMatrix<f64>,
    gradient_input: DMatrix<f64>,
    gradient_reference: DMatrix<f64>,
    spectral_radius: f64,
}

/// Weights of a state-space MPC.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpaceMpcWeights {
    /// Q of (34) on y − r, q×q.
    pub output: DMatrix<f64>,
    /// S of (34) on the moves, p×p.
    pub moves: DMatrix<f64>,
    /// W on the increments of the state, n×n: ½ ‖Δx(k+i)‖²_W is added for i = 1 … N.
    pub increment: DMatrix<f64>,
    /// P on \[Δx; y − r\] at sample k + N, (n+q)×(n+q), instead of W; the
    /// [cost of the regulator](crate::Dlqr::cost) makes the finite horizon cost what the infinite one costs.
    pub terminal: Option<DMatrix<f64>>,
}

impl StateSpaceMpcWeights {
    fn check(&self, plant: &StateSpace) -> Result<(), DesignError> {
        let (n, p, q) = (plant.states(), plant.inputs(), plant.outputs());
        validate::shape("Q", &self.output, (q, q))?;
        validate::shape("S", &self.moves, (p, p))?;
        validate::shape("W", &self.increment, (n, n))?;
        validate::positive_semidefinite("Q", &self.output)?;
        validate::positive_semidefinite("W", &self.increment)?;
        validate::positive_definite("S", &self.moves)?;
        if let Some(terminal) = &self.terminal {
            validate::shape("P", terminal, (n + q, n + q))?;
            validate::positive_semidefinite("P", terminal)?;
        }
        Ok(())
    }
}

impl StateSpaceMpcDesign {
    /// For a plant, the weights Q on the outputs (q×q) and S on the moves (p×p) as in (34), a prediction horizon
    /// of N = `horizon` samples and a control horizon of N_c = `moves`.
    ///
    /// # Errors
    /// As [`StateSpaceMpcDesign::with_weights`].
    pub fn new(
        plant: &StateSpace,
        output_weight: &DMatrix<f64>,
        move_weight: &DMatrix<f64>,
        horizon: usize,
        moves: usize,
    ) -> Result<Self, DesignError> {
        let weights = StateSpaceMpcWeights {
            output: output_weight.clone(),
            moves: move_weight.clone(),
            increment: DMatrix::zeros(plant.states(), plant.states()),
            terminal: None,
        };
        Self::with_weights(plant, &weights, horizon, moves)
    }

    /// As [`StateSpaceMpcDesign::new`] with the weights that a Laguerre MPC can have.
    ///
    /// # Errors
    /// [`DesignError::Dimension`], [`DesignError::NotFinite`], [`DesignError::NotPositiveSemidefinite`]
    /// (Q, W, P), [`DesignError::NotPositiveDefinite`] (S), [`DesignError::MovesBeyondHorizon`] unless
    /// 1 ≤ N_c ≤ N − 1, [`DesignError::Unstable`] when the unconstrained closed loop is not stable.
    pub fn with_weights(
        plant: &StateSpace,
        weights: &StateSpaceMpcWeights,
        horizon: usize,
        moves: usize,
    ) -> Result<Self, DesignError> {
        weights.check(plant)?;
        let (p, q) = (plant.inputs(), plant.outputs());
        if moves == 0 || horizon <= moves {
            return Err(DesignError::MovesBeyondHorizon { horizon, moves });
        }
        let (f, phi) = condensed(plant, horizon);
        // T: u at sample i is u₋₁ plus the moves up to i
        let mut t = DMatrix::zeros(p * horizon, p * moves);
        let mut ones = DMatrix::zeros(p * horizon, p);
        for sample in 0..horizon {
            ones.view_mut((sample * p, 0), (p, p)).fill_with_identity();
            for k in 0..=sample.min(moves - 1) {
                t.view_mut((sample * p, k * p), (p, p)).fill_with_identity();
            }
        }
        let response = &phi * t;
        let q_all = repeated(&weights.output, horizon);
        let mut gradient_reference = response.transpose() * q_all;
        let more = FurtherCost::new(plant, weights, horizon, moves);
        let hessian = &gradient_reference * response + more.hessian + repeated(&weights.moves, moves);
        let gradient_state = &gradient_reference * f + more.gradient_state;
        let gradient_input = &gradient_reference * phi * ones + more.gradient_input;
        // The last reference is that at the end of the horizon, too.
        let mut last = gradient_reference.columns_mut(q * (horizon - 1), q);
        last += more.gradient_last_reference;
        let design = Self {
            plant: plant.clone(),
            moves,
            gradient_state,
            gradient_input,
            gradient_reference,
            hessian: symmetrized(&hessian),
            spectral_radius: 0.0,
        };
        let spectral_radius = spectral_radius("the closed loop", &design.closed_loop()?)?;
        if spectral_radius.is_nan() || spectral_radius >= 1.0 {
            return Err(DesignError::Unstable { spectral_radius });
        }
        Ok(Self { spectral_radius, ..design })
    }

    /// Gains of the unconstrained law Δu(k) = −K_x x(k) − K_u u(k−1) for a reference of zero.
    ///
    /// # Errors
    /// [`DesignError::IllConditioned`] when H cannot be factored.
    pub fn gains(&self) -> Result<(DMatrix<f64>, DMatrix<f64>), DesignError> {
        let p = self.plant.inputs();
        let factor = self.hessian.clone().cholesky().ok_or_else(|| DesignError::IllConditioned {
            condition: crate::condition_number(&self.hessian),
        })?;
        let first = |gradient: &DMatrix<f64>| factor.solve(gradient).rows(0, p).into_owned();
        Ok((first(&self.gradient_state), first(&self.gradient_input)))
    }

    /// H of the quadratic form.
    pub fn hessian(&self) -> &DMatrix<f64> {
        &self.hessian
    }

    /// Largest magnitude of the eigenvalues of the unconstrained closed loop in \[x; u₋₁\].
    pub fn spectral_radius(&self) -> f64 {
        self.spectral_radius
    }

    /// [x; u₋₁] from one sample to the next.
    fn closed_loop(&self) -> Result<DMatrix<f64>, DesignError> {
        let (n, p) = (self.plant.states(), self.plant.inputs());
        let (state_gain, input_gain) = self.gains()?;
        // u = (I − K_u) u₋₁ − K_x x
        let held = DMatrix::identity(p, p) - input_gain;
        let mut loop_ = DMatrix::zeros(n + p, n + p);
        loop_.view_mut((0, 0), (n, n)).copy_from(&(self.plant.a() - self.plant.b() * &state_gain));
        loop_.view_mut((0, n), (n, p)).copy_from(&(self.plant.b() * &held));
        loop_.view_mut((n, 0), (p, n)).copy_from(&-state_gain);
        loop_.view_mut((n, n), (p, p)).copy_from(&held);
        Ok(loop_)
    }
}

/// What ½ Σ ‖Δx(k+i)‖²_W and the weight of the state at the end add to the quadratic form.
struct FurtherCost {
    hessian: DMatrix<f64>,
    gradient_state: DMatrix<f64>,
    gradient_input: DMatrix<f64>,
    gradient_last_reference: DMatrix<f64>,
}

impl FurtherCost {
    fn new(plant: &StateSpace, weights: &StateSpaceMpcWeights, horizon: usize, moves: usize) -> Self {
        let (n, p, q) = (plant.states(), plant.inputs(), plant.outputs());
        let mut walk = MovesWalk::new(plant, moves);
        let mut cost = Self {
            hessian: DMatrix::zeros(p * moves, p * moves),
            gradient_state: DMatrix::zeros(p * moves, n),
            gradient_input: DMatrix::zeros(p * moves, p),
            gradient_last_reference: DMatrix::zeros(p * moves, q),
        };
        let mut before = walk.predicted(Quantity::State);
        for i in 1..=horizon {
            walk.advance();
            let now = walk.predicted(Quantity::State);
            let (by_moves, known) = (&now.decision - &before.decision, &now.known - &before.known);
            match weights.terminal.as_ref().filter(|_| i == horizon) {
                None => {
                    cost.add(&by_moves, &known, &weights.increment);
                }
                // ½ ‖[Δx(k+N); y(k+N) − r]‖²_P
                Some(terminal) => {
                    let stacked = |above: &DMatrix<f64>, x: &DMatrix<f64>| {
                        let mut stacked = above.clone().resize_vertically(n + q, 0.0);
                        stacked.rows_mut(n, q).copy_from(&(plant.c() * x));
                        stacked
                    };
                    let by_moves = stacked(&by_moves, &now.decision);
                    let weighted = cost.add(&by_moves, &stacked(&known, &now.known), terminal);
                    cost.gradient_last_reference += weighted.columns(n, q);
                }
            }
            before = now;
        }
        cost
    }

    /// ½ ‖`by_moves` ΔU + `known`‖² in a weight; returns `by_moves`ᵀ times the weight.
    fn add(&mut self, by_moves: &DMatrix<f64>, known: &DMatrix<f64>, weight: &DMatrix<f64>) -> DMatrix<f64> {
        let (n, p) = (self.gradient_state.ncols(), self.gradient_input.ncols());
        let weighted = by_moves.transpose() * weight;
        self.hessian += &weighted * by_moves;
        self.gradient_state += &weighted * known.columns(0, n);
        self.gradient_input += &weighted * known.columns(n, p);
        weighted
    }
}

/// F and Φ of (33) with D = 0: Y = \[y(k) … y(k+N−1)\] from x(k) and U = \[u(k) … u(k+N−1)\].
fn condensed(plant: &StateSpace, horizon: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let (n, p, q) = (plant.states(), plant.inputs(), plant.outputs());
    let mut f = DMatrix::zeros(q * horizon, n);
    let mut phi = DMatrix::zeros(q * horizon, p * horizon);
    let mut c_a = plant.c().clone(); // C A^i
    for i in 0..horizon {
        f.view_mut((i * q, 0), (q, n)).copy_from(&c_a);
        // C A^i B stands i + 1 block rows below the diagonal
        let response = &c_a * plant.b();
        for column in 0..horizon.saturating_sub(i + 1) {
            phi.view_mut(((column + i + 1) * q, column * p), (q, p)).copy_from(&response);
        }
        c_a *= plant.a();
    }
    (f, phi)
}

fn repeated(block: &DMatrix<f64>, count: usize) -> DMatrix<f64> {
    DMatrix::identity(count, count).kronecker(block)
}

/// The run-time controller for N states, P inputs, Q outputs and E ≥ P N_c + 1 unknowns: allocates nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpaceMpc<const N: usize, const P: usize, const Q: usize, const E: usize> {
    gradient_state: SMatrix<f64, E, N>,
    gradient_input: SMatrix<f64, E, P>,
    /// One block per previewed sample, from y(k) on.
    gradient_reference: Vec<SMatrix<f64, E, Q>>,
    program: RelaxableProgram<E>,
    known: Vec<Known<N, P>>,
}

/// What of a limit is known before the moves are chosen.
#[derive(Clone, Debug, PartialEq)]
struct Known<const N: usize, const P: usize> {
    state: SVector<f64, N>,
    driving: SVector<f64, P>,
    input: SVector<f64, P>,
    step: SVector<f64, P>,
    bound: usize,
}

/// What a [`StateSpaceMpc`] is told at one sample. Without a reference trajectory: state = x̂(k), and the rest zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateSpaceMpcSample<const N: usize, const P: usize> {
    /// x̂(k) − x_r(k), measured or predicted.
    pub state: SVector<f64, N>,
    /// u_r(k), the input that keeps the plant on the reference trajectory.
    pub input_reference: SVector<f64, P>,
    /// d̂(k): a disturbance that acts on the plant as if it were added to the input, taken to last.
    pub disturbance: SVector<f64, P>,
}

impl<const N: usize, const P: usize> StateSpaceMpcSample<N, P> {
    /// A state, with neither a reference trajectory nor a disturbance.
    pub fn of_state(state: SVector<f64, N>) -> Self {
        Self { state, input_reference: SVector::zeros(), disturbance: SVector::zeros() }
    }
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize> StateSpaceMpc<N, P, Q, E> {
    /// The controller of a design under some limits.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the sizes differ from the const generics or E is too small.
    pub fn new(design: &StateSpaceMpcDesign, limits: &[Limit]) -> Result<Self, DesignError> {
        let plant = &design.plant;
        validate::shape("A", plant.a(), (N, N))?;
        validate::shape("B", plant.b(), (N, P))?;
        validate::shape("C", plant.c(), (Q, N))?;
        let unknowns = P * design.moves;
        let rows = limit_rows(limits, MovesWalk::new(plant, design.moves))?;
        let mut g = DMatrix::zeros(rows.len(), unknowns);
        for (index, row) in rows.iter().enumerate() {
            g.set_row(index, &row.decision);
        }
        let soft: Vec<bool> = rows.iter().map(|row| row.soft).collect();
        let program = RelaxableProgram::new(&design.hessian, &g, &soft)?;
        let padded =
            |matrix: &DMatrix<f64>, i: usize, j: usize| if i < unknowns { matrix[(i, j)] } else { 0.0 };
        let previewed = design.gradient_reference.ncols() / Q;
        Ok(Self {
            gradient_state: SMatrix::from_fn(|i, j| padded(&design.gradient_state, i, j)),
            gradient_input: SMatrix::from_fn(|i, j| padded(&design.gradient_input, i, j)),
            gradient_reference: (0..previewed)
                .map(|sample| SMatrix::from_fn(|i, j| padded(&design.gradient_reference, i, sample * Q + j)))
                .collect(),
            program,
            known: rows
                .iter()
                .map(|row| Known {
                    state: SVector::from_fn(|i, _| row.known[i]),
                    driving: SVector::from_fn(|i, _| row.known[N + i]),
                    input: SVector::from_fn(|i, _| row.known[N + P + i]),
                    step: SVector::from_fn(|i, _| row.known[N + 2 * P + i]),
                    bound: row.bound,
                })
                .collect(),
        })
    }

    /// One sample: u(k) from the state and the references r(k), r(k+1), … of the outputs, of which the last one
    /// stands for all that are missing. `upper` holds one value per direction of each limit; limits of the state
    /// bound its deviation from the reference trajectory.
    pub fn step<const W: usize>(
        &self,
        state: &mut ConstrainedState<N, P, W>,
        sample: &StateSpaceMpcSample<N, P>,
        references: &[SVector<f64, Q>],
        upper: &[f64],
    ) -> ConstrainedStep<P> {
        let feedback = state.controller.feedback();
        let driving = feedback + sample.disturbance;
        let input = sample.input_reference + feedback;
        let reference_step = sample.input_reference - state.controller.input_reference();

        let mut f = self.gradient_state * sample.state + self.gradient_input * driving;
        for (index, gradient) in self.gradient_reference.iter().enumerate() {
            if let Some(reference) = references.get(index).or(references.last()) {
                f -= gradient * reference;
            }
        }
        let bound = |row: usize| {
            let known = &self.known[row];
            let upper = upper.get(known.bound).copied().unwrap_or(f64::INFINITY);
            upper
                - known.state.dot(&sample.state)
                - known.driving.dot(&driving)
                - known.input.dot(&input)
                - known.step.dot(&reference_step)
        };
        let (solution, status) = self.program.solve(&f, bound, &mut state.warm_start);
        let first_move = SVector::from_fn(|i, _| solution.x[i]);
        state.taken(&sample.state, &sample.input_reference, first_move, &solution, status)
    }
}
