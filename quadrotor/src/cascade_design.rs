//! The three controllers of the cascade, designed from a configuration.

use lmpc::{
    Augmented, Controller, DesignError, Discretization, LaguerreBasis, LmpcDesign, StateSpace, Weighting,
    Weights, spectral_radius,
};
use nalgebra::{DMatrix, DVector};

use crate::linear_models::{altitude_model, attitude_model, position_model};
use crate::validation::validate;
use crate::{Configuration, ConfigurationError, ControllerSettings};

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
    pub(crate) altitude: Controller<2, 1, 1>,
    pub(crate) position: Controller<4, 2, 2>,
    pub(crate) attitude: Controller<6, 3, 3>,
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
        // The controllers see the body that they believe in: inertia grows with mass.
        let inertia = configuration.airframe.inertia_kg_m2.map(|j| j * settings.mass_factor);
        let hold = Discretization::ZeroOrderHold;
        let (altitude, altitude_report) =
            designed("altitude", &settings.altitude, |sample_time| altitude_model(sample_time, hold))?;
        let (position, position_report) =
            designed("position", &settings.position, |sample_time| position_model(sample_time, hold))?;
        let (attitude, attitude_report) = designed("attitude", &settings.attitude, |sample_time| {
            attitude_model(&inertia, sample_time, hold)
        })?;
        Ok(Self {
            altitude,
            position,
            attitude,
            reports: [altitude_report, position_report, attitude_report],
        })
    }

    /// The figures of the three designs, by the controller's name.
    pub fn reports(&self) -> [(&'static str, DesignReport); 3] {
        let [altitude, position, attitude] = self.reports;
        [("altitude", altitude), ("position", position), ("attitude", attitude)]
    }
}

fn designed<const N: usize, const P: usize>(
    name: &'static str,
    settings: &ControllerSettings<P>,
    model: impl Fn(f64) -> Result<StateSpace, DesignError>,
) -> Result<(Controller<N, P, P>, DesignReport), ConfigurationError> {
    design(settings, model).map_err(|source| ConfigurationError::Design { controller: name, source })
}

fn design<const N: usize, const P: usize>(
    settings: &ControllerSettings<P>,
    model: impl Fn(f64) -> Result<StateSpace, DesignError>,
) -> Result<(Controller<N, P, P>, DesignReport), DesignError> {
    let plant = model(settings.sample_time_s())?;
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
    let design =
        LmpcDesign::new(&augmented, &weights, &bases, settings.prediction_horizon as usize, weighting)?;

    let regulated = augmented.a() - augmented.b() * design.dlqr().gain();
    let report = DesignReport {
        spectral_radius: design.spectral_radius(),
        eigenvalue_difference_to_dlqr: design.spectral_radius() - spectral_radius("A − BK", &regulated)?,
        condition_number: design.condition_number(),
    };
    Ok((Controller::from_design(&design, plant.c())?, report))
}
