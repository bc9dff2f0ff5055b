//! The closed loop as an FMI model, over [`quadrotor::Simulation`].

use std::any::Any;
use std::borrow::Cow;

use fmi::variables::{Array, Quantity, Terminal, Variable};
use fmi::{Identity, Model};
use quadrotor::{CascadeDesign, Configuration, Inputs, Outputs, Simulation, SimulationState};

use super::{identity, inputs, outputs, parameters};
use crate::designs;
use crate::flight_error::FlightError;
use crate::quantities;
use crate::tables::figures::{self, Designed};
use crate::tables::terminals;
use crate::tables::{arrays, numbers, ranges};

/// The quadrotor with its controllers.
pub struct ClosedLoop(Simulation);

impl Designed for ClosedLoop {
    fn design(&self) -> &CascadeDesign {
        self.0.design()
    }
}

impl Model for ClosedLoop {
    const IDENTITY: Identity = identity::IDENTITY;
    /// Time is not among them: in co-simulation nobody needs it, and FMI Library wants a start value that FMI 2.0
    /// forbids.
    const VARIABLES: &'static [&'static [Variable<Self>]] = &[
        &inputs::REFERENCE,
        &inputs::DISTURBANCE,
        &inputs::ARMED,
        &outputs::MOTION,
        &outputs::STEERING,
        &outputs::ERRORS,
        &outputs::ACTIVITY,
        &parameters::TABLE,
        &numbers::airframe(),
        &numbers::controllers(),
        &figures::figures(),
        &inputs::GROUND,
        &outputs::BELIEF,
    ];
    const ARRAYS: &'static [&'static [Array]] = &[
        arrays::REFERENCE,
        arrays::DISTURBANCE,
        arrays::MOTION,
        arrays::STEERING,
        outputs::ARRAYS,
        arrays::AIRFRAME,
        arrays::AIRFRAME_OF_PLANT,
        arrays::INITIAL,
        arrays::CONTROLLERS,
    ];
    const QUANTITIES: &'static [&'static Quantity] = quantities::ALL;
    const TERMINALS: &'static [Terminal] = &[terminals::REFERENCE, terminals::DISTURBANCE, terminals::MOTION];
    type Parameters = Configuration;
    type Inputs = Inputs;
    type State = SimulationState;
    type Outputs = Outputs;
    type Error = FlightError;

    fn as_read(configuration: &Configuration) -> Cow<'_, Configuration> {
        Cow::Owned(configuration.as_read())
    }

    fn out_of_range(variable: &Variable<Self>, value: f64, minimum: f64, maximum: f64) -> (String, String) {
        ranges::out_of_range(variable, value, minimum, maximum)
    }

    fn share() -> Box<dyn Any> {
        designs::share()
    }

    fn new(configuration: &Configuration, inputs: &Inputs) -> Result<Self, FlightError> {
        Ok(Self(Simulation::prepared(&designs::design(&configuration.resolved()?)?, inputs)?))
    }

    fn from_state(configuration: &Configuration, state: &SimulationState) -> Result<Self, FlightError> {
        Ok(Self(Simulation::resumed(&designs::design(&configuration.resolved()?)?, *state)?))
    }

    fn state(&self) -> SimulationState {
        self.0.state()
    }

    fn time_us(&self) -> u64 {
        self.0.time_us()
    }

    fn advance_to(&mut self, time_us: u64, inputs: &impl Fn(u64) -> Inputs) -> Result<(), FlightError> {
        Ok(self.0.advance_to(time_us, inputs)?)
    }

    fn advance_under(&mut self, time_us: u64, inputs: &Inputs) -> Result<(), FlightError> {
        Ok(self.0.advance_to(time_us, inputs)?)
    }

    fn outputs(&self) -> Outputs {
        self.0.outputs()
    }

    fn prompt_outputs(&self) -> Outputs {
        self.0.prompt_outputs()
    }

    fn complete(&self, outputs: &mut Outputs) {
        self.0.complete(outputs);
    }

    fn are_finite(outputs: &Outputs) -> bool {
        outputs::are_finite(outputs)
    }

    fn is_sound(&self) -> bool {
        self.0.is_sound()
    }

    fn retune(&mut self, configuration: &Configuration) -> Result<(), FlightError> {
        Ok(self.0.reconfigure(&configuration.resolved()?)?)
    }

    /// The controllers are the same: no need to design them again.
    fn restore(
        &mut self,
        _configuration: &Configuration,
        state: &SimulationState,
    ) -> Result<(), FlightError> {
        Ok(self.0.restore(*state)?)
    }

    fn warnings(&self) -> Vec<String> {
        self.0.control().stability().warnings().iter().map(ToString::to_string).collect()
    }

    fn initialized(&self) -> String {
        figures::initialized(self.0.design())
    }
}

#[cfg(test)]
mod tests {
    use fmi::Model;
    use quadrotor::{Configuration, Inputs};

    use super::ClosedLoop;

    /// Numbers that are missing are NaN, and those that are there are not touched.
    #[test]
    fn outputs_are_completed_later() {
        let inputs = Inputs::default();
        let mut model = ClosedLoop::new(&Configuration::default(), &inputs).expect("flies");
        for time_us in [0, 700_000, 1_003_000] {
            model.advance_under(time_us, &inputs).expect("the flight goes on");
            let mut outputs = model.prompt_outputs();
            assert!(outputs.setpoint.position_m.x.is_nan() && outputs.tracking_error_m.z.is_nan());
            assert!(outputs.yaw_error_rad.is_nan() && outputs.position_m == model.outputs().position_m);
            model.complete(&mut outputs);
            assert_eq!(outputs, model.outputs());
        }
    }

    #[test]
    fn doubtful_parameters_are_warned_about_and_hopeless_ones_refused() {
        let mut configuration = Configuration::default();
        let mut model = ClosedLoop::new(&configuration, &Inputs::default()).expect("flies");
        assert_eq!(model.warnings(), Vec::<String>::new());
        configuration.sensors.attitude_noise_rad = 0.3;
        model.retune(&configuration).expect("flies");
        assert!(model.warnings().iter().any(|warning| warning.starts_with("measurement noise")));
        configuration.sensors.attitude_noise_rad = 0.0;
        configuration.sensors.body_rate_noise_rad_s = 10.0;
        let refused = model.retune(&configuration).expect_err("lost").to_string();
        assert!(refused.starts_with("sensor.body_rate_noise = 10 rad/s is too much noise"), "{refused}");
        // S singular in floating point was a condition number of +inf.
        configuration = Configuration::default();
        configuration.controllers.position.lambda = 0.6;
        let refused = ClosedLoop::new(&configuration, &Inputs::default()).err().expect("refused").to_string();
        assert!(refused.starts_with("cannot design the position controller: the matrix S"), "{refused}");
    }
}
