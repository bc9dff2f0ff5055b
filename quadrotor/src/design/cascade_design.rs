//! The three controllers of the cascade, designed from a configuration.

use alloc::vec::Vec;

use lmpc::{
    Augmented, DesignError, Discretization, Dlqr, LaguerreBasis, Limit, LmpcDesign, SignalLimit, StabilizedDesign, StateFeedback, StateSpace,
    Weighting, Weights, spectral_radius,
};
use nalgebra::{DMatrix, DVector, SVector};

use crate::configuration::validation::validate;
use crate::control::tracking_law::TrackingLaw;
use crate::design::capacities::{
    ALTITUDE_FEW, ALTITUDE_MANY, ATTITUDE_FEW, ATTITUDE_MANY, POSITION_FEW, POSITION_MANY,
};
use crate::design::altitude_limits::altitude_limits;
use crate::design::attitude_response::AttitudeResponse;
use crate::design::controller_limits::attitude_limits;
use crate::design::loop_weights::loop_weights;
use crate::design::position_limits::position_limits;
use crate::design::estimator_design::EstimatorDesign;
use crate::design::linear_models::{altitude_model_with_lag, attitude_model, position_model_with_attitude};
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
    pub(crate) altitude: TrackingLaw<3, 1, ALTITUDE_FEW, ALTITUDE_MANY>,
    pub(crate) position: TrackingLaw<8, 2, POSITION_FEW, POSITION_MANY>,
    pub(crate) attitude: TrackingLaw<6, 3, ATTITUDE_FEW, ATTITUDE_MANY>,
    /// Without limits: how fast the loops close.
    pub(crate) attitude_gains: StateFeedback<6, 3, 3>,
    /// Whether the position controller does the same in all horizontal directions.
    pub(crate) position_is_isotropic: bool,
    pub(crate) estimator: EstimatorDesign,
    pub(crate) mixer: Mixer,
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
            attitude_gains: attitude.gains,
            position_is_isotropic: is_isotropic(&configuration.controllers.position),
            estimator: estimator_design(configuration)?,
            mixer: Mixer::new(&configuration.airframe)?,
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
            (self.altitude, *altitude_report) = (designed.law, designed.report);
        }
        if let Some(designed) = position {
            (self.position, *position_report) = (designed.law, designed.report);
        }
        if let Some(designed) = attitude {
            (self.attitude, self.attitude_gains, *attitude_report) =
                (designed.law, designed.gains, designed.report);
        }
        if let Some(designed) = estimator {
            self.estimator = designed;
        }
        self.mixer = mixer;
        self.position_is_isotropic = is_isotropic(&configuration.controllers.position);
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
            altitude: kind || before.altitude != after.altitude || one.airframe != other.airframe,
            position: kind || before.position != after.position || before.attitude != after.attitude || one.airframe != other.airframe,
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

type Altitude = Stabilized<3, 1, ALTITUDE_FEW, ALTITUDE_MANY>;
type Position = Stabilized<8, 2, POSITION_FEW, POSITION_MANY>;
type Attitude = Designed<6, 3, ATTITUDE_FEW, ATTITUDE_MANY>;

fn altitude_design(configuration: &Configuration) -> Result<Altitude, ConfigurationError> {
    let settings = &configuration.controllers.altitude;
    let limits = altitude_limits();
    let lag_s = configuration.airframe.rotor_time_constant_s;
    let bandwidth = [altitude_bandwidth_rad_s(configuration)].into();
    stabilized("altitude controller", configuration, settings, &bandwidth, &limits, || {
        altitude_model_with_lag(lag_s, settings.sample_time_s())
    })
}

fn position_design(configuration: &Configuration) -> Result<Position, ConfigurationError> {
    let settings = &configuration.controllers.position;
    let response = attitude_response(configuration);
    let limits = position_limits(&response);
    let bandwidth = [position_bandwidth_rad_s(configuration); 2].into();
    stabilized("position controller", configuration, settings, &bandwidth, &limits, || {
        position_model_with_attitude(
            response.natural_frequency_rad_s,
            response.damping,
            settings.sample_time_s(),
        )
    })
}

/// Whether all weights are the same in both directions.
fn is_isotropic(settings: &ControllerSettings<2>) -> bool {
    let same = |weights: &SVector<f64, 2>| weights[0] == weights[1];
    same(&settings.output_weight)
        && same(&settings.damping_weight)
        && same(&settings.rate_weight)
        && same(&settings.increment_weight)
}

/// Error of the output, m, the cost of which stands for that of a violated limit.
const SIGHT_M: f64 = 20.0;
/// What a violation by a limit's whole relaxation costs, as a multiple of that.
const VIOLATION: f64 = 1e3;
/// Bandwidth of the feedback about which plans are made, as a share of the controller's.
const STABILIZING_SHARE: f64 = 0.3;

fn attitude_response(_configuration: &Configuration) -> AttitudeResponse {
    AttitudeResponse { natural_frequency_rad_s: 6.5, damping: 0.8 }
}

fn position_bandwidth_rad_s(configuration: &Configuration) -> f64 {
    attitude_response(configuration).natural_frequency_rad_s * 0.37
}

fn altitude_bandwidth_rad_s(_configuration: &Configuration) -> f64 {
    2.7
}

struct Stabilized<const N: usize, const P: usize, const S: usize, const L: usize> {
    law: TrackingLaw<N, P, S, L>,
    report: DesignReport,
}

fn stabilized<const N: usize, const P: usize, const S: usize, const L: usize>(
    name: &'static str,
    configuration: &Configuration,
    settings: &ControllerSettings<P>,
    bandwidth_rad_s: &SVector<f64, P>,
    limits: &[SignalLimit],
    model: impl Fn() -> Result<StateSpace, DesignError>,
) -> Result<Stabilized<N, P, S, L>, ConfigurationError> {
    let finished = || {
        let augmented = Augmented::new(&model()?);
        let weights = loop_weights(&augmented, settings, bandwidth_rad_s)?;
        let slow = loop_weights(&augmented, settings, &(bandwidth_rad_s * STABILIZING_SHARE))?;
        let stabilizing = Dlqr::new(augmented.a(), augmented.b(), slow.q(), slow.r(), settings.lambda)?;
        let basis = LaguerreBasis::new(settings.terms as usize, settings.scale)?;
        let bases: [LaguerreBasis; P] = core::array::from_fn(|_| basis.clone());
        let design =
            StabilizedDesign::new(&augmented, &weights, stabilizing.gain(), &bases, settings.lambda)?;
        let output = design.dlqr().cost()[(N, N)];
        let slack_cost = VIOLATION * output * SIGHT_M * SIGHT_M;
        Ok(Stabilized {
            law: TrackingLaw::stabilized(configuration.controllers.kind, settings, &design, limits, slack_cost)?,
            report: DesignReport {
                spectral_radius: design.spectral_radius(),
                eigenvalue_difference_to_dlqr: design.spectral_radius()
                    - spectral_radius("A − BK", &(augmented.a() - augmented.b() * design.dlqr().gain()))?,
                condition_number: design.condition_number(),
            },
        })
    };
    finished().map_err(|source| ConfigurationError::Design { part: name, source })
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
