//! The control loop without a plant.

use alloc::sync::Arc;

use nalgebra::Vector3;

use crate::control::control_error::ControlError;
use crate::control::control_inputs::{ControlInputs, ControlSignal};
use crate::control::control_state::ControlState;
use crate::control::measurement::Instruments;
use crate::design::loop_design::LoopDesign;
use crate::design::prepared_design::PreparedDesign;
use crate::finite::are_finite;
use crate::{Belief, CascadeDesign, Configuration, ConfigurationError, Inputs, RigidBody, StabilityReport};

/// Guidance, estimator and controllers of a vehicle: from references and measurements to rotor commands.
///
/// It needs no plant of ours, does not allocate while it flies without the shaper, and samples at exact instants of its own
/// whatever the caller's step: each millisecond it looks at its inputs, and each controller samples at the multiples of its
/// sample time.
///
/// ```
/// use quadrotor::{
///     Configuration, ControlInputs, ControlLoop, InitialState, Measurement, PlantState, PositionReference, Target,
/// };
///
/// let configuration = Configuration::default();
/// let hover = PlantState::hovering(&InitialState::default(), &configuration.airframe);
/// let mut measured = Measurement { motion: hover.body, rotor_speed_rad_s: hover.rotor_speed_rad_s };
/// let goal = PositionReference::goal([0.0, 0.0, -1.0], 0.0);
/// let inputs = ControlInputs::armed(Target::Reference(goal));
/// let mut control = ControlLoop::new(&configuration, &inputs, &mut measured, 0)?;
/// let command_rad_s = control.advance_to(250_000, &inputs, &mut measured)?;
/// // It is asked to climb, and turns its rotors faster.
/// assert!(command_rad_s.iter().sum::<f64>() > hover.rotor_speed_rad_s.iter().sum::<f64>());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ControlLoop {
    design: Arc<LoopDesign>,
    state: ControlState,
}

impl ControlLoop {
    /// A loop that takes over a vehicle at `time_us`.
    ///
    /// # Errors
    /// [`ConfigurationError`] when a value is out of range, values contradict one another, a controller cannot be designed,
    /// the closed loop is unstable or shaken by noise, or the first measurement is not finite.
    pub fn new(
        configuration: &Configuration,
        inputs: &ControlInputs,
        instruments: &mut impl Instruments,
        time_us: u64,
    ) -> Result<Self, ConfigurationError> {
        Self::prepared(&PreparedDesign::new(configuration)?, inputs, instruments, time_us)
    }

    /// The same, with a finished design, which it shares.
    ///
    /// # Errors
    /// [`ConfigurationError::Measurement`].
    pub fn prepared(
        prepared: &PreparedDesign,
        inputs: &ControlInputs,
        instruments: &mut impl Instruments,
        time_us: u64,
    ) -> Result<Self, ConfigurationError> {
        let design = Arc::clone(&prepared.design);
        let state = ControlState::new(&design.configuration, inputs, instruments, time_us)?;
        Ok(Self { design, state })
    }

    /// A loop that goes on from a saved state of a loop with the same configuration.
    ///
    /// # Errors
    /// As [`ControlLoop::new`], and [`ConfigurationError::State`].
    pub fn from_state(
        configuration: &Configuration,
        state: ControlState,
    ) -> Result<Self, ConfigurationError> {
        state.check(configuration)?;
        Self::resumed(&PreparedDesign::new(configuration)?, state)
    }

    /// The same, with a finished design, which it shares.
    ///
    /// # Errors
    /// [`ConfigurationError::State`].
    pub fn resumed(prepared: &PreparedDesign, state: ControlState) -> Result<Self, ConfigurationError> {
        let design = Arc::clone(&prepared.design);
        state.check(&design.configuration)?;
        Ok(Self { design, state })
    }

    /// Begins anew, with the same controllers: takes over a vehicle at `time_us`, as [`ControlLoop::new`] does.
    ///
    /// # Errors
    /// [`ConfigurationError::Measurement`]; nothing has changed then.
    pub fn take_over(
        &mut self,
        inputs: &ControlInputs,
        instruments: &mut impl Instruments,
        time_us: u64,
    ) -> Result<(), ConfigurationError> {
        self.state = ControlState::new(&self.design.configuration, inputs, instruments, time_us)?;
        Ok(())
    }

    /// The configuration.
    pub fn configuration(&self) -> &Configuration {
        &self.design.configuration
    }

    /// The cascade's controllers.
    pub fn design(&self) -> &CascadeDesign {
        &self.design.cascade
    }

    /// How the closed loop behaves about hover, and what is worth a warning.
    pub fn stability(&self) -> &StabilityReport {
        &self.design.stability
    }

    /// The state, to be looked at or saved.
    pub fn state(&self) -> &ControlState {
        &self.state
    }

    /// Goes back, or on, to a saved state of this loop.
    ///
    /// # Errors
    /// [`ConfigurationError::State`]; nothing has changed then.
    pub fn restore(&mut self, state: ControlState) -> Result<(), ConfigurationError> {
        state.check(&self.design.configuration)?;
        self.state = state;
        Ok(())
    }

