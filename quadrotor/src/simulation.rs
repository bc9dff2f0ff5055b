//! The closed loop as a deterministic discrete-event simulation.

use nalgebra::Vector3;
use serde::Serialize;

use crate::attitude::wrapped;
use crate::configuration::validation::validate_start_over;
use crate::design::prepared_design::PreparedDesign;
use crate::plant::dynamics::BegunStep;
use crate::schedule::point_after_us;
use crate::sensors::SimulatedSensors;
use crate::simulation_state::{SimulationState, StateInPlace, World};
use crate::{
    CascadeDesign, Configuration, ConfigurationError, ControlLaw, ControlLoop, InputSignal, Inputs, Outputs,
    Plant, PlantInputs, PlantState, PositionReference, RigidBody, Sensors, SimulationError,
};

/// A flight: plant, sensors and control loop on one schedule.
#[derive(Clone, Debug)]
pub struct Simulation {
    plant: Plant,
    control: ControlLoop,
    world: World,
    /// How the plant goes on, if the flight rests between two events.
    course: Option<Course>,
}

/// How the plant goes on from the last event, which is looked at again until the next one. It follows from the rest.
#[derive(Clone, Copy, Debug)]
struct Course {
    /// Where a step ends that nothing shortens, µs.
    point_us: u64,
    is_calm: bool,
    begun: BegunStep,
}

impl PartialEq for Simulation {
    fn eq(&self, other: &Self) -> bool {
        (&self.plant, &self.control, &self.world) == (&other.plant, &other.control, &other.world)
    }
}

impl Simulation {
    /// A flight at time zero, in the configured initial state.
    ///
    /// # Errors
    /// [`ConfigurationError`] when a value is out of range, values contradict one another, or a
    /// controller cannot be designed.
    pub fn new(configuration: &Configuration, inputs: &Inputs) -> Result<Self, ConfigurationError> {
        Self::prepared(&PreparedDesign::new(configuration)?, inputs)
    }

    /// The same, with a finished design, which it shares: for many flights of one vehicle.
    ///
    /// ```
    /// use quadrotor::{Configuration, Inputs, PreparedDesign, Simulation};
    ///
    /// # if !cfg!(feature = "shaper") { return Ok(()); }
    /// let (configuration, inputs) = (Configuration::default(), Inputs::default());
    /// let design = PreparedDesign::new(&configuration)?; // takes a millisecond, a flight with it a microsecond
    /// let mut one = Simulation::prepared(&design, &inputs)?;
    /// one.advance_to(2_000_000, &inputs)?;
    /// let mut other = Simulation::new(&configuration, &inputs)?;
    /// other.advance_to(2_000_000, &inputs)?;
    /// assert_eq!(one.state(), other.state());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ConfigurationError::Measurement`], and [`ConfigurationError::BelowGround`] over the ground of the inputs.
    pub fn prepared(prepared: &PreparedDesign, inputs: &Inputs) -> Result<Self, ConfigurationError> {
        let configuration = prepared.configuration();
        let mut world = World::new(configuration, inputs);
        validate_start_over(configuration, &world.plant.body, inputs.ground_z_m)?;
        let mut sensors = sensors(&configuration.sensors, &mut world);
        let control = ControlLoop::prepared(prepared, &inputs.control(), &mut sensors, 0)?;
        Ok(Self::of(control, world))
    }

    /// A flight that goes on from a saved state of a flight with the same configuration.
    ///
    /// # Errors
    /// As [`Simulation::new`], and [`ConfigurationError::State`].
    pub fn from_state(
        configuration: &Configuration,
        state: SimulationState,
    ) -> Result<Self, ConfigurationError> {
        state.check(configuration, &Plant::new(&configuration.airframe, &configuration.environment))?;
        Self::resumed(&PreparedDesign::new(configuration)?, state)
    }

    /// The same, with a finished design, which it shares.
    ///
    /// # Errors
    /// [`ConfigurationError::State`].
    pub fn resumed(prepared: &PreparedDesign, state: SimulationState) -> Result<Self, ConfigurationError> {
        let resumed = Self::of(ControlLoop::resumed(prepared, state.control)?, state.world);
        state.check(resumed.configuration(), &resumed.plant)?;
        Ok(resumed)
    }

    fn of(control: ControlLoop, world: World) -> Self {
        let configuration = control.configuration();
        let plant = Plant::new(&configuration.airframe, &configuration.environment);
        Self { plant, control, world, course: None }
    }

    /// The configuration.
    pub fn configuration(&self) -> &Configuration {
        self.control.configuration()
    }

    /// The controllers.
    pub fn design(&self) -> &CascadeDesign {
        self.control.design()
    }

