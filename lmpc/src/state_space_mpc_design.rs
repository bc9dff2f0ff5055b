//! Design of a linear state-space MPC (28)–(34), which the paper compares LMPC with: one unknown per move and input.

use nalgebra::DMatrix;

use crate::limit_row::PredictionWalk;
use crate::moves_walk::MovesWalk;
use crate::optimal_gain::OptimalGain;
use crate::validate::symmetrized;
use crate::{Augmented, DesignError, Quantity, StateSpace, Weights, spectral_radius, validate};

/// Design of a state-space MPC.
///
/// The outputs over the horizon are Y = F x̂ + Φ U (32)–(33), without the
/// [direct term](StateSpace#the-direct-term-d) D of (24). The unknowns are the first N_c moves Δu; after them, the input stays constant.
/// U = 1 u₋₁ + T ΔU makes the cost (34) the quadratic form
///
/// ```text
/// J = ½ ‖Y − R‖²_Q + ½ ‖ΔU‖²_S = ½ ΔUᵀ H ΔU + ΔUᵀ (Φ T)ᵀ Q (F x̂ + Φ 1 u₋₁ − R) + const
/// H = (Φ T)ᵀ Q (Φ T) + S
/// ```
///
/// The paper's cost ends with the horizon; [`StateSpaceMpcWeights`] can add what the state at its end costs.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpaceMpcDesign {
    pub(crate) plant: StateSpace,
    pub(crate) moves: usize,
    pub(crate) hessian: DMatrix<f64>,
    /// (Φ T)ᵀ Q F, (Φ T)ᵀ Q Φ 1 and (Φ T)ᵀ Q, the gradient's parts in x̂, u₋₁ and −R.
    pub(crate) gradient_state: DMatrix<f64>,
    pub(crate) gradient_input: DMatrix<f64>,
    pub(crate) gradient_reference: DMatrix<f64>,
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
    /// The same costs as Q and R on \[Δx; y − r\] and Δu of an augmented model: see [`Weights`]. What Q has between increments and
    /// errors does not count.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the weights are those of another model.
    pub fn of_augmented(
        model: &Augmented,
        weights: &Weights,
        terminal: Option<DMatrix<f64>>,
    ) -> Result<Self, DesignError> {
        let (states, all) = (model.plant().states(), model.states());
        validate::shape("Q", weights.q(), (all, all))?;
        let outputs = all - states;
        Ok(Self {
            output: weights.q().view((states, states), (outputs, outputs)).into_owned(),
            moves: weights.r().clone(),
            increment: weights.q().view((0, 0), (states, states)).into_owned(),
            terminal,
        })
    }

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
    /// [`DesignError::Dimension`], [`DesignError::ElementNotFinite`], [`DesignError::NotPositiveSemidefinite`]
    /// (Q, W, P), [`DesignError::NotPositiveDefinite`] (S), [`DesignError::MovesBeyondHorizon`] unless
    /// 1 ≤ N_c ≤ N − 1, [`DesignError::Unstable`] when the unconstrained closed loop is not stable,
    /// [`DesignError::IllConditioned`] when rounding may change its gain by more than 10⁻⁴ of its size.
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
    /// [`DesignError::IllConditioned`] when rounding may change them by more than 10⁻⁴ of their size.
    pub fn gains(&self) -> Result<(DMatrix<f64>, DMatrix<f64>), DesignError> {
        let (n, p) = (self.plant.states(), self.plant.inputs());
        let unknowns = self.hessian.nrows();
        let mut gradient = self.gradient_state.clone().resize_horizontally(n + p, 0.0);
        gradient.columns_mut(n, p).copy_from(&self.gradient_input);
        let first_move = DMatrix::identity(p, unknowns);
        let gain = OptimalGain::new("H", &self.hessian, &gradient, &first_move)?.first_move;
        Ok((gain.columns(0, n).into_owned(), gain.columns(n, p).into_owned()))
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

/// F and Φ of (33), where D is zero: Y = \[y(k) … y(k+N−1)\] from x(k) and U = \[u(k) … u(k+N−1)\].
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
