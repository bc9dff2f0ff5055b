//! A law about a stabilizing feedback, under limits.

use lmpc::{DesignError, spectral_radius};
use nalgebra::DMatrix;

use crate::ControllerKind;
use crate::control::tracking_law::TrackingLaw;
use crate::design::cascade_design::DesignReport;
use crate::design::loop_problem::LoopProblem;

/// A law about a stabilizing feedback, under limits, with what is known of its design.
pub(crate) struct StabilizedLaw<const N: usize, const P: usize, const S: usize, const L: usize> {
    pub(crate) law: TrackingLaw<N, P, S, L>,
    /// K, without limits: Δu = −K \[Δx; y − r\].
    pub(crate) gain: DMatrix<f64>,
    pub(crate) report: DesignReport,
}

impl<const N: usize, const P: usize, const S: usize, const L: usize> StabilizedLaw<N, P, S, L> {
    /// Of a kind of controller, with the settings of the loop.
    pub(crate) fn new(kind: ControllerKind, problem: &LoopProblem<P>) -> Result<Self, DesignError> {
        let settings = problem.settings();
        let design = problem.design(settings.terms as usize, settings.scale, problem.stabilizing_share())?;
        let law = TrackingLaw::stabilized(kind, settings, &design, problem.limits(), problem.slack_cost())?;
        let model = problem.model();
        let regulator = design.dlqr().gain();
        let regulated = model.a() - model.b() * regulator;
        let report = DesignReport {
            spectral_radius: design.spectral_radius(),
            eigenvalue_difference_to_dlqr: design.spectral_radius() - spectral_radius("A − BK", &regulated)?,
            condition_number: design.condition_number(),
        };
        let gain = if kind == ControllerKind::Lmpc { design.gain() } else { regulator }.clone();
        Ok(Self { law, gain, report })
    }

    /// The law and the figures of its design.
    pub(crate) fn law_and_report(self) -> (TrackingLaw<N, P, S, L>, DesignReport) {
        (self.law, self.report)
    }
}
