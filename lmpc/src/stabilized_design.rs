//! A Laguerre MPC whose prediction is stabilized by a feedback of its own.

use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector};

use crate::dlqr::check_lambda;
use crate::laguerre::InputBasis;
use crate::optimal_gain::OptimalGain;
use crate::{Augmented, DesignError, Dlqr, LaguerreBasis, Weights, solve_stein, spectral_radius, validate};

/// Laguerre MPC with the plan
///
/// ```text
/// Δu(k+m) = −K_s x(k+m) + L(m)ᵀ η        for all m ≥ 0
/// ```
///
/// where K_s is a slow, stabilizing feedback. The paper's (45) is K_s = 0, whose plan leaves the integrators of the plant
/// where the moves end; it therefore needs a finite horizon. With K_s the plan ends at the set-point by itself, and the cost
///
/// ```text
/// V(x, η) = Σ_{m ≥ 0} x(k+m)ᵀ Q x(k+m) + Δu(k+m)ᵀ R Δu(k+m)
/// ```
///
/// over the infinite horizon is a quadratic form \[x; η\]ᵀ S \[x; η\]: the plan is the motion of the stable system
///
/// ```text
/// [x(m+1)]   [A − B K_s   B L(0)ᵀ] [x(m)]
/// [ρ(m+1)] = [0           A_lᵀ   ] [ρ(m)],   ρ(0) = η
/// ```
///
/// and S solves its Stein equation. (Rossiter, Kouvaritakis and Rice 1998 predict about a stabilizing feedback; Valencia-Palomo, Rossiter
/// and others 2010 combine that with Laguerre functions.)
///
/// # Certificate
///
/// Plans are closed under shifts: what is left of a plan after its first move is the plan A_lᵀη of the next state. On the
/// undisturbed linear loop with constant bounds therefore
///
/// * V(x⁺, A_lᵀη) = V(x, η) − xᵀQx − ΔuᵀRΔu: the optimal cost decreases by the stage cost or more;
/// * limits that hold on all samples m ≥ 0 hold for the shifted plan, so that a feasible program stays feasible. Limits that
///   are placed on the first M samples do so as far as the plan has settled within them by then. With gaps between the samples
///   this is not guaranteed;
/// * limits that were relaxed by a slack σ need no more of it for the shifted plan, so that V + cσ² decreases by the stage cost
///   or more as well, whereas σ alone may grow for a while.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilizedDesign {
    model: Augmented,
    bases: Vec<LaguerreBasis>,
    weights: Weights,
    stabilizing_gain: DMatrix<f64>,
    /// S, (n+q+ΣN)².
    cost: DMatrix<f64>,
    /// S_ηη⁻¹ S_ηx, ΣN×(n+q).
    coefficient_gain: DMatrix<f64>,
    gain: DMatrix<f64>,
    dlqr: Dlqr,
    spectral_radius: f64,
    condition_number: f64,
}

impl StabilizedDesign {
    /// The design of an augmented model with one Laguerre basis per input about the feedback K_s = `stabilizing_gain`,
    /// p×(n+q), for a degree of stability 0 < λ ≤ 1: the costs of sample m count λ^(−2m).
    ///
    /// # Errors
    /// [`DesignError::Unstable`] when A − B K_s has an eigenvalue of magnitude λ or more, or when the closed loop is not stable;
    /// [`DesignError::LaguerreDecay`] when a ≥ λ; [`DesignError::BasisCount`], [`DesignError::IllConditioned`], and those of
    /// [`Dlqr::new`].
    pub fn new(
        model: &Augmented,
        weights: &Weights,
        stabilizing_gain: &DMatrix<f64>,
        bases: &[LaguerreBasis],
        lambda: f64,
    ) -> Result<Self, DesignError> {
        let dlqr = Dlqr::new(model.a(), model.b(), weights.q(), weights.r(), lambda)?;
        Self::beside(&dlqr, model, weights, stabilizing_gain, bases)
    }

    /// The same beside the [regulator](Self::dlqr) of the model and the weights where that is known already, which spares its Riccati
    /// equation: several designs with other bases or feedbacks have the same one. λ is the regulator's [radius](Dlqr::radius).
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the regulator is one of another number of states or inputs, [`DesignError::Lambda`] when its
    /// radius is above 1, and those of [`Self::new`].
    pub fn beside(
        regulator: &Dlqr,
        model: &Augmented,
        weights: &Weights,
        stabilizing_gain: &DMatrix<f64>,
        bases: &[LaguerreBasis],
    ) -> Result<Self, DesignError> {
        let (states, inputs) = (model.states(), model.inputs());
        let lambda = regulator.radius();
        check_lambda(lambda)?;
        validate::shape("K of the regulator", regulator.gain(), (inputs, states))?;
        validate::shape("K_s", stabilizing_gain, (inputs, states))?;
        if bases.len() != inputs {
            return Err(DesignError::BasisCount { expected: inputs, actual: bases.len() });
        }
        if let Some(basis) = bases.iter().find(|basis| basis.scale() >= lambda) {
            return Err(DesignError::LaguerreDecay { scale: basis.scale(), lambda });
        }
        let stabilized = (model.a() - model.b() * stabilizing_gain) / lambda;
        let radius = spectral_radius("A − B K_s", &stabilized)?;
        if radius.is_nan() || radius >= 1.0 {
            return Err(DesignError::Unstable { spectral_radius: radius });
        }

        let plan = Plan::new(model, stabilizing_gain, bases);
        // S = Fᵀ S F + diag(Q, 0) + Cᵀ R C with Δu = C [x; ρ]
        let mut stage = plan.move_of.transpose() * weights.r() * &plan.move_of;
        let mut of_state = stage.view_mut((0, 0), (states, states));
        of_state += weights.q();
        let transition_t = plan.transition.transpose() / lambda;
        let cost = solve_stein(&transition_t, &transition_t, &stage)
            .ok_or(DesignError::Unstable { spectral_radius: radius })?;
        let cost = validate::symmetrized(&cost);

        let (hessian, coupling) = coefficient_cost(&cost, states);
        let OptimalGain { unknowns: coefficient_gain, first_move, condition: condition_number, .. } =
            OptimalGain::new("S of the coefficients", &hessian, &coupling, &InputBasis::new(bases).row())?;
        // Δu = −K_s x + L(0)ᵀ η with η = −S_ηη⁻¹ S_ηx x
        let gain = stabilizing_gain + first_move;
        let closed_loop = model.a() - model.b() * &gain;
        let spectral_radius = spectral_radius("A − BK", &closed_loop)?;
        if spectral_radius.is_nan() || spectral_radius >= 1.0 {
            return Err(DesignError::Unstable { spectral_radius });
        }
        Ok(Self {
            model: model.clone(),
            bases: bases.to_vec(),
            weights: weights.clone(),
            stabilizing_gain: stabilizing_gain.clone(),
            cost,
            coefficient_gain,
            gain,
            dlqr: regulator.clone(),
            spectral_radius,
            condition_number,
        })
    }

