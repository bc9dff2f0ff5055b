//! Everything that changes in a control loop, and one sample of it.

mod law_in_force;
mod learning;
mod watching;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::control::cascade::Cascade;
use crate::control::clearance::{Clearance, carries};
use crate::control::command_limits::CommandLimits;
use crate::control::control_inputs::{ControlInputs, ControlLaw, Target};
use crate::control::estimator::Estimator;
use crate::control::instants::{Clocks, Due, LATEST_US, Phases};
use crate::control::learning::mass_and_drag::MassAndDrag;
use crate::control::measurement::Instruments;
use crate::control::observation::Observation;
use crate::control::rate_bias::RateBias;
use crate::control::rotor_command::RotorCommand;
use crate::design::loop_design::LoopDesign;
use crate::guidance::found_derivatives::gives_all;
use crate::guidance::reference_guidance::Guidance;
use crate::{
    Activity, CascadeDesign, Configuration, ConfigurationError, ControlError, Controllers, Measurement,
    PositionReference, RigidBody, Wrench,
};

/// Everything that changes in a control loop, and all there is of it to save and restore.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ControlState {
    /// The next instant at which it samples, µs.
    next_us: u64,
    /// The first sample of a controller then or later, µs.
    sample_us: u64,
    phases: Phases,
    armed: bool,
    /// The law that flew last.
    law: ControlLaw,
    /// Whether reference and controllers take over the vehicle anew at the next sample.
    engage: bool,
    guidance: Guidance,
    /// Limits of the commands.
    limits: CommandLimits,
    clearance: Clearance,
    bias: RateBias,
    estimator: Estimator,
    learned: MassAndDrag,
    cascade: Cascade,
    /// What is commanded while armed.
    command: RotorCommand,
}

impl ControlState {
    /// Takes over a vehicle at `time_us`.
    ///
    /// # Errors
    /// [`ConfigurationError::Measurement`].
    pub(crate) fn new(
        configuration: &Configuration,
        inputs: &ControlInputs,
        instruments: &mut impl Instruments,
        time_us: u64,
    ) -> Result<Self, ConfigurationError> {
        let shaping = inputs.shaping.unwrap_or(configuration.reference.shaping);
        let start = instruments.read_at_takeover(time_us);
        let first = instruments.read(time_us);
        let estimator = Estimator::take_over(configuration, &first, time_us);
        let (mut guidance, cascade) = engaged(configuration, shaping, (&start.motion, &estimator), time_us);
        if let Target::Reference(reference) = &inputs.target
            && inputs.armed
            && !shaping
        {
            // The set-point is the reference from the first instant on, before the first sample.
            let limits = (&configuration.flyable_limits(), &configuration.response_times());
            guidance.sample(reference, inputs.plan.as_ref(), limits, time_us);
        }
        if !(start.is_possible() && first.is_possible()) {
            return Err(ConfigurationError::Measurement);
        }
        let phases = Phases::default();
        let clocks = phases.clocks(&configuration.controllers);
        Ok(Self {
            next_us: clocks.first_instant_us(time_us),
            sample_us: clocks.first_sample_us(time_us),
            phases,
            armed: inputs.armed,
            law: inputs.target.law(),
            engage: false,
            guidance,
            limits: CommandLimits::new(&configuration.limits),
            clearance: Clearance::take_off(configuration, &first),
            bias: RateBias::default(),
            estimator,
            learned: MassAndDrag::new(configuration),
            cascade,
            command: RotorCommand::held(&configuration.airframe, start.rotor_speed_rad_s),
        })
    }

    /// Whether a loop can have been in this state: saved states may come from anywhere.
    pub(crate) fn check(&self, configuration: &Configuration) -> Result<(), ConfigurationError> {
        let controllers = &configuration.controllers;
        if self.next_us > LATEST_US
            || !self.phases.fit(controllers)
            || !self.clocks(controllers).is_instant(self.next_us)
            || self.sample_us != self.clocks(controllers).first_sample_us(self.next_us)
        {
            return Err(ConfigurationError::State {
                reason: "its controllers do not sample when they would",
            });
        }
        if !(self.learned.is_possible(configuration)
            && self.clearance.is_possible()
            && self.bias.is_possible())
        {
            return Err(ConfigurationError::State { reason: "what it has learned is out of range" });
        }
        Ok(())
    }

    fn clocks(&self, controllers: &Controllers) -> Clocks {
        self.phases.clocks(controllers)
    }

