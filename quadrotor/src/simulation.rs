//! The closed loop as a deterministic discrete-event simulation.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::attitude::wrapped;
use crate::configuration::validation::only_tunables_differ;
use crate::control::cascade::Cascade;
use crate::control::estimator::Command;
use crate::control::observer::{Observation, Observer};
use crate::control::recovery::Recovery;
use crate::guidance::reference_guidance::Guidance;
use crate::plant::dynamics::Plant;
use crate::schedule::{next_event_us, ticks};
use crate::{
    AttitudeTarget, CascadeDesign, Configuration, ConfigurationError, Disturbance, InputSignal, Inputs,
    Outputs, PositionReference, RigidBody, RotorFault, SimulationError,
};

/// Everything that changes during a flight, and all there is to save and restore.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulationState {
    /// The present, µs after the start.
    time_us: u64,
    /// The last event, at or before the present: the state below is the one there.
    event_us: u64,
    /// Whether the controllers have sampled at the last event.
    sampled: bool,
    plant: Plant,
    disturbance: Disturbance,
    armed: bool,
    guidance: Guidance,
    observer: Observer,
    cascade: Cascade,
    /// Flown instead of the reference while there is one.
    attitude_target: Option<AttitudeTarget>,
    /// Whether reference and controllers take over the vehicle anew at the next sample.
    engage: bool,
}

impl SimulationState {
    /// Whether a flight can have been in this state: saved states may come from anywhere.
    fn check(&self, configuration: &Configuration) -> Result<(), ConfigurationError> {
        // Nine thousand years: what is added to it below does not overflow.
        const LATEST_US: u64 = u64::MAX / 64;
        let wrong = |reason| Err(ConfigurationError::State { reason });
        if self.time_us > LATEST_US || self.event_us > self.time_us {
            return wrong("its last event lies in the future");
        }
        if self.time_us > next_event_us(configuration, self.event_us) {
            return wrong("its last event is not the last");
        }
        if !self.plant.is_finite() {
            return wrong("its plant is not finite");
        }
        if !self.attitude_target.is_none_or(|target| target.is_finite()) {
            return wrong("its attitude target is not finite");
        }
        Ok(())
    }

    /// Runs the cascade along a reference: the position, altitude and attitude controllers whose clocks tick.
    fn track(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &Observation,
        reference: &PositionReference,
        (position, altitude, attitude): (bool, bool, bool),
    ) {
        let (controllers, limits) = (&configuration.controllers, &configuration.limits);
        let time_us = self.event_us;
        if position || altitude {
            self.guidance.sample(reference, limits, time_us);
        }
        if position {
            // Commands ramp up to the input until the next sample.
            let setpoint = self.guidance.setpoint(time_us, controllers.position.sample_time_us);
            self.cascade.sample_position(configuration, design, seen, &setpoint, time_us);
        }
        if altitude {
            // … and the rotors lag behind the thrust command.
            let lag_us = (configuration.airframe.rotor_time_constant_s * 1e6) as u64;
            let setpoint = self.guidance.setpoint(time_us, controllers.altitude.sample_time_us + lag_us);
            self.cascade.sample_altitude(configuration, design, seen, &setpoint, time_us);
        }
        if attitude {
            let heading = self.guidance.sample_heading(reference, limits, time_us);
            self.cascade.sample_attitude(configuration, design, seen, &heading, time_us);
        }
    }
}

/// A flight: configuration, controllers designed from it, and state.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    configuration: Configuration,
    design: CascadeDesign,
    state: SimulationState,
    /// What the controllers take the vehicle's motion for, if somebody outside estimates it.
    estimate: Option<RigidBody>,
    /// What is wrong with the front, right, back and left rotor.
    rotor_faults: [Option<RotorFault>; 4],
    /// Flies in place of the cascade while a rotor is lost.
    recovery: Option<Recovery>,
}

impl Simulation {
    /// A flight at time zero, in the configured initial state.
    ///
    /// # Errors
    /// [`ConfigurationError`] when a value is out of range, values contradict one another, or a
    /// controller cannot be designed.
    pub fn new(configuration: &Configuration, inputs: &Inputs) -> Result<Self, ConfigurationError> {
        let design = CascadeDesign::new(configuration)?;
        let plant = Plant::new(configuration, inputs.armed);
        let observer = Observer::new(configuration, &plant, None, 0, None);
        let (guidance, cascade) = engaged(configuration, &plant.body, &plant, 0);
        let state = SimulationState {
            time_us: 0,
            event_us: 0,
            sampled: false,
            plant,
            disturbance: inputs.disturbance,
            armed: inputs.armed,
            guidance,
            observer,
            cascade,
            attitude_target: None,
            engage: false,
        };
        Ok(Self::of(configuration, design, state))
    }

