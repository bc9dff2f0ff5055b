//! The attitude controller, designed from a configuration: one law for roll and pitch, one for yaw.

use alloc::vec::Vec;

use lmpc::{Augmented, DesignError, ModelIncrement, StateSpace};
use nalgebra::{DMatrix, SVector};

use crate::control::tracking_law::TrackingLaw;
use crate::design::attitude_bandwidth::AttitudeBandwidth;
use crate::design::attitude_limits::{lean_limits, turn_limits};
use crate::design::attitude_loop::AttitudeLoop;
use crate::design::capacities::{LEAN_FEW, LEAN_MANY, TURN_FEW, TURN_MANY};
use crate::design::cascade_design::{DesignReport, weighted_design};
use crate::design::limited_samples::ATTITUDE;
use crate::design::linear_models::lagged_attitude_model;
use crate::design::loop_problem::LoopProblem;
use crate::design::loop_weights::loop_weights;
use crate::design::stabilized_law::StabilizedLaw;
use crate::{Airframe, Configuration, ControllerKind, ControllerSettings, Mixer, PredictionModel};

/// States of one axis: angle, rate, and the angular acceleration that the rotors have reached.
pub(crate) const AXIS_STATES: usize = 3;

/// Roll and pitch: φ, φ̇, φ̈ by the rotors, θ, θ̇, θ̈; inputs φ̈, θ̈ as commanded.
pub(crate) type LeanLaw = TrackingLaw<{ 2 * AXIS_STATES }, 2, LEAN_FEW, LEAN_MANY>;
/// Yaw: ψ, ψ̇, ψ̈ by the rotors; input ψ̈ as commanded.
pub(crate) type TurnLaw = TrackingLaw<AXIS_STATES, 1, TURN_FEW, TURN_MANY>;

/// Most times by which a turn is taken to be longer than a lean: beyond it the horizon ends earlier.
const LONGEST_TURN: f64 = 8.0;

/// Error of the attitude, rad, the cost of which stands for that of a violated limit: upside down.
pub(crate) const SIGHT_RAD: f64 = core::f64::consts::PI;

/// The laws of the attitude controller.
///
/// Roll and pitch come before yaw: they are decided under the thrusts of all rotors, and yaw under what they leave. The
/// vehicle flies by where its thrust points; its heading can wait.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AttitudeDesign {
    pub(crate) lean: LeanLaw,
    pub(crate) turn: TurnLaw,
    /// Rate per error with which small leans are closed, 1/s: half of the bandwidth.
    pub(crate) closing_1_s: f64,
    /// Largest angular acceleration of roll and pitch in hover, rad/s².
    pub(crate) available_rad_s2: f64,
    /// How far ahead limits are kept, s, by the laws of lean and of turn.
    pub(crate) sight_s: [f64; 2],
    /// The motion of one axis by its model, which stands for the measured one; `None` with the paper's models, which do not know
    /// why the vehicle answers late.
    pub(crate) motion: Option<ModelIncrement<AXIS_STATES, 1>>,
    /// The closed loop of roll and pitch; with the paper's models nobody needs it.
    pub(crate) closed: Option<AttitudeLoop>,
}

impl AttitudeDesign {
    /// From the airframe and the settings of the controllers, with the figures of the design.
    pub(crate) fn new(
        configuration: &Configuration,
        mixer: &Mixer,
    ) -> Result<(Self, DesignReport), DesignError> {
        let controllers = &configuration.controllers;
        let settings = &controllers.attitude;
        let bandwidth = AttitudeBandwidth::new(configuration, mixer);
        let longer = longer_turn(&bandwidth);
        let sample_time_s = settings.sample_time_s();
        let kind = controllers.kind;
        let closing_1_s = bandwidth.lean_rad_s / 2.0;
        let available_rad_s2 = bandwidth.available_rad_s2;
        let last = ATTITUDE.iter().copied().max().unwrap_or(0) as f64;
        let sight_s = [last * sample_time_s, last * longer * sample_time_s];
        match controllers.model {
            PredictionModel::InnerLoops => {
                let lag_s = configuration.airframe.mean_rotor_lag_s();
                let axis = lagged_attitude_model(1, lag_s, sample_time_s)?;
                let (lean, turn) = attitude_problems(configuration, mixer)?;
                let lean = StabilizedLaw::new(kind, &lean)?;
                let turn = StabilizedLaw::new(kind, &turn)?;
                let design = Self {
                    lean: lean.law,
                    turn: turn.law,
                    closing_1_s,
                    available_rad_s2,
                    sight_s,
                    motion: Some(ModelIncrement::new(&axis)?),
                    closed: Some(closed_loop(&axis, &lean.gain, lag_s, sample_time_s)?),
                };
                Ok((design, lean.report.worse(&turn.report)))
            }
            PredictionModel::Paper => {
                let (lean, lean_report) = prompt_law(
                    kind,
                    &of_axes(settings, [0, 1], 1.0),
                    &[bandwidth.lean_rad_s; 2].into(),
                    &lagged_attitude_model(2, 0.0, sample_time_s)?,
                )?;
                let (turn, turn_report) = prompt_law(
                    kind,
                    &of_axes(settings, [2], longer),
                    &[bandwidth.turn_rad_s].into(),
                    &lagged_attitude_model(1, 0.0, sample_time_s)?,
                )?;
                let design =
                    Self { lean, turn, closing_1_s, available_rad_s2, sight_s, motion: None, closed: None };
                Ok((design, lean_report.worse(&turn_report)))
            }
        }
    }

