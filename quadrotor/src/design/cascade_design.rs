//! The three controllers of the cascade, designed from a configuration.

use alloc::vec::Vec;

use lmpc::{
    Augmented, DesignError, Discretization, LaguerreBasis, Limit, LmpcDesign, StateFeedback, StateSpace,
    Weighting, Weights, spectral_radius,
};
use nalgebra::{DMatrix, DVector, Vector3};

use crate::configuration::validation::validate;
use crate::control::tracking_law::TrackingLaw;
use crate::design::capacities::{
    ALTITUDE_FEW, ALTITUDE_MANY, ATTITUDE_FEW, ATTITUDE_MANY, POSITION_FEW, POSITION_MANY,
};
use crate::design::controller_limits::{altitude_limits, attitude_limits, position_limits};
use crate::design::estimator_design::EstimatorDesign;
use crate::design::linear_models::{altitude_model, attitude_model, position_model};
use crate::{Configuration, ConfigurationError, ControllerKind, ControllerSettings, Mixer};

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
    pub(crate) altitude: TrackingLaw<2, 1, ALTITUDE_FEW, ALTITUDE_MANY>,
    pub(crate) position: TrackingLaw<4, 2, POSITION_FEW, POSITION_MANY>,
    pub(crate) attitude: TrackingLaw<6, 3, ATTITUDE_FEW, ATTITUDE_MANY>,
    /// Without limits: how fast the loops close.
    pub(crate) altitude_gains: StateFeedback<2, 1, 1>,
    pub(crate) position_gains: StateFeedback<4, 2, 2>,
    pub(crate) attitude_gains: StateFeedback<6, 3, 3>,
    pub(crate) estimator: EstimatorDesign,
    pub(crate) mixer: Mixer,
    /// Moments of inertia that the attitude controller was designed for, kg·m².
    pub(crate) inertia_kg_m2: Vector3<f64>,
    reports: [DesignReport; 3],
}

impl CascadeDesign {
    /// Checks the configuration and designs its three controllers.
    ///
    /// # Errors
    /// Every variant of [`ConfigurationError`] but `Fixed`.
    pub fn new(configuration: &Configuration) -> Result<Self, ConfigurationError> {
        validate(configuration)?;
        let altitude = altitude_design(configuration)?;
        let position = position_design(configuration)?;
        let attitude = attitude_design(configuration)?;
        Ok(Self {
            altitude: altitude.law,
            position: position.law,
            attitude: attitude.law,
            altitude_gains: altitude.gains,
            position_gains: position.gains,
            attitude_gains: attitude.gains,
            estimator: estimator_design(configuration)?,
            mixer: Mixer::new(&configuration.airframe)?,
            inertia_kg_m2: configuration.believed_inertia_kg_m2(),
            reports: [altitude.report, position.report, attitude.report],
        })
    }

    /// Checks another configuration and designs anew what differs from the one that this was designed for: the result is
    /// that of [`CascadeDesign::new`]. Limits are values at each sample and no part of a design.
    ///
    /// # Errors
    /// Those of [`CascadeDesign::new`]; nothing has changed then.
    pub fn redesign(
        &mut self,
        before: &Configuration,
        configuration: &Configuration,
    ) -> Result<Redesigned, ConfigurationError> {
        validate(configuration)?;
        let mixer = Mixer::new(&configuration.airframe)?;
        let redesigned = Redesigned::between(before, configuration);
        let altitude = redesigned.altitude.then(|| altitude_design(configuration)).transpose()?;
        let position = redesigned.position.then(|| position_design(configuration)).transpose()?;
        let attitude = redesigned.attitude.then(|| attitude_design(configuration)).transpose()?;
        let estimator = redesigned.estimator.then(|| estimator_design(configuration)).transpose()?;
        let [altitude_report, position_report, attitude_report] = &mut self.reports;
        if let Some(designed) = altitude {
            (self.altitude, self.altitude_gains, *altitude_report) =
                (designed.law, designed.gains, designed.report);
        }
        if let Some(designed) = position {
            (self.position, self.position_gains, *position_report) =
                (designed.law, designed.gains, designed.report);
        }
        if let Some(designed) = attitude {
            (self.attitude, self.attitude_gains, *attitude_report) =
                (designed.law, designed.gains, designed.report);
        }
        if let Some(designed) = estimator {
            self.estimator = designed;
        }
        self.mixer = mixer;
        self.inertia_kg_m2 = configuration.believed_inertia_kg_m2();
        Ok(redesigned)
    }

