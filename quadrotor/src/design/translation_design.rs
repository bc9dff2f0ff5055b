//! The position and altitude controllers, designed from a configuration.

use lmpc::{
    Augmented, DesignError, Discretization, Dlqr, LaguerreBasis, SignalLimit, StabilizedDesign, StateSpace,
    spectral_radius,
};
use nalgebra::{DMatrix, SVector};

use crate::control::tracking_law::TrackingLaw;
use crate::design::altitude_limits::altitude_limits;
use crate::design::attitude_loop::AttitudeLoop;
use crate::design::capacities::{ALTITUDE_FEW, ALTITUDE_MANY, POSITION_FEW, POSITION_MANY};
use crate::design::cascade_design::DesignReport;
use crate::design::linear_models::{altitude_model, altitude_model_with_lag, double_integrators};
use crate::design::loop_weights::loop_weights;
use crate::design::position_limits::{POSITION_STATES, position_limits};
use crate::design::printed_design::printed_design;
use crate::{Configuration, ConfigurationError, ControllerKind, ControllerSettings, PredictionModel};

/// States z, v_z, z̈; input G.
pub(crate) type AltitudeLaw = TrackingLaw<3, 1, ALTITUDE_FEW, ALTITUDE_MANY>;
/// States x, ẋ, ẍ, x⃛, the snap that the rotors make and the one that they are asked for, then those of y; inputs the commanded horizontal accelerations.
pub(crate) type PositionLaw = TrackingLaw<POSITION_STATES, 2, POSITION_FEW, POSITION_MANY>;

/// Bandwidth of position times the delay of the attitude and of the sampling.
const DELAY_SHARE: f64 = 0.62;
/// Bandwidths with the models as printed, rad/s, which leave the delays of the vehicle room.
const PRINTED_POSITION_RAD_S: f64 = 1.8;
const PRINTED_ALTITUDE_RAD_S: f64 = 2.7;

/// The altitude controller and the figures of its design.
pub(crate) fn altitude_design(
    configuration: &Configuration,
) -> Result<(AltitudeLaw, DesignReport), ConfigurationError> {
    let controllers = &configuration.controllers;
    let settings = &controllers.altitude;
    let sample_time_s = settings.sample_time_s();
    let designed = || match controllers.model {
        PredictionModel::InnerLoops => {
            let lag_s = configuration.airframe.rotor_time_constant_s;
            let model = altitude_model_with_lag(lag_s, sample_time_s)?;
            let bandwidth = [altitude_bandwidth_rad_s(configuration)].into();
            stabilized(controllers.kind, settings, &bandwidth, &altitude_limits(), &model)
        }
        PredictionModel::Paper => {
            let model = altitude_model(sample_time_s, Discretization::ZeroOrderHold)?;
            let bandwidth = [PRINTED_ALTITUDE_RAD_S].into();
            let (design, law) = printed_design(controllers.kind, settings, &bandwidth, &model)?;
            Ok((law, DesignReport::of(&design)?))
        }
    };
    designed().map_err(|source| ConfigurationError::Design { part: "altitude controller", source })
}

/// The position controller over a closed attitude loop, or on (15) if there is none, and the figures of its design.
pub(crate) fn position_design(
    configuration: &Configuration,
    attitude: Option<AttitudeLoop>,
) -> Result<(PositionLaw, DesignReport), ConfigurationError> {
    let controllers = &configuration.controllers;
    let settings = &controllers.position;
    let sample_time_s = settings.sample_time_s();
    let designed = || match attitude {
        Some(attitude) => {
            let axis = attitude.under_position(sample_time_s)?;
            let both = |block: &DMatrix<f64>| DMatrix::<f64>::identity(2, 2).kronecker(block);
            let model = StateSpace::new(both(axis.a()), both(axis.b()), both(axis.c()))?;
            let bandwidth = [position_bandwidth_rad_s(configuration, &attitude); 2].into();
            stabilized(controllers.kind, settings, &bandwidth, &position_limits(), &model)
        }
        None => {
            // Inputs are the accelerations −g θ and g φ.
            let model = double_integrators(&[1.0; 2], sample_time_s, Discretization::ZeroOrderHold)?;
            let bandwidth = [PRINTED_POSITION_RAD_S; 2].into();
            let (design, law) = printed_design(controllers.kind, settings, &bandwidth, &model)?;
            Ok((law, DesignReport::of(&design)?))
        }
    };
    designed().map_err(|source| ConfigurationError::Design { part: "position controller", source })
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

fn position_bandwidth_rad_s(configuration: &Configuration, attitude: &AttitudeLoop) -> f64 {
    DELAY_SHARE / (attitude.delay_s() + configuration.controllers.position.sample_time_s() / 2.0)
}

fn altitude_bandwidth_rad_s(_configuration: &Configuration) -> f64 {
    2.7
}

/// A law about a stabilizing feedback, under limits, and the figures of its design.
fn stabilized<const N: usize, const P: usize, const S: usize, const L: usize>(
    kind: ControllerKind,
    settings: &ControllerSettings<P>,
    bandwidth_rad_s: &SVector<f64, P>,
    limits: &[SignalLimit],
    model: &StateSpace,
) -> Result<(TrackingLaw<N, P, S, L>, DesignReport), DesignError> {
    let augmented = Augmented::new(model);
    let weights = loop_weights(&augmented, settings, bandwidth_rad_s)?;
    let slow = loop_weights(&augmented, settings, &(bandwidth_rad_s * STABILIZING_SHARE))?;
    let stabilizing = Dlqr::new(augmented.a(), augmented.b(), slow.q(), slow.r(), settings.lambda)?;
    let basis = LaguerreBasis::new(settings.terms as usize, settings.scale)?;
    let bases: [LaguerreBasis; P] = core::array::from_fn(|_| basis.clone());
    let design = StabilizedDesign::new(&augmented, &weights, stabilizing.gain(), &bases, settings.lambda)?;
    let of_output = design.dlqr().cost()[(N, N)];
    let slack_cost = VIOLATION * of_output * SIGHT_M * SIGHT_M;
    let law = TrackingLaw::stabilized(kind, settings, &design, limits, slack_cost)?;
    let regulated = augmented.a() - augmented.b() * design.dlqr().gain();
    let report = DesignReport {
        spectral_radius: design.spectral_radius(),
        eigenvalue_difference_to_dlqr: design.spectral_radius() - spectral_radius("A − BK", &regulated)?,
        condition_number: design.condition_number(),
    };
    Ok((law, report))
}
