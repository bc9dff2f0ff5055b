//! Linear state-space MPC (28)–(34), which the paper compares LMPC with: one unknown per move and input.

use alloc::vec::Vec;

use nalgebra::{DMatrix, SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::limit_row::limit_rows;
use crate::moves_walk::MovesWalk;
use crate::relaxable::{RelaxableProgram, RelaxableWarmStart};
use crate::validate::symmetrized;
use crate::{DesignError, Limit, StateSpace, Status, spectral_radius, validate};

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

impl StateSpaceMpcDesign {
    /// For a plant, the weights Q on the outputs (q×q) and S on the moves (p×p), a prediction horizon of N =
    /// `horizon` samples and a control horizon of N_c = `moves`.
    ///
    /// # Errors
    /// [`DesignError::Dimension`], [`DesignError::NotFinite`], [`DesignError::NotPositiveSemidefinite`]
    /// (Q), [`DesignError::NotPositiveDefinite`] (S), [`DesignError::HorizonTooShort`] unless
    /// 1 ≤ N_c ≤ N − 1, [`DesignError::Unstable`] when the unconstrained closed loop is not stable.
    pub fn new(
        plant: &StateSpace,
        output_weight: &DMatrix<f64>,
        move_weight: &DMatrix<f64>,
        horizon: usize,
        moves: usize,
    ) -> Result<Self, DesignError> {
        let (p, q) = (plant.inputs(), plant.outputs());
        validate::shape("Q", output_weight, (q, q))?;
        validate::shape("S", move_weight, (p, p))?;
        validate::positive_semidefinite("Q", output_weight)?;
        validate::positive_definite("S", move_weight)?;
        if moves == 0 || horizon <= moves {
            return Err(DesignError::HorizonTooShort { horizon, terms: moves + 1 });
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
        let q_all = repeated(output_weight, horizon);
        let gradient_reference = response.transpose() * q_all;
        let hessian = symmetrized(&(&gradient_reference * response + repeated(move_weight, moves)));
        let design = Self {
            plant: plant.clone(),
            moves,
            gradient_state: &gradient_reference * f,
            gradient_input: &gradient_reference * phi * ones,
            gradient_reference,
            hessian,
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

/// What of a limit is known before the moves are chosen: state·x + input·u₋₁.
#[derive(Clone, Debug, PartialEq)]
struct Known<const N: usize, const P: usize> {
    state: SVector<f64, N>,
    input: SVector<f64, P>,
    bound: usize,
}

/// What a [`StateSpaceMpc`] remembers: the input that was applied last, and its last active set.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StateSpaceMpcState<const P: usize, const E: usize> {
    applied: SVector<f64, P>,
    warm_start: RelaxableWarmStart<E>,
}

impl<const P: usize, const E: usize> StateSpaceMpcState<P, E> {
    /// Takes over at this input.
    pub fn new(applied: SVector<f64, P>) -> Self {
        Self { applied, warm_start: RelaxableWarmStart::default() }
    }

    /// Reports the input that was applied in truth. A value that is not finite is ignored.
    pub fn apply(&mut self, applied: &SVector<f64, P>) {
        if applied.iter().all(|value| value.is_finite()) {
            self.applied = *applied;
        }
    }
}

/// The outcome of a step of a [`StateSpaceMpc`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateSpaceMpcStep<const P: usize> {
    /// u(k).
    pub input: SVector<f64, P>,
    /// How it was found.
    pub status: Status,
    /// Iterations of the solver.
    pub iterations: u32,
    /// How many limits hold with equality.
    pub active: usize,
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
                    input: SVector::from_fn(|i, _| row.known[N + i]),
                    bound: row.bound,
                })
                .collect(),
        })
    }

    /// One sample: u(k) from the state, measured or predicted, and the references r(k), r(k+1), …, of which
    /// the last one stands for all that are missing. `upper` holds one value per direction of each limit.
    pub fn step(
        &self,
        state: &mut StateSpaceMpcState<P, E>,
        estimate: &SVector<f64, N>,
        references: &[SVector<f64, Q>],
        upper: &[f64],
    ) -> StateSpaceMpcStep<P> {
        let mut f = self.gradient_state * estimate + self.gradient_input * state.applied;
        for (sample, gradient) in self.gradient_reference.iter().enumerate() {
            if let Some(reference) = references.get(sample).or(references.last()) {
                f -= gradient * reference;
            }
        }
        let applied = state.applied;
        let bound = |row: usize| {
            let known = &self.known[row];
            let upper = upper.get(known.bound).copied().unwrap_or(f64::INFINITY);
            upper - known.state.dot(estimate) - known.input.dot(&applied)
        };
        let (solution, status) = self.program.solve(&f, bound, &mut state.warm_start);
        let usable = matches!(status, Status::Optimal | Status::Relaxed);
        let increment = SVector::from_fn(|i, _| if usable { solution.x[i] } else { 0.0 });
        let input = state.applied + increment;
        let finite = input.iter().all(|value| value.is_finite());
        let (input, status) = if finite { (input, status) } else { (state.applied, Status::Held) };
        state.applied = input;
        StateSpaceMpcStep { input, status, iterations: solution.iterations, active: solution.active }
    }
}
