//! Flying a closed loop or a plant from elsewhere.

use nalgebra::Vector3;
use quadrotor::{
    Actuation, EasedLimits, GRAVITY_M_S2, Inputs, Outputs, PlantInputs, PlantState, Simulation, Wrench,
};

use super::change_error::ChangeError;
use super::motion::{at_rest, wrapped};
use super::reference_guide::ReferenceGuide;
use crate::FlightError;
use crate::foreign::{Demand, ForeignDescription, ForeignModel, ForeignMotion, ForeignRole};

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
            ..*simulation.plant_state()
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
        let (time_us, h_s) = (simulation.time_us(), duration_us as f64 / 1e6);
        let before = *simulation.plant_state();
        let (demand, rotors) = match self.description().role {
            ForeignRole::Plant => self.plant_demand(simulation, inputs, duration_us)?,
            ForeignRole::ClosedLoop => (self.loop_demand(inputs, time_us, duration_us), before),
        };
        let motion = self.model.advance(&demand)?;
        self.motion = motion;
        self.guide.step(&limits.largest(), h_s, time_us + duration_us);
        self.acceleration_m_s2 = motion
            .acceleration_m_s2
            .unwrap_or_else(|| (motion.body.velocity_m_s - before.body.velocity_m_s) / h_s);
        let rotor_speed_rad_s = match (motion.rotor_speed_rad_s, self.description().role) {
            (Some(speeds), _) => speeds,
            (None, ForeignRole::Plant) => rotors.rotor_speed_rad_s,
            (None, ForeignRole::ClosedLoop) => self.carrying_speeds(simulation, &motion, demand.armed),
        };
        self.thrust_n = motion.thrust_n;
        let state = PlantState { body: motion.body, rotor_speed_rad_s, discharge: rotors.discharge };
        Ok(simulation.place(time_us + duration_us, state)?)
    }

    /// What our control loop asks of a plant, and how its rotors would follow.
    fn plant_demand(
        &self,
        simulation: &mut Simulation,
        inputs: &Inputs,
        duration_us: u64,
    ) -> Result<(Demand, PlantState), FlightError> {
        let commanded = simulation.command(inputs)?;
        let (plant, before) = (simulation.plant(), simulation.plant_state());
        let after = plant.step(before, &commanded, duration_us as f64 / 1e6);
        let rotor_command_rad_s = match commanded.actuation {
            Actuation::RotorSpeeds(command_rad_s) => command_rad_s,
            Actuation::Wrench(_) => [0.0; 4],
        };
        let demand = Demand {
            time_us: simulation.time_us(),
            duration_us,
            reference: *self.guide.now(),
            armed: inputs.armed,
            rotor_command_rad_s,
            wrench: mean_wrench(simulation, &commanded, &after),
            wind_m_s: inputs.disturbance.wind_m_s,
        };
        Ok((demand, after))
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

/// The mean of thrust and torques at the beginning and the end of a step in which the rotors follow their commands.
fn mean_wrench(simulation: &Simulation, inputs: &PlantInputs, after: &PlantState) -> Wrench {
    let (plant, before) = (simulation.plant(), simulation.plant_state());
    let end = PlantState { body: before.body, ..*after };
    let (begin, end) = (plant.wrench(before, inputs), plant.wrench(&end, inputs));
    Wrench {
        thrust_n: (begin.thrust_n + end.thrust_n) / 2.0,
        torque_n_m: (begin.torque_n_m + end.torque_n_m) / 2.0,
    }
}