    /// Goes on from one design under another one: with the estimates, the disturbances that were found, and the commands.
    /// The change takes effect at the next instant.
    pub(crate) fn hand_over(&mut self, before: &LoopDesign, after: &LoopDesign) {
        let controllers = &after.configuration.controllers;
        let mut believed = self.learned.in_place_of_belief(&before.configuration);
        self.learned.reconfigure(&before.configuration, &after.configuration);
        let (one, other) = (&before.configuration, &after.configuration);
        if one.airframe.inertia_kg_m2 != other.airframe.inertia_kg_m2 {
            // Another vehicle, not another belief.
            let inertia = self.learned.in_place_of_belief(other).believed_inertia_kg_m2();
            let share = one.controllers.mass_factor / other.controllers.mass_factor;
            believed.believe_inertia_kg_m2(&(inertia * share));
        }
        if self.armed {
            self.cascade.hand_over(before, after);
            self.limits.change(&after.configuration.limits, self.next_us);
            self.believe(&believed, &after.configuration);
        }
        if !self.armed {
            self.limits = CommandLimits::new(&after.configuration.limits);
        }
        // Nothing is under way on the ground that a phase would be kept for.
        self.phases = if self.armed {
            self.phases.for_sample_times(&before.configuration.controllers, controllers, self.next_us)
        } else {
            Phases::default()
        };
        let clocks = self.clocks(controllers);
        (self.sample_us, self.next_us) =
            (clocks.first_sample_us(self.next_us), clocks.first_instant_us(self.next_us));
    }

    /// Whether limits have been lowered that the present motion cannot keep yet.
    pub fn is_easing(&self) -> bool {
        self.limits.is_eased()
    }

    /// The next instant at which it samples, µs.
    pub fn next_us(&self) -> u64 {
        self.next_us
    }

    /// Whether the rotors turn.
    pub fn is_armed(&self) -> bool {
        self.armed
    }

    /// The law that flies.
    pub fn law(&self) -> ControlLaw {
        self.law
    }

    /// Commanded speeds of the rotors, rad/s, in the order of the airframe's layout.
    pub fn rotor_command_rad_s(&self) -> [f64; 4] {
        self.command().speed_rad_s
    }

    /// Thrust and torques that are commanded, after the allocation to the rotors and its limits. The rotors' speeds are commanded so that
    /// thrust and torques answer with the first-order lag of the rotors; flight without a rotor commands speeds that make them at last.
    pub fn commanded_wrench(&self) -> Wrench {
        self.command().wrench
    }

    fn command(&self) -> RotorCommand {
        if self.armed { self.command } else { RotorCommand::none() }
    }

    /// The reference that the cascade tracks at `time_us`, after shaping.
    pub fn reference(&self, time_us: u64) -> PositionReference {
        self.guidance.reference(time_us)
    }

    /// What the cascade will track at `time_us`, as far as it is known now. A reference that is neither shaped nor planned goes on
    /// turning if it turns, and else as [`PositionReference::expected_after`] has it.
    pub fn preview(&self, time_us: u64) -> PositionReference {
        self.guidance.preview(time_us)
    }

    /// All positions are elsewhere, m, and nothing has moved.
    pub(crate) fn shift_positions(&mut self, by_m: &Vector3<f64>) {
        self.guidance.shift(by_m);
        self.cascade.shift(by_m);
        self.bias.shift(by_m);
        self.estimator.shift(by_m);
        self.learned.shift(by_m);
        self.clearance.shift(by_m.z);
    }

    /// φ and θ that the position controller asks of the attitude controller, rad.
    pub fn tilt_reference_rad(&self) -> [f64; 2] {
        self.cascade.tilt_reference_rad()
    }

    /// How the controllers came to their last inputs.
    pub fn activity(&self) -> Activity {
        self.cascade.activity()
    }

    /// The motion that the Kalman predictor expects at `time_us`, at most a sample away.
    pub(crate) fn estimated_motion(&self, time_us: u64) -> RigidBody {
        self.estimator.body_at(time_us)
    }

    /// One sample, at its next instant; on an error nothing has changed.
    pub(crate) fn sample(
        &mut self,
        design: &LoopDesign,
        inputs: &ControlInputs,
        instruments: &mut impl Instruments,
    ) -> Result<(), ControlError> {
        let time_us = self.next_us;
        check(design, inputs, time_us)?;
        let (due, sample_us) = if time_us < self.sample_us {
            (Due::NONE, self.sample_us)
        } else {
            self.clocks(&design.configuration.controllers).look(time_us)
        };
        if inputs.armed && self.takes_over(inputs) {
            self.advance_or_stay(design, inputs, instruments, (due, time_us))?;
        } else {
            self.advance(design, inputs, instruments, (due, time_us))?;
        }
        (self.next_us, self.sample_us) = (Clocks::next_instant_us(time_us, sample_us), sample_us);
        Ok(())
    }

