//! The closed loop in its wind.

use nalgebra::Vector3;
use quadrotor::{
    Configuration, ConfigurationError, Disturbance, EasedLimits, Inputs, Outputs, RigidBody, RotorFault,
    Simulation, SimulationError,
};

use super::steering::Steering;
use crate::world::{Wind, WindSettings};

/// The closed loop and the air around it.
#[derive(Debug)]
pub struct ClosedLoop {
    simulation: Simulation,
    /// Limits of the references that the vehicle makes.
    limits: EasedLimits,
    wind: Wind,
    wind_m_s: Vector3<f64>,
}

/// What a tick of the closed loop depends on beside the steering.
#[derive(Clone, Copy, Debug)]
pub struct Conditions<'a> {
    /// What the vehicle knows of its motion as the tick begins.
    pub outputs: &'a Outputs,
    /// True height above the ground, m.
    pub height_m: f64,
    /// Whether the rotors may turn.
    pub armed: bool,
    /// What is wrong with the rotors.
    pub rotor_faults: [Option<RotorFault>; 4],
    /// The estimate to be flown by, if there is one.
    pub estimate: Option<RigidBody>,
}

impl ClosedLoop {
    /// At rest, disarmed.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn new(configuration: &Configuration, wind: WindSettings) -> Result<Self, ConfigurationError> {
        let inputs = Inputs { armed: false, ..Inputs::default() };
        let simulation = Simulation::new(configuration, &inputs)?;
        let limits = EasedLimits::new(&configuration.flyable_limits());
        Ok(Self { simulation, limits, wind: Wind::new(wind), wind_m_s: Vector3::zeros() })
    }

    /// The engine.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The limits that references keep, and the larger ones that the present motion began with.
    pub fn limits(&self) -> &EasedLimits {
        &self.limits
    }

    /// Lets lower limits hold: the motion can keep them.
    pub fn release_limits(&mut self) {
        self.limits.release();
    }

    /// Velocity of the air, NED, m/s.
    pub fn wind_m_s(&self) -> Vector3<f64> {
        self.wind_m_s
    }

    /// Flies on by `duration_us`, as it is steered.
    ///
    /// # Errors
    /// [`SimulationError`]: the flight has left the range of numbers.
    pub fn step(
        &mut self,
        steering: &mut Steering,
        conditions: &Conditions,
        duration_us: u64,
    ) -> Result<(), SimulationError> {
        let time_us = conditions.outputs.time_us;
        let dt_s = duration_us as f64 / 1e6;
        let asked = steering.apply(&self.simulation, &self.limits, conditions.outputs, dt_s);
        self.wind_m_s = self.wind.velocity_m_s(time_us, conditions.height_m);
        let inputs = Inputs {
            disturbance: Disturbance { wind_m_s: self.wind_m_s, ..Disturbance::default() },
            armed: conditions.armed,
            estimate: conditions.estimate,
            rotor_faults: conditions.rotor_faults,
            ..asked
        };
        self.simulation.advance_to(time_us + duration_us, &inputs)
    }

    /// Changes the configuration, on the ground and in flight: see [`Simulation::reconfigure`].
    ///
    /// # Errors
    /// [`ConfigurationError`]; nothing has changed then.
    pub fn configure(&mut self, configuration: &Configuration) -> Result<(), ConfigurationError> {
        self.simulation.reconfigure(configuration)?;
        self.limits.want(&configuration.flyable_limits());
        Ok(())
    }
}