    /// The control loop.
    pub fn control(&self) -> &ControlLoop {
        &self.control
    }

    /// The state, to be saved.
    pub fn state(&self) -> SimulationState {
        SimulationState { world: self.world, control: *self.control.state() }
    }

    /// The state, to be written as [`Simulation::state`] is, without a copy of it.
    pub fn state_in_place(&self) -> impl Serialize {
        StateInPlace { world: &self.world, control: self.control.state() }
    }

    /// Goes back, or on, to a saved state of this flight.
    ///
    /// # Errors
    /// [`ConfigurationError::State`]; nothing has changed then.
    pub fn restore(&mut self, state: SimulationState) -> Result<(), ConfigurationError> {
        state.check(self.configuration(), &self.plant)?;
        self.control.restore(state.control)?;
        (self.world, self.course) = (state.world, None);
        Ok(())
    }

    /// Time since the start, µs.
    pub fn time_us(&self) -> u64 {
        self.world.time_us
    }

    /// Whether the plant is known to be within the [range](PlantState::has_diverged) of numbers now: at an event of the engine's schedule,
    /// where it has been looked at, and on a long step, which only a calm plant takes.
    pub fn is_sound(&self) -> bool {
        let World { time_us, event_us, plant, .. } = &self.world;
        let is_calm = || self.plant.is_calm(plant, &self.plant_inputs());
        time_us == event_us || self.course.as_ref().map_or_else(is_calm, |course| course.is_calm)
    }

    /// Changes parameters during the flight, those of the airframe included: a payload is dropped by a change of its mass.
    /// The plant changes now, the control loop at its next sample, at most a millisecond later, as
    /// [`ControlLoop::hand_over`] tells. Only the controllers that depend on the change are designed anew.
    ///
    /// # Errors
    /// [`ConfigurationError::Fixed`] when a parameter that describes the start differs ([`Mutability::Start`](crate::Mutability)),
    /// and those of [`Simulation::new`]; nothing has changed then.
    pub fn reconfigure(&mut self, configuration: &Configuration) -> Result<(), ConfigurationError> {
        let prepared = self.control.prepare(configuration)?;
        let plant = Plant::new(&configuration.airframe, &configuration.environment);
        let present = &self.configuration().controllers;
        if plant != self.plant || !present.has_sample_times_of(&configuration.controllers) {
            // The motion until now was that of the old plant, and led from event to event of the old schedule.
            self.world.plant = self.plant_at(self.world.time_us);
            self.world.event_us = self.world.time_us;
        }
        (self.plant, self.course) = (plant, None);
        self.control.hand_over(prepared);
        Ok(())
    }

    /// An estimate of the place has leapt, and the reference with it: see [`ControlLoop::shift_positions`]. The plant is where it was.
    ///
    /// # Errors
    /// [`SimulationError::InputNotFinite`]; nothing has changed then.
    pub fn shift_positions(&mut self, by_m: &Vector3<f64>) -> Result<(), SimulationError> {
        Ok(self.control.shift_positions(by_m)?)
    }

    /// The law that flies.
    pub fn law(&self) -> ControlLaw {
        self.control.state().law()
    }

    /// Speeds that the rotors are commanded to turn with, in the order of the airframe's layout, rad/s.
    pub fn rotor_command_rad_s(&self) -> [f64; 4] {
        self.control.state().rotor_command_rad_s()
    }

    /// Flies on to `time_us`. However the way there is split into calls, the flight is the same: inputs are
    /// sampled at the events of the engine's own schedule, and an arrival between two events does not
    /// disturb the integration.
    ///
    /// # Errors
    /// [`SimulationError`]; the flight then stands at the last event before it.
    pub fn advance_to(&mut self, time_us: u64, inputs: &impl InputSignal) -> Result<(), SimulationError> {
        self.check_order(time_us)?;
        let mut are_known = false;
        while let Some(next_us) = self.next_event_us(time_us, inputs, &mut are_known)? {
            self.arrive(next_us, self.plant_at(next_us))?;
        }
        self.world.time_us = time_us;
        Ok(())
    }

    /// Refuses a time that has passed.
    pub(crate) fn check_order(&self, time_us: u64) -> Result<(), SimulationError> {
        if time_us < self.world.time_us {
            return Err(SimulationError::Backwards { time_us: self.world.time_us, requested_us: time_us });
        }
        Ok(())
    }