    /// S_ηη and S_ηx.
    pub(crate) fn coefficient_cost(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        coefficient_cost(&self.cost, self.model.states())
    }

    /// K, p×(n+q): without limits Δu = −K \[Δx_m; y − r\].
    pub fn gain(&self) -> &DMatrix<f64> {
        &self.gain
    }

    /// K_s, p×(n+q).
    pub fn stabilizing_gain(&self) -> &DMatrix<f64> {
        &self.stabilizing_gain
    }

    /// S, (n+q+ΣN)²: V(x, η) = \[x; η\]ᵀ S \[x; η\].
    pub fn cost(&self) -> &DMatrix<f64> {
        &self.cost
    }

    /// V(x, η), the cost of a plan over the infinite horizon, for λ = 1.
    pub fn cost_of(&self, x: &DVector<f64>, eta: &DVector<f64>) -> f64 {
        let plan = DVector::from_iterator(x.len() + eta.len(), x.iter().chain(eta.iter()).copied());
        plan.dot(&(&self.cost * &plan))
    }

    /// A_lᵀη: what is left of a plan after its first move.
    pub fn shifted(&self, eta: &DVector<f64>) -> DVector<f64> {
        let mut shifted = DVector::zeros(eta.len());
        let mut offset = 0;
        for basis in &self.bases {
            let terms = basis.terms();
            let part = basis.a_l().transpose() * eta.rows(offset, terms);
            shifted.rows_mut(offset, terms).copy_from(&part);
            offset += terms;
        }
        shifted
    }

    /// S_ηη⁻¹ S_ηx: without limits η = −S_ηη⁻¹ S_ηx x.
    pub fn coefficient_gain(&self) -> &DMatrix<f64> {
        &self.coefficient_gain
    }

    /// Q and R.
    pub fn weights(&self) -> &Weights {
        &self.weights
    }

    /// The infinite-horizon regulator of the same weights and degree of stability.
    pub fn dlqr(&self) -> &Dlqr {
        &self.dlqr
    }

    /// The augmented model that it was designed on.
    pub fn model(&self) -> &Augmented {
        &self.model
    }

    /// One Laguerre basis per input.
    pub fn bases(&self) -> &[LaguerreBasis] {
        &self.bases
    }

    /// Largest magnitude of the closed-loop eigenvalues, below 1.
    pub fn spectral_radius(&self) -> f64 {
        self.spectral_radius
    }

    /// Condition number of S_ηη, finite.
    pub fn condition_number(&self) -> f64 {
        self.condition_number
    }

    pub(crate) fn plan(&self) -> Plan {
        Plan::new(&self.model, &self.stabilizing_gain, &self.bases)
    }
}

/// What S of \[x; η\] tells of η, for so many states x: S_ηη and S_ηx.
fn coefficient_cost(cost: &DMatrix<f64>, states: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let terms = cost.nrows() - states;
    (
        cost.view((states, states), (terms, terms)).into_owned(),
        cost.view((states, 0), (terms, states)).into_owned(),
    )
}

/// The autonomous system \[x; ρ\] that generates a plan.
pub(crate) struct Plan {
    pub(crate) terms: usize,
    /// F.
    pub(crate) transition: DMatrix<f64>,
    /// C: Δu = C \[x; ρ\].
    pub(crate) move_of: DMatrix<f64>,
}

impl Plan {
    fn new(model: &Augmented, stabilizing_gain: &DMatrix<f64>, bases: &[LaguerreBasis]) -> Self {
        let first_move = InputBasis::new(bases).row();
        let (states, terms) = (model.states(), first_move.ncols());
        let mut transition = DMatrix::zeros(states + terms, states + terms);
        transition.view_mut((0, 0), (states, states)).copy_from(&(model.a() - model.b() * stabilizing_gain));
        transition.view_mut((0, states), (states, terms)).copy_from(&(model.b() * &first_move));
        let mut offset = states;
        for basis in bases {
            let size = basis.terms();
            transition.view_mut((offset, offset), (size, size)).copy_from(&basis.a_l().transpose());
            offset += size;
        }
        let mut move_of = DMatrix::zeros(model.inputs(), states + terms);
        move_of.view_mut((0, 0), (model.inputs(), states)).copy_from(&-stabilizing_gain);
        move_of.view_mut((0, states), (model.inputs(), terms)).copy_from(&first_move);
        Self { terms, transition, move_of }
    }
}