    /// Whether it goes by the measured motion; else it must be told of disturbances and of what the reference needs.
    pub(crate) fn is_incremental(&self) -> bool {
        self.motion.is_none() && !self.lean.sees_deviation_alone()
    }

    /// What the design depends on is the same.
    pub(crate) fn is_same(one: &Configuration, other: &Configuration) -> bool {
        let depends = |configuration: &Configuration| {
            let controllers = &configuration.controllers;
            let airframe = Airframe { drag_n_s_m: [0.0; 3], ..configuration.airframe };
            (airframe, controllers.kind, controllers.model, controllers.attitude)
        };
        depends(one) == depends(other)
    }
}

/// What the laws of roll and pitch, and of yaw, minimize, on models with the rotors' lag.
pub(crate) fn attitude_problems(
    configuration: &Configuration,
    mixer: &Mixer,
) -> Result<(LoopProblem<2>, LoopProblem<1>), DesignError> {
    let settings = &configuration.controllers.attitude;
    let bandwidth = AttitudeBandwidth::new(configuration, mixer);
    let longer = longer_turn(&bandwidth);
    let airframe = &configuration.airframe;
    let (lag_s, sample_time_s) = (airframe.mean_rotor_lag_s(), settings.sample_time_s());
    let lean = LoopProblem::new(
        &of_axes(settings, [0, 1], 1.0),
        &[bandwidth.lean_rad_s; 2].into(),
        lean_limits(airframe, mixer, ATTITUDE),
        SIGHT_RAD,
        &lagged_attitude_model(2, lag_s, sample_time_s)?,
    )?;
    let turn = LoopProblem::new(
        &of_axes(settings, [2], longer),
        &[bandwidth.turn_rad_s].into(),
        turn_limits(airframe, mixer, &later(ATTITUDE, longer)),
        SIGHT_RAD,
        &lagged_attitude_model(1, lag_s, sample_time_s)?,
    )?;
    Ok((lean, turn))
}

fn longer_turn(bandwidth: &AttitudeBandwidth) -> f64 {
    bandwidth.longer.clamp(1.0, LONGEST_TURN)
}

/// Settings of some axes, with times that are longer: α and λ say what is left after a sample. a follows by half, for its first moves have
/// to be as fast: that is where the costs about yaw depend least on it.
fn of_axes<const P: usize>(
    settings: &ControllerSettings<3>,
    axes: [usize; P],
    longer: f64,
) -> ControllerSettings<P> {
    let of = |weights: &SVector<f64, 3>| axes.map(|axis| weights[axis]);
    let weights = [&settings.output_weight, &settings.rate_weight, &settings.increment_weight].map(of);
    let [output, rate, increment] = weights;
    ControllerSettings {
        scale: libm::pow(settings.scale, 1.0 / libm::sqrt(longer)),
        alpha: libm::pow(settings.alpha, 1.0 / longer),
        lambda: libm::pow(settings.lambda, 1.0 / longer),
        prediction_horizon: libm::ceil(f64::from(settings.prediction_horizon) * longer) as u32,
        damping_weight: of(&settings.damping_weight).into(),
        ..settings.with_weights(output, rate, increment)
    }
}

/// Samples that lie so many times later, the first of all as it is.
fn later(samples: &[usize], times: f64) -> Vec<usize> {
    samples.iter().map(|sample| libm::round(*sample as f64 * times) as usize).collect()
}

/// The law on a model whose rotors answer at once, as the paper has it: without limits, which are left to the mixer. Increments
/// from a torque that was cut off would lose the damping that it had asked for, because the rotors answer late, which this model
/// does not know.
fn prompt_law<const N: usize, const P: usize, const S: usize, const L: usize>(
    kind: ControllerKind,
    settings: &ControllerSettings<P>,
    bandwidth_rad_s: &SVector<f64, P>,
    plant: &StateSpace,
) -> Result<(TrackingLaw<N, P, S, L>, DesignReport), DesignError> {
    let augmented = Augmented::new(plant);
    let weights = loop_weights(&augmented, settings, bandwidth_rad_s)?;
    let design = weighted_design(settings, &augmented, &weights)?;
    Ok((TrackingLaw::new(kind, settings, &design, &weights)?, DesignReport::of(&design)?))
}

/// Roll and pitch answer alike unless they have different weights; then the slower one counts.
fn closed_loop(
    axis: &StateSpace,
    gain: &DMatrix<f64>,
    lag_s: f64,
    sample_time_s: f64,
) -> Result<AttitudeLoop, DesignError> {
    let of = |index: usize| {
        let states = gain.view((index, index * AXIS_STATES), (1, AXIS_STATES));
        let mut of_axis = states.into_owned().resize(1, AXIS_STATES + 1, 0.0);
        of_axis[(0, AXIS_STATES)] = gain[(index, 2 * AXIS_STATES + index)];
        AttitudeLoop::new(axis, &of_axis, lag_s, sample_time_s)
    };
    let (roll, pitch) = (of(0)?, of(1)?);
    Ok(if pitch.delay_s() > roll.delay_s() { pitch } else { roll })
}
