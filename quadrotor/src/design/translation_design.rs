//! The position and altitude controllers, designed from a configuration.

use lmpc::{DesignError, Discretization, StateSpace};
use nalgebra::{DMatrix, SVector, Vector1, Vector2};

use crate::control::observed_motion::MotionModel;
use crate::control::tracking_law::TrackingLaw;
use crate::design::altitude_limits::altitude_limits;
use crate::design::attitude_loop::AttitudeLoop;
use crate::design::braking_way::braking_limits;
use crate::design::capacities::{ALTITUDE_FEW, ALTITUDE_MANY, POSITION_FEW, POSITION_MANY};
use crate::design::cascade_design::DesignReport;
use crate::design::linear_models::{altitude_model, altitude_model_with_lag, double_integrators};
use crate::design::loop_problem::LoopProblem;
use crate::design::position_limits::{
    POSITION_SIGNALS, POSITION_STATES, first_answered, first_moving, position_limits,
};
use crate::design::printed_design::printed_design;
use crate::design::stabilized_law::StabilizedLaw;
use crate::{Configuration, ConfigurationError, ControllerKind, PredictionModel};

/// Bandwidth of position times the delay of the attitude and of the sampling.
const DELAY_SHARE: f64 = 0.62;
/// Bandwidths with the models as printed, rad/s, which leave the delays of the vehicle room.
const PRINTED_POSITION_RAD_S: f64 = 1.8;
const PRINTED_ALTITUDE_RAD_S: f64 = 2.7;

/// A law, and the model by which it sees the motion; by measured increments without one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TranslationDesign<const N: usize, const P: usize, const S: usize, const L: usize> {
    pub(crate) law: TrackingLaw<N, P, S, L>,
    pub(crate) motion: Option<MotionModel<N, P>>,
}

/// States z, v_z, z̈; input G.
pub(crate) type AltitudeDesign = TranslationDesign<3, 1, ALTITUDE_FEW, ALTITUDE_MANY>;
/// That of the position.
pub(crate) type PositionLaw = TrackingLaw<POSITION_STATES, 2, POSITION_FEW, POSITION_MANY>;
/// States x, ẋ, ẍ, x⃛, the snap that the rotors make and the one that they are asked for, then those of y; inputs the commanded
/// horizontal accelerations.
pub(crate) type PositionDesign = TranslationDesign<POSITION_STATES, 2, POSITION_FEW, POSITION_MANY>;

/// The model of Laguerre MPC, whose kicks limits cut off.
fn by_motion<const N: usize, const P: usize>(
    kind: ControllerKind,
    (model, drag_1_s): (&StateSpace, &SVector<f64, P>),
    sample_time_s: f64,
) -> Result<Option<MotionModel<N, P>>, DesignError> {
    (kind == ControllerKind::Lmpc).then(|| MotionModel::new(model, drag_1_s, sample_time_s)).transpose()
}

/// The altitude controller and the figures of its design.
pub(crate) fn altitude_design(
    configuration: &Configuration,
) -> Result<(AltitudeDesign, DesignReport), ConfigurationError> {
    let controllers = &configuration.controllers;
    let settings = &controllers.altitude;
    let sample_time_s = settings.sample_time_s();
    let designed = || match controllers.model {
        PredictionModel::InnerLoops => {
            let problem = altitude_problem(configuration)?;
            let (law, report) = StabilizedLaw::new(controllers.kind, &problem)?.law_and_report();
            let motion = by_motion(
                controllers.kind,
                (problem.model().plant(), &Vector1::new(configuration.drag_1_s().z)),
                sample_time_s,
            )?;
            Ok((TranslationDesign { law, motion }, report))
        }
        PredictionModel::Paper => {
            let model = altitude_model(sample_time_s, Discretization::ZeroOrderHold)?;
            let bandwidth = [PRINTED_ALTITUDE_RAD_S].into();
            let (design, law) = printed_design(controllers.kind, settings, &bandwidth, &model)?;
            Ok((TranslationDesign { law, motion: None }, DesignReport::of(&design)?))
        }
    };
    designed().map_err(|source| ConfigurationError::Design { part: "altitude controller", source })
}

/// The position controller over a closed attitude loop, or on (15) if there is none, and the figures of its design.
pub(crate) fn position_design(
    configuration: &Configuration,
    attitude: Option<AttitudeLoop>,
) -> Result<(PositionDesign, DesignReport), ConfigurationError> {
    let controllers = &configuration.controllers;
    let settings = &controllers.position;
    let sample_time_s = settings.sample_time_s();
    let designed = || match attitude {
        Some(attitude) => {
            let problem =
                position_problem(configuration, &attitude)?.also_within(braking_limits(sample_time_s));
            let (law, report) = StabilizedLaw::new(controllers.kind, &problem)?.law_and_report();
            if law.moved_signals() > POSITION_SIGNALS {
                return Err(DesignError::Dimension {
                    name: "limited signals on all samples",
                    expected: (POSITION_SIGNALS, 1),
                    actual: (law.moved_signals(), 1),
                });
            }
            let motion = by_motion(
                controllers.kind,
                (problem.model().plant(), &configuration.drag_1_s().xy()),
                sample_time_s,
            )?;
            Ok((TranslationDesign { law, motion }, report))
        }
        None => {
            // Inputs are the accelerations −g θ and g φ.
            let model = double_integrators(&[1.0; 2], sample_time_s, Discretization::ZeroOrderHold)?;
            let bandwidth = [position_bandwidth_rad_s(configuration, None); 2].into();
            let (design, law) = printed_design(controllers.kind, settings, &bandwidth, &model)?;
            Ok((TranslationDesign { law, motion: None }, DesignReport::of(&design)?))
        }
    };
    designed().map_err(|source| ConfigurationError::Design { part: "position controller", source })
}