    /// Designs the controllers for another configuration beside the running ones, which go on. Hand the result over with
    /// [`ControlLoop::hand_over`]. A design takes milliseconds: a program that controls in real time can prepare it in
    /// another thread, on a clone of the loop.
    ///
    /// # Errors
    /// [`ConfigurationError::Fixed`] when a parameter that describes the start differs ([`Mutability::Start`](crate::Mutability)),
    /// and those of [`ControlLoop::new`].
    pub fn prepare(&self, configuration: &Configuration) -> Result<PreparedDesign, ConfigurationError> {
        Ok(PreparedDesign { design: Arc::new(self.design.changed(configuration)?) })
    }

    /// Goes on under a prepared design from its next sample on. It neither designs nor allocates.
    ///
    /// What is known of the flight stays: the reference, the estimated motion, the disturbances that were found and the
    /// input that was applied last, so that the new controllers go on from the thrust and the torques of the old ones. A
    /// controller whose sample time changes keeps the instant at which it would have sampled next, and the new sample
    /// time counts from there, in both directions: a shorter one takes effect before that instant.
    pub fn hand_over(&mut self, prepared: PreparedDesign) {
        self.state.hand_over(&self.design, &prepared.design);
        self.design = prepared.design;
    }

    /// Changes parameters during the flight: [`ControlLoop::prepare`], then [`ControlLoop::hand_over`]. Only the
    /// controllers that depend on them are designed anew.
    ///
    /// # Errors
    /// Those of [`ControlLoop::prepare`]; nothing has changed then.
    pub fn reconfigure(&mut self, configuration: &Configuration) -> Result<(), ConfigurationError> {
        let prepared = self.prepare(configuration)?;
        self.hand_over(prepared);
        Ok(())
    }

    /// Takes vehicle and reference to be elsewhere by `by_m` (m, NED), and neither to have moved: an estimate of the place has leapt, and
    /// the reference with it. Call it before the first sample with the other position and reference; without it, the leap would be flown
    /// after.
    ///
    /// # Errors
    /// [`ControlError::InputNotFinite`] with the name `by_m`; nothing has changed then.
    pub fn shift_positions(&mut self, by_m: &Vector3<f64>) -> Result<(), ControlError> {
        if !are_finite(by_m.as_slice()) {
            return Err(ControlError::InputNotFinite { name: "by_m", time_us: self.next_sample_us() });
        }
        self.state.shift_positions(by_m);
        Ok(())
    }

    /// Whether it can fly without this rotor.
    ///
    /// # Errors
    /// [`ConfigurationError::OutOfRange`] when there is no such rotor, [`ConfigurationError::Design`] when this airframe
    /// has no law for its loss.
    pub fn check_loss_of(&self, rotor: usize) -> Result<(), ConfigurationError> {
        self.design.rotor_loss.check(rotor)
    }

    /// The next instant at which it samples, µs.
    pub fn next_sample_us(&self) -> u64 {
        self.state.next_us()
    }

    /// Samples at all of its instants that have not been sampled yet, up to and including `time_us`, and returns the rotor
    /// speeds that are commanded from there on, rad/s, in the order of the airframe's layout. Between two instants nothing
    /// happens.
    ///
    /// Inputs and measurements are asked for at each of these instants; constants hold over all of them.
    ///
    /// # Errors
    /// [`ControlError`] when an input or a measurement is not finite, or the target cannot be flown; the loop then stands
    /// before the instant at which it happened, and its last rotor command still holds.
    pub fn advance_to(
        &mut self,
        time_us: u64,
        inputs: &impl ControlSignal,
        instruments: &mut impl Instruments,
    ) -> Result<[f64; 4], ControlError> {
        while self.state.next_us() <= time_us {
            let Self { design, state } = self;
            inputs.with(state.next_us(), |inputs| state.sample(design, inputs, instruments))?;
        }
        Ok(self.state.rotor_command_rad_s())
    }

    /// Lets the instant `time_us` pass if there is nothing to do under inputs that ask for a reference as they did before; false if
    /// there is.
    pub(crate) fn waits(&mut self, time_us: u64) -> bool {
        let waits = self.state.next_us() == time_us && self.state.waits();
        if waits {
            self.state.wait();
        }
        waits
    }

    /// The same for all instants before `time_us` and before the next sample of a controller.
    pub(crate) fn waits_until(&mut self, time_us: u64) -> bool {
        let waits = self.state.waits();
        if waits {
            self.state.wait_until(time_us);
        }
        waits
    }

    /// Whether a controller samples at `time_us`, at its next instant or before it.
    pub(crate) fn is_due(&self, time_us: u64) -> bool {
        self.state.is_due(time_us)
    }

    /// Whether these inputs leave it nothing to do at an instant at which no controller samples but to watch its reference: it neither
    /// measures nor changes a command.
    pub(crate) fn only_watches(&self, inputs: &Inputs) -> bool {
        self.state.only_watches(inputs)
    }

    /// Looks at such inputs at its next instant.
    ///
    /// # Errors
    /// [`ControlError`]; nothing has changed then.
    pub(crate) fn watch(&mut self, inputs: &ControlInputs) -> Result<(), ControlError> {
        self.state.watch(&self.design, inputs)
    }

    /// Mass and drag that the controllers go by.
    pub fn belief(&self) -> Belief {
        self.state.belief(&self.design.configuration)
    }

    /// What the Kalman predictor takes the vehicle's motion for at `time_us`, while the loop flies by it.
    pub fn estimated_motion(&self, time_us: u64) -> Option<RigidBody> {
        let flies_by_it = self.design.configuration.sensors.output_feedback && self.state.is_armed();
        flies_by_it.then(|| self.state.estimated_motion(time_us))
    }
}
