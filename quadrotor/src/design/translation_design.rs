//! The position and altitude controllers, designed from a configuration.

use lmpc::{
    Augmented, DesignError, Dlqr, LaguerreBasis, SignalLimit, StabilizedDesign, StateSpace, spectral_radius,
};
use nalgebra::SVector;

use crate::control::tracking_law::TrackingLaw;
use crate::design::altitude_limits::altitude_limits;
use crate::design::attitude_response::AttitudeResponse;
use crate::design::capacities::{ALTITUDE_FEW, ALTITUDE_MANY, POSITION_FEW, POSITION_MANY};
use crate::design::cascade_design::DesignReport;
use crate::design::linear_models::{altitude_model_with_lag, position_model_with_attitude};
use crate::design::loop_weights::loop_weights;
use crate::design::position_limits::position_limits;
use crate::{Configuration, ConfigurationError, ControllerSettings};

/// States z, v_z, z̈; input G.
pub(crate) type AltitudeLaw = TrackingLaw<3, 1, ALTITUDE_FEW, ALTITUDE_MANY>;
/// States x, v_x, ẍ, x⃛, y, v_y, ÿ, y⃛; inputs the commanded horizontal accelerations.
pub(crate) type PositionLaw = TrackingLaw<8, 2, POSITION_FEW, POSITION_MANY>;

type Altitude = Stabilized<3, 1, ALTITUDE_FEW, ALTITUDE_MANY>;
type Position = Stabilized<8, 2, POSITION_FEW, POSITION_MANY>;

const PROMPT: AttitudeResponse = AttitudeResponse { natural_frequency_rad_s: 6.5, damping: 0.8 };
/// Bandwidth times delay.
const DELAY_SHARE: f64 = 0.55;

pub(crate) fn altitude_design(configuration: &Configuration) -> Result<Altitude, ConfigurationError> {
    let settings = &configuration.controllers.altitude;
    let limits = altitude_limits();
    let lag_s = configuration.airframe.rotor_time_constant_s;
    let bandwidth = [altitude_bandwidth_rad_s(configuration)].into();
    stabilized("altitude controller", configuration, settings, &bandwidth, &limits, || {
        altitude_model_with_lag(lag_s, settings.sample_time_s())
    })
}

pub(crate) fn position_design(
    configuration: &Configuration,
    response: Option<AttitudeResponse>,
) -> Result<Position, ConfigurationError> {
    let settings = &configuration.controllers.position;
    let response = response.unwrap_or(PROMPT);
    let limits = position_limits(&response);
    let bandwidth = [position_bandwidth_rad_s(configuration, &response); 2].into();
    stabilized("position controller", configuration, settings, &bandwidth, &limits, || {
        position_model_with_attitude(
            response.natural_frequency_rad_s,
            response.damping,
            settings.sample_time_s(),
        )
    })
}

/// Whether all weights are the same in both directions.
pub(crate) fn is_isotropic(settings: &ControllerSettings<2>) -> bool {
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

fn position_bandwidth_rad_s(configuration: &Configuration, response: &AttitudeResponse) -> f64 {
    let delay_s = 2.0 * response.damping / response.natural_frequency_rad_s;
    DELAY_SHARE / (delay_s + configuration.controllers.position.sample_time_s() / 2.0)
}

fn altitude_bandwidth_rad_s(_configuration: &Configuration) -> f64 {
    2.7
}

pub(crate) struct Stabilized<const N: usize, const P: usize, const S: usize, const L: usize> {
    pub(crate) law: TrackingLaw<N, P, S, L>,
    pub(crate) report: DesignReport,
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
            law: TrackingLaw::stabilized(
                configuration.controllers.kind,
                settings,
                &design,
                limits,
                slack_cost,
            )?,
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