    /// A flight that goes on from a saved state of a flight with the same configuration.
    ///
    /// # Errors
    /// As [`Simulation::new`], and [`ConfigurationError::State`].
    pub fn from_state(
        configuration: &Configuration,
        state: SimulationState,
    ) -> Result<Self, ConfigurationError> {
        state.check(configuration)?;
        let design = CascadeDesign::new(configuration)?;
        Ok(Self::of(configuration, design, state))
    }

    /// A flight that nothing outside has touched yet.
    fn of(configuration: &Configuration, design: CascadeDesign, state: SimulationState) -> Self {
        let configuration = *configuration;
        Self { configuration, design, state, estimate: None, rotor_faults: [None; 4], recovery: None }
    }

    /// The configuration.
    pub fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// The controllers.
    pub fn design(&self) -> &CascadeDesign {
        &self.design
    }

    /// The state, to be saved.
    pub fn state(&self) -> &SimulationState {
        &self.state
    }

    /// Goes back, or on, to a saved state of this flight.
    ///
    /// # Errors
    /// [`ConfigurationError::State`]; nothing has changed then.
    pub fn restore(&mut self, state: SimulationState) -> Result<(), ConfigurationError> {
        state.check(&self.configuration)?;
        self.state = state;
        Ok(())
    }

    /// Time since the start, µs.
    pub fn time_us(&self) -> u64 {
        self.state.time_us
    }

    /// Changes tunable parameters during the flight and redesigns the controllers. Incremental controllers go on from the input that they applied last, without a bump.
    ///
    /// # Errors
    /// [`ConfigurationError::Fixed`] when another parameter differs, and those of [`Simulation::new`];
    /// nothing has changed then.
    pub fn reconfigure(&mut self, configuration: &Configuration) -> Result<(), ConfigurationError> {
        only_tunables_differ(&self.configuration, configuration)?;
        let design = CascadeDesign::new(configuration)?;
        self.recovery = recovery(configuration, self.lost_rotor())?;
        self.design = design;
        self.configuration = *configuration;
        Ok(())
    }

    /// Switches the shaper on or off during the flight. The reference goes on from where it is and as it moves.
    ///
    /// # Errors
    /// [`ConfigurationError::Unavailable`] in a build without the shaper; nothing has changed then.
    pub fn set_shaping(&mut self, shaping: bool) -> Result<(), ConfigurationError> {
        if shaping == self.configuration.reference.shaping {
            return Ok(());
        }
        if shaping && !cfg!(feature = "shaper") {
            return Err(ConfigurationError::Unavailable { name: "reference.shaping" });
        }
        self.configuration.reference.shaping = shaping;
        self.state.guidance = self.state.guidance.switched(&self.configuration, self.state.time_us);
        Ok(())
    }

    /// Flies an attitude and a thrust instead of the reference of the inputs, until it is given `None`:
    /// then the position and altitude controllers take over the vehicle where it is.
    ///
    /// # Errors
    /// [`SimulationError::InputNotFinite`]; nothing has changed then.
    pub fn set_attitude_target(&mut self, target: Option<AttitudeTarget>) -> Result<(), SimulationError> {
        if target.is_some_and(|target| !target.is_finite()) {
            return Err(SimulationError::InputNotFinite {
                name: "attitude_target",
                time_us: self.state.time_us,
            });
        }
        self.state.engage |= self.state.attitude_target.is_some() && target.is_none();
        self.state.attitude_target = target;
        Ok(())
    }

    /// Lets the controllers fly by an estimate from outside from now on, in place of the true motion and the noise of
    /// [`Sensors`](crate::Sensors), until it is given `None`. What the predictor of disturbances believes of its errors
    /// stays the configured noise. It is an input, not a part of the state: whoever restores a flight gives it again.
    ///
    /// # Errors
    /// [`SimulationError::InputNotFinite`]; nothing has changed then.
    pub fn set_estimate(&mut self, estimate: Option<RigidBody>) -> Result<(), SimulationError> {
        let usable = |body: &RigidBody| body.is_finite() && body.attitude.norm() > 0.5;
        if !estimate.as_ref().is_none_or(usable) {
            return Err(SimulationError::InputNotFinite { name: "estimate", time_us: self.state.time_us });
        }
        self.estimate = estimate;
        Ok(())
    }