    /// Samples at the last event, if that is due on the way to `time_us`, looks at the inputs as far as they ask for nothing that the plant
    /// must be there for, and returns the next event, to which the plant flies without change of what acts on it. Without one before
    /// `time_us` or there, that is where the flight goes on to. `are_known` becomes whether all later inputs are those that were looked
    /// at last: they need not be looked at while the control loop waits.
    pub(crate) fn next_event_us(
        &mut self,
        time_us: u64,
        inputs: &impl InputSignal,
        are_known: &mut bool,
    ) -> Result<Option<u64>, SimulationError> {
        // The events strictly before the goal; one at the goal belongs to the next call, whose inputs
        // apply from there on.
        if self.world.event_us >= time_us {
            return Ok(None);
        }
        let event_us = self.world.event_us;
        if self.control.next_sample_us() <= event_us && !(*are_known && self.control.waits(event_us)) {
            inputs.with(event_us, |inputs| self.sample(inputs))?;
            *are_known = inputs.is_constant();
        }
        let point_us = self.point_us(time_us);
        let end_us = point_us.min(time_us);
        loop {
            let look_us = self.control.next_sample_us();
            if look_us >= end_us {
                return Ok((point_us <= time_us).then_some(point_us));
            }
            if *are_known && self.control.waits_until(end_us) {
                continue;
            }
            // No integration step crosses a sample of a controller or a change of what acts on the plant, wherever it is interrupted.
            if self.control.is_due(look_us) || !inputs.with(look_us, |inputs| self.look(look_us, inputs))? {
                return Ok(Some(look_us));
            }
            *are_known = inputs.is_constant();
        }
    }

    /// Where a step of the plant from the last event ends that nothing shortens, µs. If that is later than `time_us`, how the plant goes on
    /// is kept until the next event.
    fn point_us(&mut self, time_us: u64) -> u64 {
        if let Some(course) = &self.course {
            return course.point_us;
        }
        let (inputs, World { event_us, plant, .. }) = (self.plant_inputs(), &self.world);
        let is_calm = self.plant.is_calm(plant, &inputs);
        let point_us = point_after_us(*event_us, is_calm);
        if point_us > time_us {
            self.course = Some(Course { point_us, is_calm, begun: self.plant.begin_step(plant, &inputs) });
        }
        point_us
    }

    /// Looks at inputs between two events; whether that is all there is to do, because they do not change what acts on the plant.
    fn look(&mut self, look_us: u64, inputs: &Inputs) -> Result<bool, SimulationError> {
        if !self.world.is_acted_on_as_by(inputs) || !self.control.only_watches(inputs) {
            return Ok(false);
        }
        self.world.time_us = look_us;
        inputs.check(look_us)?;
        if !(inputs.keep_to_a_shaped_reference() && self.control.waits(look_us)) {
            self.control.watch(&inputs.control())?;
        }
        self.world.take(inputs);
        Ok(true)
    }

    /// The next event, with the plant as it is there.
    pub(crate) fn arrive(&mut self, next_us: u64, plant: PlantState) -> Result<(), SimulationError> {
        if plant.has_diverged() {
            let overload = self.world.overload(&self.configuration().airframe);
            return Err(SimulationError::Diverged { time_us: next_us, overload });
        }
        (self.world.plant, self.course) = (plant, None);
        self.world.event_us = next_us;
        self.world.time_us = next_us;
        Ok(())
    }

    /// Goes on to `time_us`, at or before the next event.
    #[cfg(feature = "fleet")]
    pub(crate) fn rest_at(&mut self, time_us: u64) {
        self.world.time_us = time_us;
    }

    /// Time of the last event, µs.
    #[cfg(feature = "fleet")]
    pub(crate) fn event_us(&self) -> u64 {
        self.world.event_us
    }

    /// The equations of the vehicle.
    pub fn plant(&self) -> &Plant {
        &self.plant
    }

    /// Rotors and rigid body now.
    pub fn plant_state(&self) -> PlantState {
        self.plant_at(self.world.time_us)
    }

    /// Rotors and rigid body at the last event.
    #[cfg(feature = "fleet")]
    pub(crate) fn state_at_event(&self) -> &PlantState {
        &self.world.plant
    }

    /// Samples inputs and control loop as [`Simulation::advance_to`] does at an event, and returns what acts on the plant from
    /// there on: for a plant from elsewhere, whose motion [`Simulation::place`] then takes in. Neither is of use in the
    /// middle between two events.
    ///
    /// # Errors
    /// [`SimulationError`]; nothing has changed then.
    pub fn command(&mut self, inputs: &Inputs) -> Result<PlantInputs, SimulationError> {
        if self.control.next_sample_us() <= self.world.event_us {
            self.sample(inputs)?;
        }
        Ok(self.plant_inputs())
    }

