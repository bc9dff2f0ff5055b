//! The linear program of one controller, as it flies: to study it without a vehicle.

use alloc::vec;
use alloc::vec::Vec;

use lmpc::{
    Augmented, DesignError, LaguerreBasis, Limit, SignalLimit, StabilizedDesign, StateSpace, Weights,
};
use nalgebra::DMatrix;

use crate::HoverLoop;
use crate::control::tracking_law::plain;

/// Model, weights, limits and design choices of one controller in hover, with
/// [`PredictionModel::InnerLoops`](crate::PredictionModel). All states of the model are zero at rest at the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearLoop {
    /// The model, sampled; each output is the first state of its channel.
    pub model: StateSpace,
    /// ΔT, s.
    pub sample_time_s: f64,
    /// Q on \[Δx; y − r\] and R on Δu.
    pub weights: Weights,
    /// K_s of [`StabilizedDesign`].
    pub stabilizing_gain: DMatrix<f64>,
    /// What a slack of 1 costs.
    pub slack_cost: f64,
    /// The limits, as [`lmpc::StabilizedMpc`] takes them.
    pub limits: Vec<SignalLimit>,
    /// Their bounds in hover: [`lmpc::Sample::upper`].
    pub upper: Vec<f64>,
    /// The largest error that the controller plans with, m or rad; more is seen as this much.
    pub sight: f64,
    /// N per input.
    pub terms: usize,
    /// a.
    pub scale: f64,
    /// λ, the wanted degree of stability; 1 for none.
    pub lambda: f64,
    /// N_p of laws with a finite horizon, samples.
    pub prediction_horizon: usize,
}

impl LinearLoop {
    /// Of a loop in hover.
    ///
    /// # Errors
    /// [`DesignError`] when the feedback about which it plans cannot be designed.
    pub fn new<const P: usize>(hover: &HoverLoop<P>) -> Result<Self, DesignError> {
        let problem = &hover.problem;
        let settings = problem.settings();
        Ok(Self {
            model: problem.model().plant().clone(),
            sample_time_s: settings.sample_time_s(),
            weights: problem.weights().clone(),
            stabilizing_gain: problem.stabilizing_gain(problem.stabilizing_share())?,
            slack_cost: problem.slack_cost(),
            limits: problem.limits().to_vec(),
            upper: hover.upper.clone(),
            sight: hover.sight,
            terms: settings.terms as usize,
            scale: settings.scale,
            lambda: settings.lambda,
            prediction_horizon: settings.prediction_horizon as usize,
        })
    }

    /// Its design with N = `terms` per input and a = `scale`.
    ///
    /// # Errors
    /// Those of [`LaguerreBasis::new`] and [`StabilizedDesign::new`].
    pub fn design(&self, terms: usize, scale: f64) -> Result<StabilizedDesign, DesignError> {
        let model = Augmented::new(&self.model);
        let bases = self.bases(terms, scale)?;
        StabilizedDesign::new(&model, &self.weights, &self.stabilizing_gain, &bases, self.lambda)
    }

    /// N = `terms` and a = `scale` for each input.
    ///
    /// # Errors
    /// Those of [`LaguerreBasis::new`].
    pub fn bases(&self, terms: usize, scale: f64) -> Result<Vec<LaguerreBasis>, DesignError> {
        Ok(vec![LaguerreBasis::new(terms, scale)?; self.model.inputs()])
    }

    /// The same limits for a [`lmpc::StateSpaceMpc`] or [`lmpc::LaguerreMpc`].
    pub fn plain_limits(&self) -> Vec<Limit> {
        self.limits.iter().map(plain).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::LinearLoop;
    use crate::{CascadeDesign, Configuration, HoverLoops};

    /// The study has the designs that fly: their spectral radii are those that the cascade reports.
    #[test]
    fn it_is_the_design_that_flies() {
        let configuration = Configuration::default();
        let cascade = CascadeDesign::new(&configuration).expect("a design");
        let radius = |linear: &LinearLoop| {
            linear.design(linear.terms, linear.scale).expect("a design").spectral_radius()
        };
        let loops = HoverLoops::new(&configuration).expect("loops");
        let position = LinearLoop::new(&loops.position).expect("a loop");
        let altitude = LinearLoop::new(&loops.altitude).expect("a loop");
        let lean = LinearLoop::new(&loops.lean).expect("a loop");
        let turn = LinearLoop::new(&loops.turn).expect("a loop");
        for (part, report) in cascade.reports() {
            let expected = match part {
                "position" => radius(&position),
                "altitude" => radius(&altitude),
                _ => radius(&lean).max(radius(&turn)),
            };
            assert_eq!(report.spectral_radius, expected, "{part}");
        }
        for linear in [position, altitude, lean, turn] {
            let bounds: usize = linear.limits.iter().map(|limit| limit.directions.nrows()).sum();
            assert_eq!(bounds, linear.upper.len());
            assert!(linear.upper.iter().all(|upper| *upper > 0.0));
        }
    }
}
