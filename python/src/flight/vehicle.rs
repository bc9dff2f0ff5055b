//! One vehicle: its engine, its settings and its inputs.

use std::fmt::Display;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use quadrotor::{
    Activity, Belief, ClosedLoopVehicle, Configuration, ConfigurationError, InputSignal, Inputs, Outputs,
    PlantSimulation, PlantState, PositionReference, Simulation, SimulationError,
};

use super::actuation::Actuation;
use super::commands::Commands;
use super::saved::{EngineState, Saved};

/// How many numbers a motion has: position, velocity, quaternion and body rates.
pub const MOTION: usize = 13;
/// Below this length of a quaternion, rounding decides what attitude it is.
const LEAST_NORM: f64 = 1e-6;

/// What flies.
#[derive(Clone)]
enum Engine {
    Loop(Box<Simulation>),
    Plant(Box<PlantSimulation>),
}

/// One vehicle.
#[derive(Clone)]
pub struct Vehicle {
    engine: Engine,
    actuation: Actuation,
    configuration: Configuration,
    /// All inputs: they act from the next advance on.
    pub commands: Commands,
}

fn text(error: impl Display) -> String {
    error.to_string()
}

impl Vehicle {
    /// A vehicle at time zero.
    pub fn new(
        configuration: &Configuration,
        commands: &Commands,
        actuation: Actuation,
    ) -> Result<Self, String> {
        let resolved = configuration.resolved().map_err(text)?;
        let engine = match actuation {
            Actuation::Reference => {
                Engine::Loop(Box::new(Simulation::new(&resolved, &commands.flight).map_err(text)?))
            }
            Actuation::Rates => {
                let initial = PlantState::at_rest(&resolved.initial);
                let inputs = commands.turning(&attitude(&initial), 0.0);
                Engine::Loop(Box::new(Simulation::new(&resolved, &inputs).map_err(text)?))
            }
            Actuation::Rotors => {
                let start = if commands.flight.armed {
                    PlantState::hovering(&resolved.initial, &resolved.airframe)
                } else {
                    PlantState::at_rest(&resolved.initial)
                };
                Engine::Plant(Box::new(
                    PlantSimulation::new(&resolved, &start, &commands.of_plant()).map_err(text)?,
                ))
            }
        };
        Ok(Self { engine, actuation, configuration: *configuration, commands: *commands })
    }

    /// What it is asked for.
    pub fn actuation(&self) -> Actuation {
        self.actuation
    }

    /// Its settings, as they were set.
    pub fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// µs since the start.
    pub fn time_us(&self) -> u64 {
        match &self.engine {
            Engine::Loop(simulation) => simulation.time_us(),
            Engine::Plant(simulation) => simulation.time_us(),
        }
    }

    /// Flies on to a time.
    pub fn advance_to(&mut self, time_us: u64) -> Result<(), SimulationError> {
        let inputs = self.inputs();
        match &mut self.engine {
            Engine::Loop(simulation) => simulation.advance_to(time_us, &inputs),
            Engine::Plant(simulation) => {
                let inputs = self.commands.of_plant();
                simulation.advance_to(time_us, &|_| inputs)
            }
        }
    }

    /// The inputs of its closed loop from now on.
    pub fn inputs(&self) -> Asked {
        match (&self.engine, self.actuation) {
            (Engine::Loop(simulation), Actuation::Rates) => Asked::Turn {
                commands: self.commands,
                from: attitude(&simulation.plant_state()),
                start_us: simulation.time_us(),
            },
            _ => Asked::Flight(self.commands.flight),
        }
    }

    /// What can be observed now. Those of the controllers mean nothing for a plant alone.
    pub fn outputs(&self) -> Outputs {
        match &self.engine {
            Engine::Loop(simulation) => simulation.outputs(),
            Engine::Plant(simulation) => of_plant(simulation),
        }
    }

    /// Changes parameters in flight.
    pub fn reconfigure(&mut self, configuration: &Configuration) -> Result<(), String> {
        if configuration.preset != self.configuration.preset {
            return Err(text(ConfigurationError::Fixed { name: "airframe.preset" }));
        }
        let resolved = configuration.resolved().map_err(text)?;
        match &mut self.engine {
            Engine::Loop(simulation) => simulation.reconfigure(&resolved).map_err(text)?,
            Engine::Plant(simulation) => simulation.reconfigure(&resolved).map_err(text)?,
        }
        self.configuration = *configuration;
        Ok(())
    }

    /// What its user should know about the parameters.
    pub fn warnings(&self) -> Vec<String> {
        match &self.engine {
            Engine::Loop(simulation) => {
                simulation.control().stability().warnings().iter().map(ToString::to_string).collect()
            }
            Engine::Plant(_) => Vec::new(),
        }
    }

