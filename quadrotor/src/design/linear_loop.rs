//! The linear program of one controller, as it flies: to study it without a vehicle.

use alloc::vec::Vec;

use lmpc::{
    Augmented, DesignError, LaguerreBasis, Limit, SignalLimit, StabilizedDesign, StateSpace, Weights,
};
use nalgebra::{DMatrix, SVector, Vector2, Vector3};

use crate::control::tracking_law::plain;
use crate::design::altitude_limits::{altitude_bounds, altitude_limits};
use crate::design::attitude_bandwidth::AttitudeBandwidth;
use crate::design::attitude_design::{AttitudeDesign, LONGEST_TURN, SIGHT_RAD, later, of_axes};
use crate::design::attitude_limits::{RotorRoom, lean_limits, turn_limits};
use crate::design::controller_limits::COMMANDED_TILT_SHARE;
use crate::design::limited_samples::ATTITUDE;
use crate::design::linear_models::{altitude_model_with_lag, lagged_attitude_model};
use crate::design::loop_problem::LoopProblem;
use crate::design::position_limits::{horizon_m, position_bounds, position_limits};
use crate::design::translation_design::{
    SIGHT_M, altitude_bandwidth_rad_s, over_attitude, position_bandwidth_rad_s,
};
use crate::{Configuration, ConfigurationError, ControllerSettings, GRAVITY_M_S2, Mixer};

/// Model, weights, limits and design choices of one controller in hover, with
/// [`PredictionModel::InnerLoops`](crate::PredictionModel). All states of the model are zero at rest at the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearLoop {
    /// The model, sampled; each output is the first state of its channel.
    pub model: StateSpace,
    /// ΔT, s.
    pub sample_time_s: f64,
    /// Q on \[Δx; y − r\] and R on Δu.
    pub weights: Weights,
    /// K_s of [`StabilizedDesign`].
    pub stabilizing_gain: DMatrix<f64>,
    /// What a slack of 1 costs.
    pub slack_cost: f64,
    /// The limits, as [`lmpc::StabilizedMpc`] takes them.
    pub limits: Vec<SignalLimit>,
    /// Their bounds in hover: [`lmpc::Sample::upper`].
    pub upper: Vec<f64>,
    /// The largest error that the controller plans with, m or rad; more is seen as this much.
    pub sight: f64,
    /// N per input.
    pub terms: usize,
    /// a.
    pub scale: f64,
    /// N_p of laws with a finite horizon, samples.
    pub prediction_horizon: usize,
}

impl LinearLoop {
    /// North and east: two inputs, the commanded accelerations, m/s².
    ///
    /// # Errors
    /// [`ConfigurationError::Design`].
    pub fn position(configuration: &Configuration) -> Result<Self, ConfigurationError> {
        let part = "position controller";
        let failed = |source| ConfigurationError::Design { part, source };
        let mixer = Mixer::new(&configuration.airframe)?;
        let (attitude, _) = AttitudeDesign::new(configuration, &mixer).map_err(failed)?;
        let closed =
            attitude.closed.ok_or(failed(DesignError::NotFinite { name: "the closed attitude loop" }))?;
        let settings = &configuration.controllers.position;
        let model = over_attitude(&closed, settings.sample_time_s()).map_err(failed)?;
        let bandwidth = [position_bandwidth_rad_s(configuration, Some(&closed)); 2].into();
        let limits = &configuration.limits;
        let most_m_s2 = GRAVITY_M_S2 * libm::tan(COMMANDED_TILT_SHARE * limits.tilt_rad);
        let upper = position_bounds(limits, most_m_s2, 0.0).to_vec();
        let designed = Self::new(settings, &bandwidth, model, SIGHT_M).map_err(failed)?;
        let sight = horizon_m(limits.speed_horizontal_m_s, most_m_s2);
        Ok(Self { limits: position_limits().to_vec(), upper, sight, ..designed })
    }

    /// Down: one input, the commanded acceleration, m/s².
    ///
    /// # Errors
    /// [`ConfigurationError::Design`].
    pub fn altitude(configuration: &Configuration) -> Result<Self, ConfigurationError> {
        let failed = |source| ConfigurationError::Design { part: "altitude controller", source };
        let settings = &configuration.controllers.altitude;
        let lag_s = configuration.airframe.rotor_time_constant_s;
        let model = altitude_model_with_lag(lag_s, settings.sample_time_s()).map_err(failed)?;
        let bandwidth = [altitude_bandwidth_rad_s(configuration)].into();
        let limits = &configuration.limits;
        let range = (GRAVITY_M_S2 * (1.0 - limits.thrust_max), GRAVITY_M_S2 * (1.0 - limits.thrust_min));
        let upper = altitude_bounds(limits, range, 0.0).to_vec();
        let sight = horizon_m(limits.speed_up_m_s.max(limits.speed_down_m_s), range.1.min(-range.0));
        let designed = Self::new(settings, &bandwidth, model, SIGHT_M).map_err(failed)?;
        Ok(Self { limits: altitude_limits().to_vec(), upper, sight, ..designed })
    }

