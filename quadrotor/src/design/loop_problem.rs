//! What a controller of the cascade minimizes, and under which limits.

use alloc::vec::Vec;

use lmpc::{Augmented, DesignError, Dlqr, LaguerreBasis, SignalLimit, StabilizedDesign, StateSpace, Weights};
use nalgebra::{DMatrix, SVector};

use crate::ControllerSettings;
use crate::design::loop_weights::loop_weights;

/// What a violation by a limit's whole relaxation costs, as a multiple of what the error in sight does.
const VIOLATION: f64 = 1e3;
/// Bandwidth of the feedback about which plans are made, as a share of the controller's, unless a loop has its own.
const STABILIZING_SHARE: f64 = 0.3;

/// The regulation problem of one loop with P outputs: its model, weights and limits. What is left to choose is how the
/// controller plans: N, a, and the feedback about which it does.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopProblem<const P: usize> {
    settings: ControllerSettings<P>,
    bandwidth_rad_s: SVector<f64, P>,
    model: Augmented,
    weights: Weights,
    limits: Vec<SignalLimit>,
    regulator: Dlqr,
    sight: f64,
    stabilizing_share: f64,
}

impl<const P: usize> LoopProblem<P> {
    /// Of a loop whose outputs are closed with some bandwidths, rad/s. `sight` is an error of the output, the cost of which
    /// stands for that of a violated limit.
    pub(crate) fn new(
        settings: &ControllerSettings<P>,
        bandwidth_rad_s: &SVector<f64, P>,
        limits: impl Into<Vec<SignalLimit>>,
        sight: f64,
        plant: &StateSpace,
    ) -> Result<Self, DesignError> {
        let model = Augmented::new(plant);
        let weights = loop_weights(&model, settings, bandwidth_rad_s)?;
        let regulator = Dlqr::new(model.a(), model.b(), weights.q(), weights.r(), settings.lambda)?;
        let bandwidth_rad_s = *bandwidth_rad_s;
        Ok(Self {
            settings: *settings,
            bandwidth_rad_s,
            model,
            weights,
            limits: limits.into(),
            regulator,
            sight,
            stabilizing_share: STABILIZING_SHARE,
        })
    }

    /// The same problem under further limits, behind those that it has.
    pub(crate) fn also_within(mut self, limits: impl IntoIterator<Item = SignalLimit>) -> Self {
        self.limits.extend(limits);
        self
    }

    /// The same problem, planned about a feedback with another share of its bandwidth.
    pub(crate) fn planned_about(self, stabilizing_share: f64) -> Self {
        Self { stabilizing_share, ..self }
    }

    /// Bandwidth of the feedback about which the flown plans are made, as a share of the controller's.
    pub fn stabilizing_share(&self) -> f64 {
        self.stabilizing_share
    }

    /// The settings of the loop.
    pub fn settings(&self) -> &ControllerSettings<P> {
        &self.settings
    }

    /// The augmented model.
    pub fn model(&self) -> &Augmented {
        &self.model
    }

    /// Q and R.
    pub fn weights(&self) -> &Weights {
        &self.weights
    }

    /// What it keeps within.
    pub fn limits(&self) -> &[SignalLimit] {
        &self.limits
    }

    /// What a slack of 1 costs.
    pub fn slack_cost(&self) -> f64 {
        let states = self.model.plant().states();
        let of_output = self.regulator.cost()[(states, states)];
        VIOLATION * of_output * self.sight * self.sight
    }

    /// A design with N = `terms` and a = `scale`, which plans about a feedback with this share of the loop's bandwidth.
    ///
    /// # Errors
    /// Those of [`LaguerreBasis::new`], [`Dlqr::new`] and [`StabilizedDesign::beside`].
    pub fn design(
        &self,
        terms: usize,
        scale: f64,
        stabilizing_share: f64,
    ) -> Result<StabilizedDesign, DesignError> {
        let stabilizing = self.stabilizing_gain(stabilizing_share)?;
        let basis = LaguerreBasis::new(terms, scale)?;
        let bases: [LaguerreBasis; P] = core::array::from_fn(|_| basis.clone());
        StabilizedDesign::beside(&self.regulator, &self.model, &self.weights, &stabilizing, &bases)
    }

    /// K_s: the regulator of a share of the loop's bandwidth.
    pub(crate) fn stabilizing_gain(&self, share: f64) -> Result<DMatrix<f64>, DesignError> {
        let slow = loop_weights(&self.model, &self.settings, &(self.bandwidth_rad_s * share))?;
        let lambda = self.settings.lambda;
        Ok(Dlqr::new(self.model.a(), self.model.b(), slow.q(), slow.r(), lambda)?.gain().clone())
    }
}