    /// Goes on to `time_us`, at which a plant from elsewhere is in this state. That is an event.
    ///
    /// # Errors
    /// [`SimulationError`]; nothing has changed then.
    pub fn place(&mut self, time_us: u64, state: PlantState) -> Result<(), SimulationError> {
        if time_us < self.world.time_us {
            return Err(SimulationError::Backwards { time_us: self.world.time_us, requested_us: time_us });
        }
        if state.has_diverged() {
            return Err(SimulationError::Diverged { time_us, overload: None });
        }
        (self.world.event_us, self.world.time_us, self.world.plant) = (time_us, time_us, state);
        self.course = None;
        Ok(())
    }

    /// What can be observed now.
    pub fn outputs(&self) -> Outputs {
        self.observed(self.control.state().reference(self.world.time_us))
    }

    /// The same without the set-point, which takes long and is seldom wanted: it and the errors are NaN until they are
    /// [completed](Simulation::complete).
    pub fn prompt_outputs(&self) -> Outputs {
        self.observed(PositionReference::UNKNOWN)
    }

    /// Adds set-point and errors to what was observed now without them.
    pub fn complete(&self, outputs: &mut Outputs) {
        outputs.setpoint = self.control.state().reference(self.world.time_us);
        outputs.tracking_error_m = outputs.position_m - outputs.setpoint.position_m;
        outputs.yaw_error_rad = wrapped(outputs.attitude_rad.z - outputs.setpoint.yaw_rad);
    }

    fn observed(&self, setpoint: PositionReference) -> Outputs {
        let (control, time_us) = (self.control.state(), self.world.time_us);
        let plant = self.plant.outputs(&self.plant_at(time_us), &self.plant_inputs());
        Outputs {
            time_us,
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
            tilt_reference_rad: control.tilt_reference_rad(),
            setpoint,
            tracking_error_m: plant.position_m - setpoint.position_m,
            yaw_error_rad: wrapped(plant.attitude_rad.z - setpoint.yaw_rad),
            activity: control.activity(),
            belief: self.control.belief(),
        }
    }

    /// What the controllers take the vehicle's motion for now, unless it is the truth: an estimate from outside, what the
    /// Kalman predictor makes of the measurements while it flies, or the true motion with the noise of the latest
    /// reading.
    pub fn believed_motion(&self) -> Option<RigidBody> {
        let World { time_us, estimate, noise, .. } = &self.world;
        let sensors = &self.configuration().sensors;
        let noisy = || (!sensors.is_exact()).then(|| noise.latest(sensors, &self.plant_at(*time_us).body));
        estimate.or_else(|| self.control.estimated_motion(*time_us)).or_else(noisy)
    }

    /// What acts on the plant since the last event.
    pub(crate) fn plant_inputs(&self) -> PlantInputs {
        self.world.plant_inputs(self.rotor_command_rad_s(), self.control.state().is_armed())
    }

    /// The plant at `time_us`, not before the last event nor after the next.
    pub(crate) fn plant_at(&self, time_us: u64) -> PlantState {
        let World { event_us, plant, .. } = &self.world;
        if time_us == *event_us {
            return *plant;
        }
        let (inputs, h_s) = (self.plant_inputs(), (time_us - event_us) as f64 / 1e6);
        match &self.course {
            Some(course) => self.plant.end_step(&course.begun, &inputs, h_s),
            None => self.plant.step(plant, &inputs, h_s),
        }
    }

    /// Samples the inputs and the control loop at the last event.
    fn sample(&mut self, inputs: &Inputs) -> Result<(), SimulationError> {
        let event_us = self.world.event_us;
        inputs.check(event_us)?;
        // Something else may act on the plant from now on.
        self.course = None;
        if inputs.keep_to_a_shaped_reference() && self.control.waits(event_us) {
            self.world.take(inputs);
            return Ok(());
        }
        // The world is as before if the control loop refuses: only what it changes is copied.
        let (deviations, mut noise) = (self.configuration().sensors, self.world.noise);
        let mut sensors = SimulatedSensors {
            sensors: &deviations,
            noise: &mut noise,
            plant: &self.world.plant,
            estimate: inputs.estimate.as_ref(),
        };
        self.control.advance_to(event_us, &inputs.control(), &mut sensors)?;
        self.world.noise = noise;
        self.world.take(inputs);
        Ok(())
    }
}

/// The sensors on the plant of the last event.
fn sensors<'a>(sensors: &'a Sensors, world: &'a mut World) -> SimulatedSensors<'a> {
    SimulatedSensors {
        sensors,
        noise: &mut world.noise,
        plant: &world.plant,
        estimate: world.estimate.as_ref(),
    }
}
