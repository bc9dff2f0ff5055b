//! The closed loop in its wind.

use nalgebra::{Vector2, Vector3};
use quadrotor::{
    Configuration, ConfigurationError, Disturbance, EasedLimits, Inputs, Outputs, RigidBody, RotorFault,
    Simulation, StabilityWarning,
};

use super::change_error::ChangeError;
use super::foreign_flight::ForeignFlight;
use super::steering::Steering;
use super::tick::TICK_S;
use crate::FlightError;
use crate::designs::design;
use crate::foreign::{ForeignDescription, ForeignModel, ForeignMotion};
use crate::world::{Wind, WindSettings, WindShape};

/// The closed loop and the air around it.
#[derive(Debug)]
pub struct ClosedLoop {
    simulation: Simulation,
    /// What flies in place of our plant or of all of it.
    foreign: Option<ForeignFlight>,
    /// Limits of the references that the vehicle makes.
    limits: EasedLimits,
    wind: Wind,
    wind_m_s: Vector3<f64>,
    /// Those of the latest tick. They are large, and little of them changes.
    inputs: Inputs,
}

/// What a tick of the closed loop depends on beside the steering.
#[derive(Clone, Copy, Debug)]
pub struct Conditions<'a> {
    /// What the vehicle knows of its motion as the tick begins.
    pub outputs: &'a Outputs,
    /// Force, NED, N, and torque, FRD, N·m, from outside, beside that of the wind.
    pub load: (Vector3<f64>, Vector3<f64>),
    /// True height above the ground, m.
    pub height_m: f64,
    /// z of that ground, m.
    pub ground_z_m: f64,
    /// Whether the rotors may turn.
    pub armed: bool,
    /// What is wrong with the rotors.
    pub rotor_faults: [Option<RotorFault>; 4],
    /// The estimate to be flown by, if there is one.
    pub estimate: Option<RigidBody>,
}

impl ClosedLoop {
    /// At rest, disarmed, above ground at this z, m.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn new(
        configuration: &Configuration,
        wind: WindSettings,
        ground_z_m: f64,
    ) -> Result<Self, ConfigurationError> {
        let inputs = Inputs { armed: false, ground_z_m, ..Inputs::default() };
        let simulation = Simulation::prepared(&design(configuration)?, &inputs)?;
        let limits = EasedLimits::new(&configuration.flyable_limits());
        let (wind, wind_m_s) = (Wind::new(wind), Vector3::zeros());
        Ok(Self { simulation, foreign: None, limits, wind, wind_m_s, inputs })
    }

    /// The same with a model from elsewhere, where that starts.
    ///
    /// # Errors
    /// [`FlightError`] if it does not start anywhere.
    pub fn flown_by(mut self, model: Box<dyn ForeignModel>) -> Result<Self, FlightError> {
        self.foreign = Some(ForeignFlight::new(model, &mut self.simulation)?);
        Ok(self)
    }

    /// The engine; beside a closed loop from elsewhere it keeps configuration and motion.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The model from elsewhere, if one flies.
    pub fn foreign(&self) -> Option<&ForeignDescription> {
        self.foreign.as_ref().map(ForeignFlight::description)
    }

    /// What that has shown last.
    pub fn foreign_motion(&self) -> Option<&ForeignMotion> {
        self.foreign.as_ref().map(ForeignFlight::motion)
    }

    /// Whether all of it is from elsewhere, so that our controllers rest.
    fn rests(&self) -> bool {
        self.foreign.as_ref().is_some_and(ForeignFlight::is_closed_loop)
    }

    /// What can be observed now.
    pub fn outputs(&self) -> Outputs {
        match &self.foreign {
            Some(foreign) => foreign.outputs(&self.simulation),
            None => self.simulation.outputs(),
        }
    }

    /// Speeds that our controllers command the rotors to turn with, rad/s, if they fly.
    pub fn rotor_command_rad_s(&self) -> Option<[f64; 4]> {
        (!self.rests()).then(|| self.simulation.rotor_command_rad_s())
    }

    /// What is worth a warning about our controllers, if they fly.
    pub fn stability_warnings(&self) -> &[StabilityWarning] {
        if self.rests() { &[] } else { self.simulation.control().stability().warnings() }
    }

    /// The limits that references keep, and the larger ones that the present motion began with.
    pub fn limits(&self) -> &EasedLimits {
        &self.limits
    }

    /// Lets lower limits hold: the motion can keep them.
    pub fn release_limits(&mut self) {
        self.limits.release();
    }

    /// The wind becomes another one.
    pub fn change_wind(&mut self, settings: WindSettings, shape: WindShape) {
        self.wind.change(settings, shape);
    }

    /// Velocity of the air, NED, m/s.
    pub fn wind_m_s(&self) -> Vector3<f64> {
        self.wind_m_s
    }

    /// The position that is known is elsewhere, m north and east, and the reference with it: nothing has moved.
    pub fn slide(&mut self, slid_m: &Vector2<f64>) {
        if let Err(error) = self.simulation.shift_positions(&Vector3::new(slid_m.x, slid_m.y, 0.0)) {
            tracing::error!(%error, "the estimated place has leapt out of the range of numbers");
        }
    }

    /// Flies on by `duration_us`, as it is steered. What goes on with each tick goes on by one: longer flights are those of what rests.
    ///
    /// # Errors
    /// [`FlightError`]: the flight has left the range of numbers, or the model from elsewhere has failed.
    pub fn step(
        &mut self,
        steering: &mut Steering,
        conditions: &Conditions,
        duration_us: u64,
    ) -> Result<(), FlightError> {
        let time_us = conditions.outputs.time_us;
        let inputs = &mut self.inputs;
        steering.apply(&self.simulation, &self.limits, conditions.outputs, TICK_S, inputs);
        self.wind_m_s = self.wind.velocity_m_s(time_us, conditions.height_m);
        inputs.ground_z_m = conditions.ground_z_m;
        let (force_n, torque_n_m) = conditions.load;
        inputs.disturbance = Disturbance { force_n, torque_n_m, wind_m_s: self.wind_m_s };
        inputs.armed = conditions.armed;
        inputs.estimate = conditions.estimate;
        inputs.rotor_faults = conditions.rotor_faults;
        match &mut self.foreign {
            Some(foreign) => foreign.advance(&mut self.simulation, inputs, &self.limits, duration_us),
            None => Ok(self.simulation.advance_to(time_us + duration_us, inputs)?),
        }
    }

    /// Flies on to a time, µs, as it was asked to last.
    ///
    /// # Errors
    /// [`FlightError`]: the flight has left the range of numbers.
    pub fn go_on(&mut self, time_us: u64) -> Result<(), FlightError> {
        Ok(self.simulation.advance_to(time_us, &self.inputs)?)
    }

    /// Whether our plant flies in air that goes on as it is, within limits that are wanted.
    pub fn is_undisturbed(&self) -> bool {
        self.foreign.is_none() && !self.limits.is_eased() && self.wind.is_steady()
    }

    /// Changes the configuration, on the ground and in flight: see [`Simulation::reconfigure`].
    ///
    /// # Errors
    /// [`ChangeError`]; nothing has changed then.
    pub fn configure(&mut self, configuration: &Configuration) -> Result<(), ChangeError> {
        if let Some(foreign) = &self.foreign {
            foreign.check_change(self.simulation.configuration(), configuration)?;
        }
        self.simulation.reconfigure(configuration)?;
        self.limits.want(&configuration.flyable_limits());
        Ok(())
    }
}