    /// The same where it takes over a vehicle, which is measured more than once, and may be refused in its midst.
    // Not within a sample, which would find room on the stack for the copy of the state each time.
    #[cold]
    #[inline(never)]
    fn advance_or_stay(
        &mut self,
        design: &LoopDesign,
        inputs: &ControlInputs,
        instruments: &mut impl Instruments,
        at: (Due, u64),
    ) -> Result<(), ControlError> {
        let before = *self;
        let advanced = self.advance(design, inputs, instruments, at);
        if advanced.is_err() {
            *self = before;
        }
        advanced
    }

    /// Takes inputs in, and runs the controllers that are due. An error may leave it half done if it takes over a vehicle; else
    /// nothing has changed.
    fn advance(
        &mut self,
        design: &LoopDesign,
        inputs: &ControlInputs,
        instruments: &mut impl Instruments,
        (due, time_us): (Due, u64),
    ) -> Result<(), ControlError> {
        let goes_on = inputs.armed && due.any() && !self.takes_over(inputs);
        let measured = goes_on.then(|| instruments.read(time_us).checked(time_us)).transpose()?;
        self.take(&design.configuration, inputs, instruments, time_us)?;
        if !self.armed {
            return Ok(());
        }
        if let Target::Reference(reference) = &inputs.target {
            self.guidance.watch(reference, &design.configuration.limits, time_us);
        }
        if !due.any() {
            return Ok(());
        }
        let measurement = match measured {
            Some(measurement) => measurement,
            None => instruments.read(time_us).checked(time_us)?,
        };
        self.control(design, inputs, &measurement, (due, time_us))
    }

    /// Reference and controllers begin where the vehicle is.
    // Not within a sample: they are made on the stack, in room that each sample would touch.
    #[cold]
    #[inline(never)]
    fn engage_at(&mut self, configuration: &Configuration, start: &Measurement, time_us: u64) {
        let shaping = self.guidance.is_shaped();
        (self.guidance, self.cascade) =
            engaged(configuration, shaping, (&start.motion, &self.estimator), time_us);
        self.command = RotorCommand::held(&configuration.airframe, start.rotor_speed_rad_s);
    }

    /// Takes inputs in. Reference and controllers that begin take over the vehicle where it is.
    fn take(
        &mut self,
        configuration: &Configuration,
        inputs: &ControlInputs,
        instruments: &mut impl Instruments,
        time_us: u64,
    ) -> Result<(), ControlError> {
        let takes_over = self.takes_over(inputs);
        self.take_law(configuration, inputs, time_us);
        let takes_off = inputs.armed && !self.armed;
        let start = (inputs.armed && takes_over)
            .then(|| instruments.read_at_takeover(time_us).checked(time_us))
            .transpose()?;
        if takes_off {
            let first = instruments.read(time_us).checked(time_us)?;
            self.limits = CommandLimits::new(&configuration.limits);
            self.estimator = Estimator::take_over(configuration, &first, time_us);
            self.clearance = Clearance::take_off(configuration, &first);
            self.learned.take_off(configuration);
        }
        if let Some(start) = start {
            self.engage_at(configuration, &start, time_us);
        }
        self.engage &= !inputs.armed;
        self.armed = inputs.armed;
        Ok(())
    }

    /// Runs the controllers whose clocks tick.
    fn control(
        &mut self,
        design: &LoopDesign,
        inputs: &ControlInputs,
        measurement: &Measurement,
        (due, time_us): (Due, u64),
    ) -> Result<(), ControlError> {
        // Where rates are read at all.
        let sensors = &design.configuration.sensors;
        if due.attitude && !sensors.output_feedback {
            self.bias.observe(sensors, &measurement.motion, time_us);
        }
        let measurement = &self.bias.corrected(measurement);
        let z_m = measurement.motion.position_m.z;
        let is_clear = due.attitude && self.clearance.observe(&design.configuration, inputs.ground_z_m, z_m);
        let configuration = &if due.attitude {
            self.learn(design, &measurement.motion, (is_clear, time_us))
        } else {
            self.believed(&design.configuration)
        };
        let seen = Observation::new(
            configuration,
            (&self.estimator, &design.cascade.estimator),
            &measurement.motion,
            time_us,
        );
        match &inputs.target {
            Target::Reference(reference) => {
                // A way that is passed on is followed by each command; a shaped one waits for those that plan.
                if due.position || due.altitude || !self.guidance.is_shaped() {
                    let limits = (&configuration.flyable_limits(), &configuration.response_times());
                    self.guidance.sample(reference, inputs.plan.as_ref(), limits, time_us);
                }
                self.track(design, configuration, &seen, reference, due, time_us);
            }
            // Only the attitude controller's clock counts for the other laws.
            _ if !due.attitude => return Ok(()),
            Target::Attitude(target) => {
                self.command = self.cascade.sample_attitude_target(
                    configuration,
                    &design.cascade,
                    &seen,
                    target,
                    time_us,
                );
            }
            Target::WithoutRotor { lost, reference } => {
                let law = design.rotor_loss.of(*lost)?;
                let measured = &measurement.rotor_speed_rad_s;
                let speeds_rad_s = law.step(configuration, &seen.body, measured, reference);
                self.command = RotorCommand::held(&configuration.airframe, speeds_rad_s);
            }
        }
        if due.attitude {
            self.predict(&design.cascade, configuration, &seen, (is_clear, time_us));
        }
        Ok(())
    }

