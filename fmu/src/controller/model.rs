//! The controllers as an FMI model, over [`quadrotor::ControlLoop`].

use std::any::Any;
use std::borrow::Cow;

use fmi::variables::{Array, Quantity, Terminal, Variable};
use fmi::{Identity, Model};
use quadrotor::{
    Activity, Belief, CascadeDesign, Configuration, ConfigurationError, ControlLoop, ControlState,
    Measurement, PositionReference, Wrench,
};
use serde::{Deserialize, Serialize};

use super::predicted_rotors::PredictedRotors;
use super::{
    ControllerError, ControllerInputs, ControllerParameters, Measurements, RotorSpeedMeasurement, identity,
    inputs, measurement, outputs, parameters,
};
use crate::designs;
use crate::quantities;
use crate::tables::figures::{self, Designed};
use crate::tables::terminals;
use crate::tables::{arrays, numbers, ranges};

/// A communication step of more sample times of the attitude controller than that is warned of.
const MOST_SAMPLES: u64 = 2;

/// The controllers of a quadrotor, without a vehicle.
///
/// A step from one communication point to the next samples at the instants of the control loop from the first one, inclusive, to
/// the last one, exclusive: each with the inputs of that instant. A controller that is stepped before its plant, over the same time, therefore
/// acts on the motion at the instant of its sample, as in the closed loop.
pub struct Controller {
    control: ControlLoop,
    measurements: Measurements,
    rotors: PredictedRotors,
    time_us: u64,
}

/// Everything that changes during a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ControllerState {
    control: ControlState,
    rotors: PredictedRotors,
    time_us: u64,
}

/// What the controllers tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControllerOutputs {
    /// Commanded speeds of the rotors in the order of the airframe's layout, rad/s.
    pub rotor_command_rad_s: [f64; 4],
    /// Commanded thrust and torques: [`ControlState::commanded_wrench`].
    pub wrench: Wrench,
    /// φ and θ that the position controller asks of the attitude controller, rad.
    pub tilt_reference_rad: [f64; 2],
    /// The reference that the cascade tracks, after shaping.
    pub setpoint: PositionReference,
    /// How the controllers came to their last inputs.
    pub activity: Activity,
    /// What the controllers take the vehicle for.
    pub belief: Belief,
}

impl Designed for Controller {
    fn design(&self) -> &CascadeDesign {
        self.control.design()
    }
}

impl Controller {
    fn configuration(&self) -> &Configuration {
        self.control.configuration()
    }

    /// One sample of the control loop, with the inputs of its instant.
    fn sample(&mut self, instant_us: u64, inputs: &ControllerInputs) -> Result<(), ControllerError> {
        let airframe = &self.configuration().airframe;
        let rotors = if instant_us == 0 {
            PredictedRotors::new(airframe, inputs.armed)
        } else {
            self.rotors.after(airframe, &self.control.state().rotor_command_rad_s(), instant_us)
        };
        let mut measured = measurement_of(self.measurements, inputs, &rotors, instant_us)?;
        if instant_us == 0 {
            // The vehicle is where it is when the run begins; initialization may have known less.
            self.control.take_over(&inputs.control(), &mut measured, instant_us)?;
        }
        self.control.advance_to(instant_us, &inputs.control(), &mut measured)?;
        self.rotors = rotors;
        Ok(())
    }
}

/// What the control loop sees at an instant.
fn measurement_of(
    measurements: Measurements,
    inputs: &ControllerInputs,
    rotors: &PredictedRotors,
    time_us: u64,
) -> Result<Measurement, ControllerError> {
    let rotor_speed_rad_s = match measurements.rotor_speeds {
        RotorSpeedMeasurement::Measured => inputs.measured.rotor_speed_rad_s,
        RotorSpeedMeasurement::Predicted => rotors.speed_rad_s(),
    };
    Ok(Measurement { motion: inputs.measured.body(measurements, time_us)?, rotor_speed_rad_s })
}

impl ControllerState {
    /// Whether a run can have been in this state: saved states may come from anywhere. The control loop checks its own.
    fn check(&self) -> Result<(), ConfigurationError> {
        /// From one look of the control loop at its inputs to the next.
        const PERIOD_US: u64 = 1_000;
        let wrong = |reason| Err(ConfigurationError::State { reason });
        let latest_us = (self.time_us / PERIOD_US + 1).saturating_mul(PERIOD_US);
        if !(self.time_us..=latest_us).contains(&self.control.next_us()) {
            return wrong("its controllers do not sample when they would");
        }
        if self.rotors.time_us() > self.time_us {
            return wrong("its rotors are ahead of it");
        }
        Ok(())
    }
}

