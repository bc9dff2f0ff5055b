//! A law about a stabilizing feedback, under limits.

use lmpc::{
    Augmented, DesignError, Dlqr, LaguerreBasis, SignalLimit, StabilizedDesign, StateSpace, spectral_radius,
};
use nalgebra::{DMatrix, SVector};

use crate::control::tracking_law::TrackingLaw;
use crate::design::cascade_design::DesignReport;
use crate::design::loop_weights::loop_weights;
use crate::{ControllerKind, ControllerSettings};

/// What a violation by a limit's whole relaxation costs, as a multiple of what the error in sight does.
const VIOLATION: f64 = 1e3;
/// Bandwidth of the feedback about which plans are made, as a share of the controller's.
const STABILIZING_SHARE: f64 = 0.3;

/// A law about a stabilizing feedback, under limits, with what is known of its design.
pub(crate) struct StabilizedLaw<const N: usize, const P: usize, const S: usize, const L: usize> {
    pub(crate) law: TrackingLaw<N, P, S, L>,
    /// K, without limits: Δu = −K \[Δx; y − r\].
    pub(crate) gain: DMatrix<f64>,
    pub(crate) report: DesignReport,
}

impl<const N: usize, const P: usize, const S: usize, const L: usize> StabilizedLaw<N, P, S, L> {
    /// Of a kind of controller whose outputs are closed with some bandwidths, rad/s. `sight` is an error of the output, the cost of
    /// which stands for that of a violated limit.
    pub(crate) fn new(
        kind: ControllerKind,
        settings: &ControllerSettings<P>,
        bandwidth_rad_s: &SVector<f64, P>,
        limits: &[SignalLimit],
        sight: f64,
        model: &StateSpace,
    ) -> Result<Self, DesignError> {
        let augmented = Augmented::new(model);
        let weights = loop_weights(&augmented, settings, bandwidth_rad_s)?;
        let stabilizing = stabilizing_gain(&augmented, settings, bandwidth_rad_s)?;
        let basis = LaguerreBasis::new(settings.terms as usize, settings.scale)?;
        let bases: [LaguerreBasis; P] = core::array::from_fn(|_| basis.clone());
        let design = StabilizedDesign::new(&augmented, &weights, &stabilizing, &bases, settings.lambda)?;
        let slack_cost = slack_cost(design.dlqr(), N, sight);
        let law = TrackingLaw::stabilized(kind, settings, &design, limits, slack_cost)?;
        let regulator = design.dlqr().gain();
        let regulated = augmented.a() - augmented.b() * regulator;
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

/// K_s: the regulator of a fraction of the bandwidth.
pub(crate) fn stabilizing_gain<const P: usize>(
    model: &Augmented,
    settings: &ControllerSettings<P>,
    bandwidth_rad_s: &SVector<f64, P>,
) -> Result<DMatrix<f64>, DesignError> {
    let slow = loop_weights(model, settings, &(bandwidth_rad_s * STABILIZING_SHARE))?;
    Ok(Dlqr::new(model.a(), model.b(), slow.q(), slow.r(), settings.lambda)?.gain().clone())
}

/// What a slack of 1 costs, for a plant of so many states, from an error of the output the cost of which stands for a violation.
pub(crate) fn slack_cost(regulator: &Dlqr, states: usize, sight: f64) -> f64 {
    VIOLATION * regulator.cost()[(states, states)] * sight * sight
}