    /// Runs the cascade along a reference: the position, altitude and attitude controllers whose clocks tick.
    fn track(
        &mut self,
        design: &LoopDesign,
        learned: &Configuration,
        seen: &Observation,
        reference: &PositionReference,
        due: Due,
        time_us: u64,
    ) {
        let cascade = &design.cascade;
        if due.position || due.altitude {
            let attitude = cascade.attitude_loop();
            self.limits.watch(&design.configuration, attitude.as_ref(), &self.guidance, &seen.body, time_us);
        }
        let configuration = &self.limits.in_force(learned);
        let given = self.guidance.reference(time_us);
        let is_told = self.guidance.is_foretold() || gives_all(reference);
        let followed = self.cascade.follow(configuration, cascade, (&given, is_told, seen), time_us);
        let now = followed.unwrap_or(given);
        let foretold = followed.and_then(|_| self.cascade.foretold_way());
        let later_s = |then_us: u64| then_us.saturating_sub(time_us) as f64 / 1e6;
        let ahead = |guidance: &Guidance, then_us: u64| match (&followed, &foretold) {
            (None, _) => guidance.preview(then_us),
            (_, Some(way)) => guidance.heading(then_us).on(&way.at(&now, then_us)),
            // Its turns are those of the limits: nobody knows for how long they last.
            (Some(followed), None) => {
                guidance.heading(then_us).on(&followed.expected_after(later_s(then_us)))
            }
        };
        if due.position {
            let guidance = &self.guidance;
            let is_foretold = foretold.is_some() || (followed.is_none() && guidance.is_foretold());
            let expected = |then_us: u64| match &followed {
                None => guidance.reference(then_us),
                Some(followed) => followed.expected_after(later_s(then_us)),
            };
            let asked = |then_us| (!is_foretold).then(|| expected(then_us));
            let references = (&now, |then_us| ahead(guidance, then_us), asked);
            self.cascade.sample_position(configuration, cascade, seen, references, time_us);
        }
        if due.altitude {
            self.cascade.sample_altitude(configuration, cascade, seen, &now, time_us);
        }
        if due.attitude {
            let limits = &design.configuration.limits;
            let now = self.guidance.sample_heading(reference, limits, time_us).on(&now);
            // A command takes effect as late as the rotors answer, and in the middle of the time for which it is held.
            let lag_us = (configuration.airframe.mean_rotor_lag_s() * 1e6) as u64;
            let answered_us = time_us + lag_us + configuration.controllers.attitude.sample_time_us / 2;
            let answered = ahead(&self.guidance, answered_us);
            self.command = self.cascade.sample_attitude(configuration, cascade, seen, (&now, &answered));
        }
    }

    /// Takes the estimate on to the next sample of the attitude controller. It runs beside controllers that do not ask for
    /// it, too, so that those which do can take over in flight.
    fn predict(
        &mut self,
        design: &CascadeDesign,
        configuration: &Configuration,
        seen: &Observation,
        (is_clear, time_us): (bool, u64),
    ) {
        let times = (time_us, configuration.controllers.attitude.sample_time_us);
        self.estimator.predict(configuration, design, &seen.measured, &self.command.speed_rad_s, times);
        if !is_clear && !carries(configuration, &self.estimator.rotor_speed_rad_s()) {
            self.estimator.stand();
        }
    }
}

/// Refuses what no law of the design can fly.
fn check(design: &LoopDesign, inputs: &ControlInputs, time_us: u64) -> Result<(), ControlError> {
    inputs.check(time_us)?;
    if let Target::WithoutRotor { lost, .. } = inputs.target {
        design.rotor_loss.of(lost)?;
    }
    Ok(())
}

/// Reference and controllers that take over the vehicle where it is.
fn engaged(
    configuration: &Configuration,
    shaping: bool,
    (body, estimator): (&RigidBody, &Estimator),
    time_us: u64,
) -> (Guidance, Cascade) {
    let (_, _, psi) = body.rotation().euler_angles();
    (
        Guidance::new(&configuration.flyable_limits(), shaping, &body.position_m, psi, time_us),
        Cascade::new(body, &-estimator.disturbance_rad_s2()),
    )
}
