//! The three controllers of the cascade, designed from a configuration.

use alloc::vec::Vec;

use lmpc::{
    Augmented, Controller, DesignError, Discretization, LaguerreBasis, Limit, LmpcDesign, StateSpace,
    Weighting, Weights, spectral_radius,
};
use nalgebra::{DMatrix, DVector};

use crate::configuration::validation::validate;
use crate::control::tracking_law::TrackingLaw;
use crate::design::controller_limits::{altitude_limits, attitude_limits, position_limits};
use crate::design::estimator_design::EstimatorDesign;
use crate::design::linear_models::{altitude_model, attitude_model, position_model};
use crate::{Configuration, ConfigurationError, ControllerKind, ControllerSettings};

/// Terms or moves per input that the larger programs have room for.
const LARGE: usize = 30;
/// Laguerre terms per input that the smaller programs have room for.
const SMALL: usize = 7;

/// Unknowns of the larger programs, slack included.
pub(crate) const ALTITUDE_UNKNOWNS: usize = LARGE + 1;
pub(crate) const POSITION_UNKNOWNS: usize = 2 * LARGE + 1;
pub(crate) const ATTITUDE_UNKNOWNS: usize = 3 * LARGE + 1;

/// The figures of one finished design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DesignReport {
    /// Largest magnitude of the closed-loop eigenvalues, below 1.
    pub spectral_radius: f64,
    /// By how much that differs from the infinite-horizon regulator's of the same weights.
    pub eigenvalue_difference_to_dlqr: f64,
    /// Condition number of Ω.
    pub condition_number: f64,
}

/// The run-time controllers and how they came out. Derived from a [`Configuration`] and from nothing
/// else, so that it need not be saved.
///
/// All three models are discretised with a zero-order hold, which is exact for chains of integrators;
/// the paper's forward Euler would leave a bias of T²/2 times the acceleration of the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct CascadeDesign {
    pub(crate) altitude: TrackingLaw<2, 1, { SMALL + 1 }, ALTITUDE_UNKNOWNS>,
    pub(crate) position: TrackingLaw<4, 2, { 2 * SMALL + 1 }, POSITION_UNKNOWNS>,
    pub(crate) attitude: TrackingLaw<6, 3, { 3 * SMALL + 1 }, ATTITUDE_UNKNOWNS>,
    /// Without limits: how fast the loops close.
    pub(crate) altitude_gains: Controller<2, 1, 1>,
    pub(crate) position_gains: Controller<4, 2, 2>,
    pub(crate) attitude_gains: Controller<6, 3, 3>,
    pub(crate) estimator: EstimatorDesign,
    reports: [DesignReport; 3],
}

impl CascadeDesign {
    /// Checks the configuration and designs its three controllers.
    ///
    /// # Errors
    /// Every variant of [`ConfigurationError`] but `Fixed`.
    pub fn new(configuration: &Configuration) -> Result<Self, ConfigurationError> {
        validate(configuration)?;
        let settings = &configuration.controllers;
        let inertia = configuration.believed_inertia_kg_m2().into();
        let hold = Discretization::ZeroOrderHold;
        let kind = settings.kind;
        let altitude = designed(
            "altitude",
            kind,
            &settings.altitude,
            &altitude_limits(&settings.altitude),
            |sample_time| altitude_model(sample_time, hold),
        )?;
        let position = designed(
            "position",
            kind,
            &settings.position,
            &position_limits(&settings.position),
            |sample_time| position_model(sample_time, hold),
        )?;
        // Laguerre MPC goes by the motion of the attitude error, as the regulator does, and leaves the limits of the
        // torques to the mixer: increments from a torque that was cut off would lose the damping that it had
        // asked for, because the rotors answer late, which the model does not know.
        let limits = if kind == ControllerKind::StateSpaceMpc {
            attitude_limits(&settings.attitude)
        } else {
            Vec::new()
        };
        let attitude = designed("attitude", kind, &settings.attitude, &limits, |sample_time| {
            attitude_model(&inertia, sample_time, hold)
        })?;
        let estimator = EstimatorDesign::new(configuration)
            .map_err(|source| ConfigurationError::Design { controller: "estimator of the", source })?;
        Ok(Self {
            altitude: altitude.law,
            position: position.law,
            attitude: attitude.law,
            altitude_gains: altitude.gains,
            position_gains: position.gains,
            attitude_gains: attitude.gains,
            estimator,
            reports: [altitude.report, position.report, attitude.report],
        })
    }

    /// The figures of the three designs, by the controller's name.
    pub fn reports(&self) -> [(&'static str, DesignReport); 3] {
        let [altitude, position, attitude] = self.reports;
        [("altitude", altitude), ("position", position), ("attitude", attitude)]
    }
}

/// One finished controller.
struct Designed<const N: usize, const P: usize, const S: usize, const L: usize> {
    law: TrackingLaw<N, P, S, L>,
    gains: Controller<N, P, P>,
    report: DesignReport,
}

fn designed<const N: usize, const P: usize, const S: usize, const L: usize>(
    name: &'static str,
    kind: ControllerKind,
    settings: &ControllerSettings<P>,
    limits: &[Limit],
    model: impl Fn(f64) -> Result<StateSpace, DesignError>,
) -> Result<Designed<N, P, S, L>, ConfigurationError> {
    let finished = || {
        let design = laguerre_design(settings, model(settings.sample_time_s())?)?;
        let output = design.model().plant().c();
        Ok(Designed {
            law: TrackingLaw::new(kind, settings, &design, limits)?,
            gains: match kind {
                ControllerKind::Lmpc => Controller::from_design(&design, output)?,
                ControllerKind::StateSpaceMpc | ControllerKind::Dlqr => {
                    Controller::new(design.dlqr().gain(), output)?
                }
            },
            report: report(&design)?,
        })
    };
    finished().map_err(|source| ConfigurationError::Design { controller: name, source })
}

fn laguerre_design<const P: usize>(
    settings: &ControllerSettings<P>,
    plant: StateSpace,
) -> Result<LmpcDesign, DesignError> {
    let augmented = Augmented::new(&plant);

    // Q = diag(0, w_rate, …, w_output, …) on [Δx_m; y − r], x_m = [y₁ ẏ₁ y₂ ẏ₂ …]; R = diag(w_increment)
    let mut q = DVector::zeros(augmented.states());
    for channel in 0..P {
        q[2 * channel + 1] = settings.rate_weight[channel];
        q[2 * P + channel] = settings.output_weight[channel];
    }
    let r = DMatrix::from_diagonal(&DVector::from_column_slice(settings.increment_weight.as_slice()));
    let weights = Weights::new(&augmented, DMatrix::from_diagonal(&q), r)?;

    let basis = LaguerreBasis::new(settings.terms as usize, settings.scale)?;
    let bases: [LaguerreBasis; P] = core::array::from_fn(|_| basis.clone());
    let weighting = if settings.alpha > 1.0 {
        Weighting::exponential(settings.alpha, settings.lambda)
    } else {
        Weighting::Terminal { lambda: settings.lambda }
    };
    LmpcDesign::new(&augmented, &weights, &bases, settings.prediction_horizon as usize, weighting)
}

fn report(design: &LmpcDesign) -> Result<DesignReport, DesignError> {
    let augmented = design.model();
    let regulated = augmented.a() - augmented.b() * design.dlqr().gain();
    Ok(DesignReport {
        spectral_radius: design.spectral_radius(),
        eigenvalue_difference_to_dlqr: design.spectral_radius() - spectral_radius("A − BK", &regulated)?,
        condition_number: design.condition_number(),
    })
}
