//! The loops of the cascade as they are in hover, to compare designs offline.

use alloc::vec::Vec;

use nalgebra::{Vector2, Vector3};

use crate::control::cascade::{most_horizontal, vertical_range};
use crate::design::altitude_limits::altitude_bounds;
use crate::design::attitude_design::{SIGHT_RAD, attitude_problems};
use crate::design::attitude_limits::RotorRoom;
use crate::design::cascade_design::CascadeDesign;
use crate::design::controller_limits::least_thrust_n;
use crate::design::loop_problem::LoopProblem;
use crate::design::position_limits::{Asked, TurnUnderWay, horizon_m, planned_horizon_m, position_bounds};
use crate::design::translation_design::{altitude_problem, position_bandwidth_rad_s, position_problem};
use crate::{Configuration, ConfigurationError, Mixer, commanded_tilt_rad};

/// A loop under the limits that it has in hover.
#[derive(Clone, Debug, PartialEq)]
pub struct HoverLoop<const P: usize> {
    /// Model, weights and limits.
    pub problem: LoopProblem<P>,
    /// Values of the limits, one per row of their directions.
    pub upper: Vec<f64>,
    /// The largest error that the controller plans with, m or rad; more is seen as this much.
    pub sight: f64,
}

/// The loops of a configuration whose models contain the loops inside them.
#[derive(Clone, Debug, PartialEq)]
pub struct HoverLoops {
    /// z, v_z, z̈ with the rotors' lag; input G.
    pub altitude: HoverLoop<1>,
    /// x and its derivatives up to the snap over the closed attitude loop, then those of y. Far goals are not told apart here, and the way
    /// to brake on before one is not limited.
    pub position: HoverLoop<2>,
    /// Roll and pitch, each with its rate and acceleration.
    pub lean: HoverLoop<2>,
    /// Yaw, with its rate and acceleration.
    pub turn: HoverLoop<1>,
}

impl HoverLoops {
    /// Of a configuration with [`PredictionModel::InnerLoops`](crate::PredictionModel::InnerLoops), whatever it has.
    ///
    /// # Errors
    /// Those of [`CascadeDesign::new`].
    pub fn new(configuration: &Configuration) -> Result<Self, ConfigurationError> {
        let mut configuration = *configuration;
        configuration.controllers.model = crate::PredictionModel::InnerLoops;
        let configuration = &configuration;
        let design = CascadeDesign::new(configuration)?;
        let mixer = Mixer::new(&configuration.airframe)?;
        let failed = |part| move |source| ConfigurationError::Design { part, source };
        let (lean, turn) = attitude_problems(configuration, &mixer).map_err(failed("attitude controller"))?;
        let attitude =
            design.attitude_loop().ok_or(lmpc::DesignError::NotFinite { name: "the attitude loop" });
        let position = attitude
            .and_then(|attitude| position_problem(configuration, &attitude))
            .map_err(failed("position controller"))?;
        let altitude = altitude_problem(configuration).map_err(failed("altitude controller"))?;

        let limits = &configuration.limits;
        let room = RotorRoom {
            mixer: &mixer,
            thrust_n: (configuration.airframe.weight_n(), least_thrust_n(configuration, 1.0)),
            other_n_m: Vector3::zeros(),
            inertia_kg_m2: configuration.believed_inertia_kg_m2(),
            believed: configuration.controllers.mass_factor,
        };
        let tilted_m_s2 = most_horizontal(0.0, commanded_tilt_rad(configuration));
        let range = vertical_range(configuration, 1.0);
        let fastest_m_s = limits.speed_up_m_s.max(limits.speed_down_m_s);
        let bandwidth_rad_s = position_bandwidth_rad_s(configuration, design.attitude_loop().as_ref());
        Ok(Self {
            altitude: HoverLoop {
                problem: altitude,
                upper: altitude_bounds(limits, range, 0.0).to_vec(),
                sight: horizon_m(fastest_m_s, range.1.min(-range.0)),
            },
            position: HoverLoop {
                problem: position,
                upper: position_bounds(
                    limits,
                    (tilted_m_s2, tilted_m_s2),
                    &Asked::default(),
                    TurnUnderWay::default(),
                )
                .to_vec(),
                sight: planned_horizon_m(
                    configuration.controllers.kind,
                    limits.speed_horizontal_m_s,
                    tilted_m_s2,
                    bandwidth_rad_s,
                ),
            },
            lean: HoverLoop { problem: lean, upper: room.lean_bounds().to_vec(), sight: SIGHT_RAD },
            turn: HoverLoop {
                problem: turn,
                upper: room.turn_bounds(&Vector2::zeros(), 0.0).to_vec(),
                sight: SIGHT_RAD,
            },
        })
    }
}