/// What the altitude controller minimizes, on the model with the rotors' lag.
pub(crate) fn altitude_problem(configuration: &Configuration) -> Result<LoopProblem<1>, DesignError> {
    let settings = &configuration.controllers.altitude;
    let lag_s = configuration.airframe.mean_rotor_lag_s();
    let model = altitude_model_with_lag(lag_s, configuration.drag_1_s().z, settings.sample_time_s())?;
    let bandwidth = [ALTITUDE_RAD_S].into();
    Ok(LoopProblem::new(settings, &bandwidth, altitude_limits(settings.sample_time_s()), SIGHT_M, &model)?
        .planned_about(ALTITUDE_STABILIZING_SHARE))
}

/// What the position controller minimizes, over a closed attitude loop.
pub(crate) fn position_problem(
    configuration: &Configuration,
    attitude: &AttitudeLoop,
) -> Result<LoopProblem<2>, DesignError> {
    let settings = &configuration.controllers.position;
    let model = over_attitude(attitude, &configuration.drag_1_s().xy(), settings.sample_time_s())?;
    let bandwidth = [position_bandwidth_rad_s(configuration, Some(attitude)); 2].into();
    let (delay_s, sample_time_s) = (attitude.delay_s(), settings.sample_time_s());
    let firsts = (
        first_answered(delay_s, sample_time_s),
        first_moving(configuration.controllers.kind, delay_s, sample_time_s),
    );
    let limits = position_limits(sample_time_s, firsts);
    Ok(LoopProblem::new(settings, &bandwidth, limits, SIGHT_M, &model)?
        .planned_about(POSITION_STABILIZING_SHARE))
}

/// Whether weights and drag are the same in both directions.
pub(crate) fn is_isotropic(configuration: &Configuration) -> bool {
    let settings = &configuration.controllers.position;
    let same = |weights: &SVector<f64, 2>| weights[0] == weights[1];
    same(&configuration.drag_1_s().xy())
        && same(&settings.output_weight)
        && same(&settings.damping_weight)
        && same(&settings.rate_weight)
        && same(&settings.increment_weight)
}

/// At which the altitude loop closes with weights of 1, rad/s: rotors of all airframes are fast beside it.
const ALTITUDE_RAD_S: f64 = 2.7;
/// Bandwidths of the feedback about which is planned, as shares of the controller's: those at which costs depend least on N and a.
const ALTITUDE_STABILIZING_SHARE: f64 = 0.2;
const POSITION_STABILIZING_SHARE: f64 = 0.45;
/// Error of the output, m, the cost of which stands for that of a violated limit.
pub(crate) const SIGHT_M: f64 = 20.0;

/// Both directions over the closed attitude loop, with their drag per mass, 1/s.
pub(crate) fn over_attitude(
    attitude: &AttitudeLoop,
    drag_1_s: &Vector2<f64>,
    sample_time_s: f64,
) -> Result<StateSpace, DesignError> {
    let north = attitude.under_position(drag_1_s.x, sample_time_s)?;
    let east = attitude.under_position(drag_1_s.y, sample_time_s)?;
    let both = |block: fn(&StateSpace) -> &DMatrix<f64>| {
        let size = block(&north).shape();
        let mut both = DMatrix::zeros(2 * size.0, 2 * size.1);
        both.view_mut((0, 0), size).copy_from(block(&north));
        both.view_mut(size, size).copy_from(block(&east));
        both
    };
    StateSpace::new(both(StateSpace::a), both(StateSpace::b), both(StateSpace::c))
}

/// At which the position loop closes with weights of 1, rad/s, over a closed attitude loop or with the models as printed.
pub(crate) fn position_bandwidth_rad_s(
    configuration: &Configuration,
    attitude: Option<&AttitudeLoop>,
) -> f64 {
    let Some(attitude) = attitude else { return PRINTED_POSITION_RAD_S };
    DELAY_SHARE / (attitude.delay_s() + configuration.controllers.position.sample_time_s() / 2.0)
}

#[cfg(test)]
mod tests {
    use crate::design::position_limits::POSITION_SIGNALS;
    use crate::{CascadeDesign, Configuration};

    /// All of the room for signals is taken by default, and it is enough for other sample times and rotors.
    #[test]
    fn there_is_room_for_each_signal() {
        let signals = |sample_time_us: u64, rotor_time_constant_s: f64| {
            let mut configuration = Configuration::default();
            configuration.controllers.position.sample_time_us = sample_time_us;
            configuration.airframe.rotor_time_constant_s = rotor_time_constant_s;
            CascadeDesign::new(&configuration).expect("a design").position.law.moved_signals()
        };
        assert_eq!(signals(50_000, 0.03), POSITION_SIGNALS);
        for sample_time_us in [10_000, 20_000, 40_000, 60_000, 80_000, 100_000, 150_000] {
            for rotor_time_constant_s in [0.01, 0.1] {
                let signals = signals(sample_time_us, rotor_time_constant_s);
                assert!((1..=POSITION_SIGNALS).contains(&signals), "{sample_time_us} µs: {signals}");
            }
        }
    }
}