    /// Puts the vehicle into another motion, now: x, y, z, velocity, quaternion (scalar first) and body rates.
    pub fn place(&mut self, motion: &[f64; MOTION]) -> Result<(), String> {
        let [x, y, z, u, v, w, q0, q1, q2, q3, p, q, r] = *motion;
        let attitude = Quaternion::new(q0, q1, q2, q3);
        let norm = attitude.norm();
        if let Some(place) = motion.iter().position(|number| !number.is_finite()) {
            return Err(format!("motion[{place}] = {}; expected a finite number", motion[place]));
        }
        if norm < LEAST_NORM {
            return Err(format!(
                "motion[6:10] = [{q0}, {q1}, {q2}, {q3}]; expected a quaternion of length {LEAST_NORM} or more"
            ));
        }
        let placed = |mut state: PlantState| {
            state.body.position_m = Vector3::new(x, y, z);
            state.body.velocity_m_s = Vector3::new(u, v, w);
            state.body.attitude = attitude / norm;
            state.body.body_rate_rad_s = Vector3::new(p, q, r);
            state
        };
        match &mut self.engine {
            Engine::Loop(simulation) => {
                let state = placed(simulation.plant_state());
                simulation.place(simulation.time_us(), state).map_err(|error| format!("motion: {error}"))
            }
            Engine::Plant(simulation) => {
                let state = placed(simulation.plant_state());
                simulation.set_plant_state(&state);
                Ok(())
            }
        }
    }

    /// Everything there is to save.
    pub fn save(&self) -> Saved {
        let engine = match &self.engine {
            Engine::Loop(simulation) => EngineState::Loop(Box::new(simulation.state())),
            Engine::Plant(simulation) => EngineState::Plant(Box::new(simulation.state())),
        };
        Saved {
            actuation: self.actuation,
            configuration: self.configuration,
            commands: self.commands,
            engine,
        }
    }

    /// A vehicle that goes on from a saved state.
    pub fn from_saved(saved: &Saved) -> Result<Self, String> {
        let resolved = saved.configuration.resolved().map_err(text)?;
        let engine = match &saved.engine {
            EngineState::Loop(state) => {
                Engine::Loop(Box::new(Simulation::from_state(&resolved, **state).map_err(text)?))
            }
            EngineState::Plant(state) => {
                Engine::Plant(Box::new(PlantSimulation::from_state(&resolved, **state).map_err(text)?))
            }
        };
        let Saved { actuation, configuration, commands, .. } = *saved;
        Ok(Self { engine, actuation, configuration, commands })
    }

    /// Goes back, or on, to a saved state. The controllers are designed anew only if the parameters differ.
    pub fn restore(&mut self, saved: &Saved) -> Result<(), String> {
        match (&mut self.engine, &saved.engine) {
            (Engine::Loop(simulation), EngineState::Loop(state))
                if self.configuration == saved.configuration && self.actuation == saved.actuation =>
            {
                simulation.restore(**state).map_err(text)?;
                self.commands = saved.commands;
            }
            _ => *self = Self::from_saved(saved)?,
        }
        Ok(())
    }
}

/// What a vehicle with our controllers is asked for.
pub enum Asked {
    /// The same all the time.
    Flight(Inputs),
    /// To turn at the commanded rates, from an attitude that it had at a time, µs.
    Turn { commands: Commands, from: UnitQuaternion<f64>, start_us: u64 },
}

impl InputSignal for Asked {
    fn at(&self, time_us: u64) -> Inputs {
        match self {
            Self::Flight(inputs) => *inputs,
            Self::Turn { commands, from, start_us } => {
                commands.turning(from, time_us.saturating_sub(*start_us) as f64 / 1e6)
            }
        }
    }

    fn with<R>(&self, time_us: u64, look: impl FnOnce(&Inputs) -> R) -> R {
        match self {
            Self::Flight(inputs) => look(inputs),
            Self::Turn { .. } => look(&self.at(time_us)),
        }
    }
}

impl ClosedLoopVehicle for Vehicle {
    fn closed_loop(&self) -> Option<&Simulation> {
        match &self.engine {
            Engine::Loop(simulation) => Some(simulation),
            Engine::Plant(_) => None,
        }
    }

    fn closed_loop_mut(&mut self) -> Option<&mut Simulation> {
        match &mut self.engine {
            Engine::Loop(simulation) => Some(simulation),
            Engine::Plant(_) => None,
        }
    }
}

fn attitude(state: &PlantState) -> UnitQuaternion<f64> {
    state.body.rotation()
}

/// What can be observed of a plant alone.
fn of_plant(simulation: &PlantSimulation) -> Outputs {
    let (plant, airframe) = (simulation.outputs(), simulation.plant().airframe());
    Outputs {
        time_us: simulation.time_us(),
        position_m: plant.position_m,
        velocity_m_s: plant.velocity_m_s,
        acceleration_m_s2: plant.acceleration_m_s2,
        body_velocity_m_s: plant.body_velocity_m_s,
        attitude_rad: plant.attitude_rad,
        quaternion: plant.quaternion,
        body_rate_rad_s: plant.body_rate_rad_s,
        thrust_n: plant.wrench.thrust_n,
        torque_n_m: plant.wrench.torque_n_m,
        rotor_speed_rad_s: plant.rotor_speed_rad_s,
        battery: plant.battery,
        tilt_reference_rad: [0.0; 2],
        setpoint: PositionReference::goal(plant.position_m.into(), plant.attitude_rad.z),
        tracking_error_m: Vector3::zeros(),
        yaw_error_rad: 0.0,
        activity: Activity::default(),
        // No controllers, no error of theirs.
        belief: Belief { mass_kg: airframe.mass_kg, drag_n_s_m: airframe.drag_n_s_m.into() },
    }
}