impl Model for Controller {
    const IDENTITY: Identity = identity::IDENTITY;
    const VARIABLES: &'static [&'static [Variable<Self>]] = &[
        &inputs::REFERENCE,
        &inputs::ARMED,
        &inputs::MEASURED,
        &outputs::COMMANDS,
        &outputs::STEERING,
        &outputs::ACTIVITY,
        &measurement::TABLE,
        &parameters::TABLE,
        &numbers::airframe(),
        &numbers::controllers(),
        &measurement::NUMBERS,
        &figures::figures(),
        &inputs::GROUND,
        &outputs::BELIEF,
        &parameters::ADDED_TABLE,
    ];
    const ARRAYS: &'static [&'static [Array]] = &[
        arrays::REFERENCE,
        inputs::ARRAYS,
        outputs::ARRAYS,
        arrays::STEERING,
        arrays::AIRFRAME,
        arrays::CONTROLLERS,
    ];
    const QUANTITIES: &'static [&'static Quantity] = quantities::ALL;
    const TERMINALS: &'static [Terminal] =
        &[terminals::REFERENCE, terminals::MEASURED_MOTION, terminals::ACTUATION];
    type Parameters = ControllerParameters;
    type Inputs = ControllerInputs;
    type State = ControllerState;
    type Outputs = ControllerOutputs;
    type Error = ControllerError;

    fn as_read(parameters: &ControllerParameters) -> Cow<'_, ControllerParameters> {
        parameters.as_read()
    }

    fn out_of_range(variable: &Variable<Self>, value: f64, minimum: f64, maximum: f64) -> (String, String) {
        ranges::out_of_range(variable, value, minimum, maximum)
    }

    fn share() -> Box<dyn Any> {
        designs::share()
    }

    fn new(parameters: &ControllerParameters, inputs: &ControllerInputs) -> Result<Self, ControllerError> {
        let configuration = parameters.resolved()?;
        let measurements = parameters.measurements;
        let rotors = PredictedRotors::new(&configuration.airframe, inputs.armed);
        let mut measured = measurement_of(measurements, inputs, &rotors, 0)?;
        let design = designs::design(&configuration)?;
        let control = ControlLoop::prepared(&design, &inputs.control(), &mut measured, 0)?;
        Ok(Self { control, measurements, rotors, time_us: 0 })
    }

    fn from_state(
        parameters: &ControllerParameters,
        state: &ControllerState,
    ) -> Result<Self, ControllerError> {
        state.check()?;
        let control = ControlLoop::resumed(&designs::design(&parameters.resolved()?)?, state.control)?;
        let ControllerState { rotors, time_us, .. } = *state;
        Ok(Self { control, measurements: parameters.measurements, rotors, time_us })
    }

    fn state(&self) -> ControllerState {
        ControllerState { control: *self.control.state(), rotors: self.rotors, time_us: self.time_us }
    }

    fn time_us(&self) -> u64 {
        self.time_us
    }

    fn advance_to(
        &mut self,
        time_us: u64,
        inputs: &impl Fn(u64) -> ControllerInputs,
    ) -> Result<(), ControllerError> {
        if time_us < self.time_us {
            return Err(ControllerError::Backwards { time_us: self.time_us, requested_us: time_us });
        }
        // An instant at the goal belongs to the next step, whose inputs apply from there on.
        while self.control.next_sample_us() < time_us {
            let instant_us = self.control.next_sample_us();
            self.sample(instant_us, &inputs(instant_us))?;
            self.time_us = instant_us;
        }
        self.time_us = time_us;
        Ok(())
    }

    fn outputs(&self) -> ControllerOutputs {
        let state = self.control.state();
        ControllerOutputs {
            rotor_command_rad_s: state.rotor_command_rad_s(),
            wrench: state.commanded_wrench(),
            tilt_reference_rad: state.tilt_reference_rad(),
            setpoint: state.reference(self.time_us),
            activity: state.activity(),
            belief: self.control.belief(),
        }
    }

    fn retune(&mut self, parameters: &ControllerParameters) -> Result<(), ControllerError> {
        self.control.reconfigure(&parameters.resolved()?)?;
        self.measurements = parameters.measurements;
        Ok(())
    }

    /// The controllers are the same: no need to design them again.
    fn restore(
        &mut self,
        parameters: &ControllerParameters,
        state: &ControllerState,
    ) -> Result<(), ControllerError> {
        state.check()?;
        self.control.restore(state.control)?;
        self.measurements = parameters.measurements;
        (self.rotors, self.time_us) = (state.rotors, state.time_us);
        Ok(())
    }

    fn warnings(&self) -> Vec<String> {
        self.control.stability().warnings().iter().map(ToString::to_string).collect()
    }

    /// A master that couples controllers and vehicle with long steps makes each sample act on an old measurement.
    fn warning_of_step(&self, step_us: u64) -> Option<String> {
        let sample_us = self.configuration().controllers.attitude.sample_time_us;
        if step_us <= MOST_SAMPLES * sample_us {
            return None;
        }
        let [step_s, sample_s] = [step_us, sample_us].map(|time_us| time_us as f64 / 1e6);
        Some(format!(
            "a communication step of {step_s} s is much longer than the attitude controller's sample time, {sample_s} s: samples within it \
             act on measurements that are up to {step_s} s old, by which a vehicle can be lost; use steps of at most {sample_s} s"
        ))
    }

    fn initialized(&self) -> String {
        figures::initialized(self.control.design())
    }
}
