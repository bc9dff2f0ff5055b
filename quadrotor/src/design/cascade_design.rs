//! The three controllers of the cascade, designed from a configuration.

use alloc::sync::Arc;

use lmpc::{Augmented, DesignError, LaguerreBasis, LmpcDesign, Weighting, Weights, spectral_radius};

use crate::configuration::validation::validate;
use crate::control::learning::averaging::SampledAveraging;
use crate::control::thrust_lag::ThrustLag;
use crate::design::attitude_design::AttitudeDesign;
use crate::design::attitude_loop::AttitudeLoop;
use crate::design::estimator_design::EstimatorDesign;
use crate::design::translation_design::{
    AltitudeDesign, PositionDesign, altitude_design, is_isotropic, position_design,
};
use crate::{Configuration, ConfigurationError, ControllerSettings, Mixer};

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

impl DesignReport {
    pub(crate) fn of(design: &LmpcDesign) -> Result<Self, DesignError> {
        let augmented = design.model();
        let regulated = augmented.a() - augmented.b() * design.dlqr().gain();
        Ok(Self {
            spectral_radius: design.spectral_radius(),
            eigenvalue_difference_to_dlqr: design.spectral_radius() - spectral_radius("A − BK", &regulated)?,
            condition_number: design.condition_number(),
        })
    }

    /// The larger of each figure, of two designs that make one controller.
    pub(crate) fn worse(&self, other: &Self) -> Self {
        let (one, two) = (self.eigenvalue_difference_to_dlqr, other.eigenvalue_difference_to_dlqr);
        Self {
            spectral_radius: self.spectral_radius.max(other.spectral_radius),
            eigenvalue_difference_to_dlqr: if libm::fabs(two) > libm::fabs(one) { two } else { one },
            condition_number: self.condition_number.max(other.condition_number),
        }
    }
}

/// The run-time controllers and how they came out. Derived from a [`Configuration`] and from nothing
/// else, so that it need not be saved.
///
/// All three models are discretised with a zero-order hold, which is exact for chains of integrators;
/// the paper's forward Euler would leave a bias of T²/2 times the acceleration of the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct CascadeDesign {
    pub(crate) altitude: AltitudeDesign,
    pub(crate) position: PositionDesign,
    pub(crate) attitude: AttitudeDesign,
    /// Whether the position controller does the same in all horizontal directions.
    pub(crate) position_is_isotropic: bool,
    pub(crate) estimator: EstimatorDesign,
    pub(crate) mixer: Mixer,
    pub(crate) thrust_lag: ThrustLag,
    pub(crate) averaging: SampledAveraging,
    reports: [DesignReport; 3],
}