    /// Breaks rotors, front, right, back and left, or mends them, from now on. It is an input, not a part of the state:
    /// whoever restores a flight gives it again.
    ///
    /// # Errors
    /// [`SimulationError::InputNotFinite`] for a share of the thrust that is none; nothing has changed then.
    pub fn set_rotor_faults(&mut self, faults: [Option<RotorFault>; 4]) -> Result<(), SimulationError> {
        if !faults.iter().flatten().all(|fault| fault.is_valid()) {
            return Err(SimulationError::InputNotFinite {
                name: "rotor_faults",
                time_us: self.state.time_us,
            });
        }
        self.rotor_faults = faults;
        Ok(())
    }

    /// Flies on without the front (0), right, back or left (3) rotor from now on, which is known to be lost: the heading
    /// is given up, and the reference of the inputs is followed in position and velocity as it is, as far as three rotors
    /// can. With `None` the cascade takes over the vehicle where it is. It is an input, not a part of the state.
    ///
    /// # Errors
    /// [`ConfigurationError::OutOfRange`] when there is no such rotor, and [`ConfigurationError::Design`]; nothing has
    /// changed then.
    pub fn set_lost_rotor(&mut self, lost: Option<usize>) -> Result<(), ConfigurationError> {
        if lost == self.lost_rotor() {
            return Ok(());
        }
        self.recovery = recovery(&self.configuration, lost)?;
        self.state.engage |= lost.is_none();
        Ok(())
    }

    /// The rotor without which it flies.
    pub fn lost_rotor(&self) -> Option<usize> {
        self.recovery.as_ref().map(Recovery::lost)
    }

    /// Speeds that the rotors are commanded to turn with, front, right, back and left, rad/s.
    pub fn rotor_command_rad_s(&self) -> [f64; 4] {
        if self.state.armed { self.state.cascade.rotor_command_rad_s() } else { [0.0; 4] }
    }

    /// Flies on to `time_us`. However the way there is split into calls, the flight is the same: inputs are
    /// sampled at the events of the engine's own schedule, and an arrival between two events does not
    /// disturb the integration.
    ///
    /// # Errors
    /// [`SimulationError`]; the flight then stands at the last event before it.
    pub fn advance_to(&mut self, time_us: u64, inputs: &impl InputSignal) -> Result<(), SimulationError> {
        if time_us < self.state.time_us {
            return Err(SimulationError::Backwards { time_us: self.state.time_us, requested_us: time_us });
        }
        // The events strictly before the goal; one at the goal belongs to the next call, whose inputs
        // apply from there on.
        while self.state.event_us < time_us {
            if !self.state.sampled {
                self.sample(&inputs.at(self.state.event_us))?;
            }
            let next_us = next_event_us(&self.configuration, self.state.event_us);
            if next_us > time_us {
                break;
            }
            let plant = self.plant_at(next_us);
            if !plant.is_finite() {
                return Err(SimulationError::Diverged { time_us: next_us });
            }
            self.state.plant = plant;
            self.state.event_us = next_us;
            self.state.time_us = next_us;
            self.state.sampled = false;
        }
        self.state.time_us = time_us;
        Ok(())
    }

    /// What can be observed now.
    pub fn outputs(&self) -> Outputs {
        let state = &self.state;
        let plant = self.plant_at(state.time_us);
        let rotation = plant.body.rotation();
        let (phi, theta, psi) = rotation.euler_angles();
        let wrench = plant.wrench(&self.configuration);
        let setpoint = state.guidance.reference(state.time_us);
        Outputs {
            time_us: state.time_us,
            position_m: plant.body.position_m,
            velocity_m_s: plant.body.velocity_m_s,
            acceleration_m_s2: plant.acceleration_m_s2(&self.configuration, &state.disturbance),
            body_velocity_m_s: rotation.inverse_transform_vector(&plant.body.velocity_m_s),
            attitude_rad: Vector3::new(phi, theta, psi),
            quaternion: [rotation.w, rotation.i, rotation.j, rotation.k],
            body_rate_rad_s: plant.body.body_rate_rad_s,
            thrust_n: wrench.thrust_n,
            torque_n_m: wrench.torque_n_m,
            rotor_speed_rad_s: plant.rotor_speed_rad_s,
            tilt_reference_rad: state.cascade.tilt_reference_rad(),
            setpoint,
            tracking_error_m: plant.body.position_m - setpoint.position_m,
            yaw_error_rad: wrapped(psi - setpoint.yaw_rad),
            activity: state.cascade.activity(),
        }
    }

    /// What the controllers take the vehicle's motion for now, unless it is the truth: an estimate from outside, what the
    /// Kalman predictor makes of the measurements while it flies, or the true motion with the noise of the latest
    /// reading.
    pub fn believed_motion(&self) -> Option<RigidBody> {
        let state = &self.state;
        let plant = self.plant_at(state.time_us);
        self.estimate.or_else(|| {
            state.observer.belief(&self.configuration.sensors, &plant, state.armed, state.time_us)
        })
    }

