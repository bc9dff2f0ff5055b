//! The attitude controller, designed from a configuration: one law for roll and pitch, one for yaw.

use alloc::vec::Vec;

use lmpc::{DesignError, Limit, LmpcDesign};
use nalgebra::SVector;

use crate::control::tracking_law::TrackingLaw;
use crate::design::attitude_bandwidth::AttitudeBandwidth;
use crate::design::attitude_limits::{lean_limits, turn_limits};
use crate::design::attitude_loop::AttitudeLoop;
use crate::design::capacities::{LEAN_FEW, LEAN_MANY, TURN_FEW, TURN_MANY};
use crate::design::cascade_design::{DesignReport, laguerre_design};
use crate::design::controller_limits::placed;
use crate::design::limited_samples::ATTITUDE;
use crate::design::linear_models::lagged_attitude_model;
use crate::{Airframe, Configuration, ControllerKind, ControllerSettings, Mixer, PredictionModel};

/// States of one axis: angle, rate, and the angular acceleration that the rotors have reached.
pub(crate) const AXIS_STATES: usize = 3;

/// Roll and pitch: φ, φ̇, φ̈ by the rotors, θ, θ̇, θ̈; inputs φ̈, θ̈ as commanded.
pub(crate) type LeanLaw = TrackingLaw<{ 2 * AXIS_STATES }, 2, LEAN_FEW, LEAN_MANY>;
/// Yaw: ψ, ψ̇, ψ̈ by the rotors; input ψ̈ as commanded.
pub(crate) type TurnLaw = TrackingLaw<AXIS_STATES, 1, TURN_FEW, TURN_MANY>;

/// Most times by which a turn is taken to be longer than a lean: beyond it the horizon ends earlier.
const LONGEST_TURN: f64 = 8.0;

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
        let longer = bandwidth.longer.clamp(1.0, LONGEST_TURN);
        let lean_settings = scaled(settings, [0, 1], bandwidth.lean_rad_s, 1.0);
        let turn_settings = scaled(settings, [2], bandwidth.turn_rad_s, longer);

        let lag_s = match controllers.model {
            PredictionModel::InnerLoops => configuration.airframe.rotor_time_constant_s,
            PredictionModel::Paper => 0.0,
        };
        let sample_time_s = settings.sample_time_s();
        let lean = laguerre_design(&lean_settings, lagged_attitude_model(2, lag_s, sample_time_s)?)?;
        let turn = laguerre_design(&turn_settings, lagged_attitude_model(1, lag_s, sample_time_s)?)?;
        let lean_samples = placed(&lean_settings, ATTITUDE);
        let turn_samples = placed(&turn_settings, &later(ATTITUDE, longer));
        let lean_limits = lean_limits(&configuration.airframe, mixer, &lean_samples);
        let closed = match controllers.model {
            PredictionModel::InnerLoops => Some(closed_loop(controllers.kind, &lean, lag_s, sample_time_s)?),
            PredictionModel::Paper => None,
        };
        let report = DesignReport::of(&lean)?.worse(&DesignReport::of(&turn)?);
        let design = Self {
            lean: law(configuration, &lean_settings, &lean, &lean_limits)?,
            turn: law(configuration, &turn_settings, &turn, &turn_limits(&turn_samples))?,
            closing_1_s: bandwidth.lean_rad_s / 2.0,
            closed,
        };
        Ok((design, report))
    }

    /// Whether it goes by the measured motion; else it must be told of disturbances and of what the reference needs.
    pub(crate) fn is_incremental(&self) -> bool {
        self.lean.is_incremental()
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

/// Settings of some axes, with weights for a bandwidth ω, rad/s, and with times that are longer.
fn scaled<const P: usize>(
    settings: &ControllerSettings<3>,
    axes: [usize; P],
    bandwidth_rad_s: f64,
    longer: f64,
) -> ControllerSettings<P> {
    let (t, w) = (settings.sample_time_s(), bandwidth_rad_s);
    let of = |weights: &SVector<f64, 3>, unit: f64| axes.map(|axis| weights[axis] / (unit * unit));
    let output = of(&settings.output_weight, 1.0);
    let rate = of(&settings.rate_weight, t * w * w);
    let increment = of(&settings.increment_weight, t * w * w * w);
    ControllerSettings {
        scale: libm::pow(settings.scale, 1.0 / longer),
        prediction_horizon: libm::ceil(f64::from(settings.prediction_horizon) * longer) as u32,
        ..settings.with_weights(output, rate, increment)
    }
}

/// Samples that lie so many times later, the first of all as it is.
fn later(samples: &[usize], times: f64) -> Vec<usize> {
    samples.iter().map(|sample| libm::round(*sample as f64 * times) as usize).collect()
}

/// The law of a finished design. With the paper's models limits are left to the mixer: increments from a torque that was
/// cut off would lose the damping that it had asked for, because the rotors answer late, which those models do not know.
fn law<const N: usize, const P: usize, const S: usize, const L: usize>(
    configuration: &Configuration,
    settings: &ControllerSettings<P>,
    design: &LmpcDesign,
    limits: &[Limit],
) -> Result<TrackingLaw<N, P, S, L>, DesignError> {
    let controllers = &configuration.controllers;
    match (controllers.model, controllers.kind) {
        (PredictionModel::Paper, ControllerKind::Lmpc) => {
            TrackingLaw::new(controllers.kind, settings, design, &[])
        }
        (PredictionModel::InnerLoops, ControllerKind::Dlqr) => TrackingLaw::by_deviation(design),
        _ => TrackingLaw::new(controllers.kind, settings, design, limits),
    }
}

/// Roll and pitch answer alike unless they have different weights; then the slower one counts.
fn closed_loop(
    kind: ControllerKind,
    lean: &LmpcDesign,
    lag_s: f64,
    sample_time_s: f64,
) -> Result<AttitudeLoop, DesignError> {
    let gain = if kind == ControllerKind::Lmpc { lean.gain() } else { lean.dlqr().gain() };
    let plant = lagged_attitude_model(1, lag_s, sample_time_s)?;
    let axis = |axis: usize| {
        let states = gain.view((axis, axis * AXIS_STATES), (1, AXIS_STATES));
        let mut of_axis = states.into_owned().resize(1, AXIS_STATES + 1, 0.0);
        of_axis[(0, AXIS_STATES)] = gain[(axis, 2 * AXIS_STATES + axis)];
        AttitudeLoop::new(&plant, &of_axis, lag_s, sample_time_s)
    };
    let (roll, pitch) = (axis(0)?, axis(1)?);
    Ok(if pitch.delay_s() > roll.delay_s() { pitch } else { roll })
}