    /// The figures of the three designs, by the controller's name.
    pub fn reports(&self) -> [(&'static str, DesignReport); 3] {
        let [altitude, position, attitude] = self.reports;
        [("altitude", altitude), ("position", position), ("attitude", attitude)]
    }
}

/// What a change of the configuration has redesigned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Redesigned {
    /// The altitude controller.
    pub altitude: bool,
    /// The position controller.
    pub position: bool,
    /// The attitude controller.
    pub attitude: bool,
    /// The Kalman predictor.
    pub estimator: bool,
}

impl Redesigned {
    /// What each design depends on, all of it in one place.
    fn between(one: &Configuration, other: &Configuration) -> Self {
        let (before, after) = (&one.controllers, &other.controllers);
        let kind = before.kind != after.kind;
        Self {
            altitude: kind || before.altitude != after.altitude,
            position: kind || before.position != after.position,
            attitude: kind
                || before.attitude != after.attitude
                || one.believed_inertia_kg_m2() != other.believed_inertia_kg_m2(),
            estimator: before.attitude.sample_time_us != after.attitude.sample_time_us
                || one.sensors.position_noise_m != other.sensors.position_noise_m
                || one.sensors.attitude_noise_rad != other.sensors.attitude_noise_rad,
        }
    }
}

/// One finished controller.
struct Designed<const N: usize, const P: usize, const S: usize, const L: usize> {
    law: TrackingLaw<N, P, S, L>,
    gains: StateFeedback<N, P, P>,
    report: DesignReport,
}

type Altitude = Designed<2, 1, ALTITUDE_FEW, ALTITUDE_MANY>;
type Position = Designed<4, 2, POSITION_FEW, POSITION_MANY>;
type Attitude = Designed<6, 3, ATTITUDE_FEW, ATTITUDE_MANY>;

fn altitude_design(configuration: &Configuration) -> Result<Altitude, ConfigurationError> {
    let settings = &configuration.controllers;
    let limits = altitude_limits(&settings.altitude);
    designed("altitude controller", settings.kind, &settings.altitude, &limits, |sample_time| {
        altitude_model(sample_time, Discretization::ZeroOrderHold)
    })
}

fn position_design(configuration: &Configuration) -> Result<Position, ConfigurationError> {
    let settings = &configuration.controllers;
    let limits = position_limits(&settings.position);
    designed("position controller", settings.kind, &settings.position, &limits, |sample_time| {
        position_model(sample_time, Discretization::ZeroOrderHold)
    })
}

fn attitude_design(configuration: &Configuration) -> Result<Attitude, ConfigurationError> {
    let settings = &configuration.controllers;
    let inertia = configuration.believed_inertia_kg_m2().into();
    // Laguerre MPC goes by the motion of the attitude error, as the regulator does, and leaves the limits of the
    // torques to the mixer: increments from a torque that was cut off would lose the damping that it had
    // asked for, because the rotors answer late, which the model does not know.
    let limits = if settings.kind == ControllerKind::StateSpaceMpc {
        attitude_limits(&settings.attitude)
    } else {
        Vec::new()
    };
    designed("attitude controller", settings.kind, &settings.attitude, &limits, |sample_time| {
        attitude_model(&inertia, sample_time, Discretization::ZeroOrderHold)
    })
}

fn estimator_design(configuration: &Configuration) -> Result<EstimatorDesign, ConfigurationError> {
    EstimatorDesign::new(configuration)
        .map_err(|source| ConfigurationError::Design { part: "Kalman predictor", source })
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
        Ok(Designed {
            law: TrackingLaw::new(kind, settings, &design, limits)?,
            gains: match kind {
                ControllerKind::Lmpc => StateFeedback::from_design(&design)?,
                ControllerKind::StateSpaceMpc | ControllerKind::Dlqr => {
                    StateFeedback::new(design.dlqr().gain())?
                }
            },
            report: report(&design)?,
        })
    };
    finished().map_err(|source| ConfigurationError::Design { part: name, source })
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