    /// The plant at `time_us`, not before the last event nor after the next.
    fn plant_at(&self, time_us: u64) -> Plant {
        let state = &self.state;
        if time_us == state.event_us {
            return state.plant;
        }
        let mut command = self.rotor_command_rad_s();
        for ((command, fault), present) in
            command.iter_mut().zip(self.rotor_faults).zip(state.plant.rotor_speed_rad_s)
        {
            if let Some(fault) = fault.filter(|_| state.armed) {
                *command = fault.goal_rad_s(*command, present);
            }
        }
        let h_s = (time_us - state.event_us) as f64 / 1e6;
        state.plant.step(&self.configuration, &command, &state.disturbance, h_s)
    }

    /// Samples the inputs and runs the controllers whose clocks tick at the last event.
    fn sample(&mut self, inputs: &Inputs) -> Result<(), SimulationError> {
        inputs.check(self.state.event_us)?;
        self.take(inputs);
        if self.state.armed {
            self.control(&inputs.reference);
        }
        self.state.sampled = true;
        Ok(())
    }

    /// Takes inputs in. Reference and controllers that begin take over the vehicle where it is.
    fn take(&mut self, inputs: &Inputs) {
        let (configuration, estimate) = (&self.configuration, self.estimate.as_ref());
        let state = &mut self.state;
        let time_us = state.event_us;
        state.disturbance = inputs.disturbance;
        if inputs.armed && (!state.armed || state.engage) {
            let body = estimate.unwrap_or(&state.plant.body);
            (state.guidance, state.cascade) = engaged(configuration, body, &state.plant, time_us);
        }
        if inputs.armed && !state.armed {
            state.observer =
                Observer::new(configuration, &state.plant, estimate, time_us, Some(&state.observer));
        }
        state.engage &= !inputs.armed;
        state.armed = inputs.armed;
    }

    /// Runs the controllers whose clocks tick: those for the loss of a rotor, that of an attitude, or the cascade.
    fn control(&mut self, reference: &PositionReference) {
        let (configuration, design) = (&self.configuration, &self.design);
        let state = &mut self.state;
        let time_us = state.event_us;
        let controllers = &configuration.controllers;
        let position = ticks(time_us, controllers.position.sample_time_us);
        let altitude = ticks(time_us, controllers.altitude.sample_time_us);
        let attitude = ticks(time_us, controllers.attitude.sample_time_us);
        if !(position || altitude || attitude) {
            return;
        }
        let seen = state.observer.observe(configuration, &state.plant, self.estimate.as_ref(), time_us);
        let directly = self.recovery.is_some() || state.attitude_target.is_some();
        if directly && !attitude {
            return;
        }
        if let Some(recovery) = &self.recovery {
            let measured = &state.plant.rotor_speed_rad_s;
            state.cascade.set_rotor_command(recovery.step(configuration, &seen.body, measured, reference));
        } else if let Some(target) = &state.attitude_target {
            state.cascade.sample_attitude_target(configuration, design, &seen, target);
        } else {
            state.track(configuration, design, &seen, reference, (position, altitude, attitude));
        }
        if attitude {
            let command = if directly {
                let rotor_speed_rad_s = state.cascade.rotor_command_rad_s();
                Command { acceleration_m_s2: None, rotor_speed_rad_s }
            } else {
                state.cascade.command(configuration, time_us)
            };
            state.observer.predict(configuration, &design.estimator, &seen, &command, time_us);
        }
    }
}

/// The controller for the loss of a rotor.
fn recovery(
    configuration: &Configuration,
    lost: Option<usize>,
) -> Result<Option<Recovery>, ConfigurationError> {
    let Some(lost) = lost else { return Ok(None) };
    if lost > 3 {
        let value = lost as f64;
        return Err(ConfigurationError::OutOfRange { name: "lost_rotor", value, minimum: 0.0, maximum: 3.0 });
    }
    let designed = Recovery::new(configuration, lost);
    designed.map(Some).map_err(|source| ConfigurationError::Design { controller: "recovery", source })
}

/// Reference and controllers that take over the vehicle where it is, or is estimated to be.
fn engaged(
    configuration: &Configuration,
    body: &RigidBody,
    plant: &Plant,
    time_us: u64,
) -> (Guidance, Cascade) {
    let (_, _, psi) = body.rotation().euler_angles();
    (
        Guidance::new(configuration, &body.position_m, psi, time_us),
        Cascade::new(body, plant.rotor_speed_rad_s, time_us),
    )
}
