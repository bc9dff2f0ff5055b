//! Flying a closed loop or a plant from elsewhere.

use nalgebra::Vector3;
use quadrotor::{EasedLimits, GRAVITY_M_S2, Inputs, Outputs, PlantState, Simulation, Wrench};

use super::change_error::ChangeError;
use super::motion::{at_rest, wrapped};
use super::reference_guide::ReferenceGuide;
use crate::FlightError;
use crate::foreign::{Demand, ForeignDescription, ForeignModel, ForeignMotion, ForeignRole, drive};

/// The model, and what its motion is completed by.
///
/// A plant is flown by our control loop: the simulation samples and takes its motion in. Beside a closed loop our controllers rest,
/// and the simulation only keeps configuration and motion.
#[derive(Debug)]
pub struct ForeignFlight {
    model: Box<dyn ForeignModel>,
    /// As it has shown itself last.
    motion: ForeignMotion,
    guide: ReferenceGuide,
    acceleration_m_s2: Vector3<f64>,
    thrust_n: Option<f64>,
}

impl ForeignFlight {
    /// Puts the simulation where the model starts.
    ///
    /// # Errors
    /// [`FlightError`] if that is no motion.
    pub fn new(model: Box<dyn ForeignModel>, simulation: &mut Simulation) -> Result<Self, FlightError> {
        let start = model.description().start;
        let state = PlantState {
            body: start.body,
            rotor_speed_rad_s: start.rotor_speed_rad_s.unwrap_or_default(),
            ..simulation.plant_state()
        };
        simulation.place(simulation.time_us(), state)?;
        let (_, _, yaw_rad) = start.body.rotation().euler_angles();
        Ok(Self {
            motion: start,
            guide: ReferenceGuide::new(at_rest(start.body.position_m, yaw_rad)),
            acceleration_m_s2: start.acceleration_m_s2.unwrap_or_default(),
            thrust_n: start.thrust_n.or((model.description().role == ForeignRole::ClosedLoop).then_some(0.0)),
            model,
        })
    }

    /// What flies.
    pub fn description(&self) -> &ForeignDescription {
        self.model.description()
    }

    /// What it has shown last.
    pub fn motion(&self) -> &ForeignMotion {
        &self.motion
    }

    /// Whether it is the whole loop, so that our controllers rest.
    pub fn is_closed_loop(&self) -> bool {
        self.description().role == ForeignRole::ClosedLoop
    }

    /// Flies on by `duration_us`.
    ///
    /// # Errors
    /// [`FlightError`]
    pub fn advance(
        &mut self,
        simulation: &mut Simulation,
        inputs: &Inputs,
        limits: &EasedLimits,
        duration_us: u64,
    ) -> Result<(), FlightError> {
        if self.is_closed_loop() {
            return self.follow(simulation, inputs, limits, duration_us);
        }
        let time_us = simulation.time_us();
        let commanded = simulation.command(inputs)?;
        let (plant, before) = (simulation.plant(), simulation.plant_state());
        let driven = drive(self.model.as_mut(), plant, &before, &commanded, (time_us, duration_us))?;
        self.motion = driven.motion;
        self.acceleration_m_s2 = driven.acceleration_m_s2;
        self.thrust_n = driven.motion.thrust_n;
        Ok(simulation.place(time_us + duration_us, driven.state)?)
    }

    /// Lets a closed loop follow its reference for `duration_us`.
    fn follow(
        &mut self,
        simulation: &mut Simulation,
        inputs: &Inputs,
        limits: &EasedLimits,
        duration_us: u64,
    ) -> Result<(), FlightError> {
        let (time_us, h_s) = (simulation.time_us(), duration_us as f64 / 1e6);
        let demand = self.loop_demand(inputs, time_us, duration_us);
        let motion = self.model.advance(&demand)?;
        self.guide.step(&limits.largest(), h_s, time_us + duration_us);
        let before = simulation.plant_state();
        let change = || (motion.body.velocity_m_s - before.body.velocity_m_s) / h_s;
        self.motion = motion;
        self.acceleration_m_s2 = motion.acceleration_m_s2.unwrap_or_else(change);
        let speeds = motion.rotor_speed_rad_s;
        let rotor_speed_rad_s =
            speeds.unwrap_or_else(|| self.carrying_speeds(simulation, &motion, demand.armed));
        self.thrust_n = motion.thrust_n;
        let state = PlantState { body: motion.body, rotor_speed_rad_s, ..before };
        Ok(simulation.place(time_us + duration_us, state)?)
    }

    /// What a closed loop is told. On the ground its rotors rest where ours would idle: it knows no attitude target.
    fn loop_demand(&mut self, inputs: &Inputs, time_us: u64, duration_us: u64) -> Demand {
        self.guide.ask(inputs, time_us);
        Demand {
            time_us,
            duration_us,
            reference: *self.guide.now(),
            armed: inputs.armed && inputs.attitude_target.is_none(),
            rotor_command_rad_s: [0.0; 4],
            wrench: Wrench::default(),
            wind_m_s: inputs.disturbance.wind_m_s,
            ground_z_m: inputs.ground_z_m,
        }
    }

    /// Speeds of four equal rotors that would give the vehicle its acceleration.
    fn carrying_speeds(&self, simulation: &Simulation, motion: &ForeignMotion, armed: bool) -> [f64; 4] {
        if !armed {
            return [0.0; 4];
        }
        let airframe = simulation.plant().airframe();
        let force_m_s2 = self.acceleration_m_s2 - Vector3::new(0.0, 0.0, GRAVITY_M_S2);
        let thrust_n = motion.thrust_n.unwrap_or(airframe.mass_kg * force_m_s2.norm()).max(0.0);
        [libm::sqrt(thrust_n / (4.0 * airframe.thrust_coefficient_n_s2)); 4]
    }

    /// What can be observed now.
    pub fn outputs(&self, simulation: &Simulation) -> Outputs {
        let mut outputs = simulation.outputs();
        outputs.acceleration_m_s2 = self.acceleration_m_s2;
        if let Some(thrust_n) = self.thrust_n {
            outputs.thrust_n = thrust_n;
        }
        if self.is_closed_loop() {
            outputs.setpoint = *self.guide.now();
            outputs.tracking_error_m = outputs.position_m - outputs.setpoint.position_m;
            outputs.yaw_error_rad = wrapped(outputs.attitude_rad.z - outputs.setpoint.yaw_rad);
            outputs.tilt_reference_rad = [outputs.attitude_rad.x, outputs.attitude_rad.y];
        }
        outputs
    }

    /// Refuses a change of what describes the model and not ours.
    ///
    /// # Errors
    /// [`ChangeError::Foreign`]
    pub fn check_change(
        &self,
        present: &quadrotor::Configuration,
        wanted: &quadrotor::Configuration,
    ) -> Result<(), ChangeError> {
        let controllers = present.controllers != wanted.controllers
            || present.sensors != wanted.sensors
            || present.reference != wanted.reference;
        let part = if present.airframe != wanted.airframe {
            "airframe"
        } else if present.environment != wanted.environment {
            "environment"
        } else if self.is_closed_loop() && controllers {
            "controllers"
        } else {
            return Ok(());
        };
        let ForeignDescription { name, role, .. } = self.description().clone();
        Err(ChangeError::Foreign { model: name, role, part })
    }
}