impl CascadeDesign {
    /// Checks the configuration and designs its three controllers.
    ///
    /// # Errors
    /// Every variant of [`ConfigurationError`] but `Fixed`.
    pub fn new(configuration: &Configuration) -> Result<Self, ConfigurationError> {
        validate(configuration)?;
        let mixer = Mixer::new(&configuration.airframe)?;
        let (attitude, attitude_report) = attitude_design(configuration, &mixer)?;
        let altitude = altitude_design(configuration)?;
        let position = position_design(configuration, attitude.closed)?;
        Ok(Self {
            altitude: altitude.0,
            position: position.0,
            attitude,
            position_is_isotropic: is_isotropic(configuration),
            estimator: estimator_design(configuration)?,
            mixer,
            thrust_lag: ThrustLag::of(configuration),
            averaging: SampledAveraging::new(&configuration.controllers.attitude),
            reports: [altitude.1, position.1, attitude_report],
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
        let attitude = redesigned.attitude.then(|| attitude_design(configuration, &mixer)).transpose()?;
        let response = attitude.as_ref().map_or(self.attitude.closed, |(attitude, _)| attitude.closed);
        let altitude = redesigned.altitude.then(|| altitude_design(configuration)).transpose()?;
        let position = redesigned.position.then(|| position_design(configuration, response)).transpose()?;
        let estimator = redesigned.estimator.then(|| estimator_design(configuration)).transpose()?;
        let [altitude_report, position_report, attitude_report] = &mut self.reports;
        if let Some(designed) = altitude {
            (self.altitude, *altitude_report) = designed;
        }
        if let Some(designed) = position {
            (self.position, *position_report) = designed;
        }
        if let Some(designed) = attitude {
            (self.attitude, *attitude_report) = designed;
        }
        if let Some(designed) = estimator {
            self.estimator = designed;
        }
        self.mixer = mixer;
        self.thrust_lag = ThrustLag::of(configuration);
        self.averaging = SampledAveraging::new(&configuration.controllers.attitude);
        self.position_is_isotropic = is_isotropic(configuration);
        Ok(redesigned)
    }

    /// The design of another configuration: this very one where nothing of it differs, else a copy, [redesigned](Self::redesign).
    ///
    /// # Errors
    /// Those of [`CascadeDesign::new`].
    pub(crate) fn adapted(
        this: &Arc<Self>,
        before: &Configuration,
        configuration: &Configuration,
    ) -> Result<Arc<Self>, ConfigurationError> {
        let mut adapted = Self::clone(this);
        adapted.redesign(before, configuration)?;
        Ok(if adapted == **this { Arc::clone(this) } else { Arc::new(adapted) })
    }

    /// The closed loop of roll and pitch; `None` with the paper's models, which take it for instantaneous.
    pub fn attitude_loop(&self) -> Option<AttitudeLoop> {
        self.attitude.closed
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
        let every = before.kind != after.kind || before.model != after.model;
        Self {
            altitude: every
                || before.altitude != after.altitude
                || one.airframe.mean_rotor_lag_s() != other.airframe.mean_rotor_lag_s()
                || one.drag_1_s().z != other.drag_1_s().z,
            position: every
                || before.position != after.position
                || one.drag_1_s().xy() != other.drag_1_s().xy()
                || !AttitudeDesign::is_same(one, other),
            attitude: !AttitudeDesign::is_same(one, other),
            estimator: before.attitude.sample_time_us != after.attitude.sample_time_us
                || one.sensors.position_noise_m != other.sensors.position_noise_m
                || one.sensors.velocity_noise_m_s != other.sensors.velocity_noise_m_s
                || one.sensors.output_feedback != other.sensors.output_feedback
                || one.sensors.attitude_noise_rad != other.sensors.attitude_noise_rad
                || one.sensors.body_rate_noise_rad_s != other.sensors.body_rate_noise_rad_s,
        }
    }
}

/// The figures and the law come together.
fn attitude_design(
    configuration: &Configuration,
    mixer: &Mixer,
) -> Result<(AttitudeDesign, DesignReport), ConfigurationError> {
    AttitudeDesign::new(configuration, mixer)
        .map_err(|source| ConfigurationError::Design { part: "attitude controller", source })
}

fn estimator_design(configuration: &Configuration) -> Result<EstimatorDesign, ConfigurationError> {
    EstimatorDesign::new(configuration)
        .map_err(|source| ConfigurationError::Design { part: "Kalman predictor", source })
}

/// The Laguerre design of a model with finished weights.
pub(crate) fn weighted_design<const P: usize>(
    settings: &ControllerSettings<P>,
    augmented: &Augmented,
    weights: &Weights,
) -> Result<LmpcDesign, DesignError> {
    let basis = LaguerreBasis::new(settings.terms as usize, settings.scale)?;
    let bases: [LaguerreBasis; P] = core::array::from_fn(|_| basis.clone());
    let weighting = if settings.alpha > 1.0 {
        Weighting::exponential(settings.alpha, settings.lambda)
    } else {
        Weighting::Terminal { lambda: settings.lambda }
    };
    LmpcDesign::new(augmented, weights, &bases, settings.prediction_horizon as usize, weighting)
}