    /// Roll and pitch: two inputs, the commanded angular accelerations, rad/s².
    ///
    /// # Errors
    /// [`ConfigurationError::Design`].
    pub fn roll_and_pitch(configuration: &Configuration) -> Result<Self, ConfigurationError> {
        let failed = |source| ConfigurationError::Design { part: "attitude controller", source };
        let mixer = Mixer::new(&configuration.airframe)?;
        let settings = of_axes(&configuration.controllers.attitude, [0, 1], 1.0);
        let bandwidth = AttitudeBandwidth::new(configuration, &mixer);
        let lag_s = configuration.airframe.rotor_time_constant_s;
        let model = lagged_attitude_model(2, lag_s, settings.sample_time_s()).map_err(failed)?;
        let designed =
            Self::new(&settings, &[bandwidth.lean_rad_s; 2].into(), model, SIGHT_RAD).map_err(failed)?;
        let limits = lean_limits(&configuration.airframe, &mixer, ATTITUDE).to_vec();
        Ok(Self { limits, upper: in_hover(configuration, &mixer).lean_bounds().to_vec(), ..designed })
    }

    /// Yaw: one input, the commanded angular acceleration, rad/s².
    ///
    /// # Errors
    /// [`ConfigurationError::Design`].
    pub fn yaw(configuration: &Configuration) -> Result<Self, ConfigurationError> {
        let failed = |source| ConfigurationError::Design { part: "attitude controller", source };
        let mixer = Mixer::new(&configuration.airframe)?;
        let bandwidth = AttitudeBandwidth::new(configuration, &mixer);
        let longer = bandwidth.longer.clamp(1.0, LONGEST_TURN);
        let settings = of_axes(&configuration.controllers.attitude, [2], longer);
        let lag_s = configuration.airframe.rotor_time_constant_s;
        let model = lagged_attitude_model(1, lag_s, settings.sample_time_s()).map_err(failed)?;
        let designed =
            Self::new(&settings, &[bandwidth.turn_rad_s].into(), model, SIGHT_RAD).map_err(failed)?;
        let limits = turn_limits(&configuration.airframe, &mixer, &later(ATTITUDE, longer)).to_vec();
        let upper = in_hover(configuration, &mixer).turn_bounds(&Vector2::zeros(), 0.0).to_vec();
        Ok(Self { limits, upper, ..designed })
    }

    /// Without limits.
    fn new<const P: usize>(
        settings: &ControllerSettings<P>,
        bandwidth_rad_s: &SVector<f64, P>,
        model: StateSpace,
        sight: f64,
    ) -> Result<Self, DesignError> {
        let problem = LoopProblem::new(settings, bandwidth_rad_s, Vec::new(), sight, &model)?;
        Ok(Self {
            sample_time_s: settings.sample_time_s(),
            stabilizing_gain: problem.stabilizing_gain(problem.stabilizing_share())?,
            slack_cost: problem.slack_cost(),
            weights: problem.weights().clone(),
            model,
            limits: Vec::new(),
            upper: Vec::new(),
            sight,
            terms: settings.terms as usize,
            scale: settings.scale,
            prediction_horizon: settings.prediction_horizon as usize,
        })
    }

    /// Its design with N = `terms` per input and a = `scale`.
    ///
    /// # Errors
    /// Those of [`StabilizedDesign::new`].
    pub fn design(&self, terms: usize, scale: f64) -> Result<StabilizedDesign, DesignError> {
        let bases: Vec<LaguerreBasis> =
            (0..self.model.inputs()).map(|_| LaguerreBasis::new(terms, scale)).collect::<Result<_, _>>()?;
        let model = Augmented::new(&self.model);
        StabilizedDesign::new(&model, &self.weights, &self.stabilizing_gain, &bases, 1.0)
    }

    /// The same limits for a [`lmpc::StateSpaceMpc`] or [`lmpc::LaguerreMpc`].
    pub fn plain_limits(&self) -> Vec<Limit> {
        self.limits.iter().map(plain).collect()
    }
}

/// The rotors in hover, no other torque being needed.
fn in_hover<'a>(configuration: &Configuration, mixer: &'a Mixer) -> RotorRoom<'a> {
    let weight_n = configuration.airframe.weight_n();
    RotorRoom {
        mixer,
        thrust_n: (weight_n, weight_n),
        other_n_m: Vector3::zeros(),
        inertia_kg_m2: configuration.airframe.inertia_kg_m2.into(),
        believed: 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::LinearLoop;
    use crate::{CascadeDesign, Configuration};

    /// The study has the designs that fly: their spectral radii are those that the cascade reports.
    #[test]
    fn it_is_the_design_that_flies() {
        let configuration = Configuration::default();
        let cascade = CascadeDesign::new(&configuration).expect("a design");
        let radius = |linear: &LinearLoop| {
            linear.design(linear.terms, linear.scale).expect("a design").spectral_radius()
        };
        let position = LinearLoop::position(&configuration).expect("a loop");
        let altitude = LinearLoop::altitude(&configuration).expect("a loop");
        let lean = LinearLoop::roll_and_pitch(&configuration).expect("a loop");
        let turn = LinearLoop::yaw(&configuration).expect("a loop");
        for (part, report) in cascade.reports() {
            let expected = match part {
                "position" => radius(&position),
                "altitude" => radius(&altitude),
                _ => radius(&lean).max(radius(&turn)),
            };
            assert_eq!(report.spectral_radius, expected, "{part}");
        }
        for linear in [position, altitude, lean, turn] {
            let bounds: usize = linear.limits.iter().map(|limit| limit.directions.nrows()).sum();
            assert_eq!(bounds, linear.upper.len());
            assert!(linear.upper.iter().all(|upper| *upper > 0.0));
        }
    }
}
