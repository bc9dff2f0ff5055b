//! The plant as an FMI model, over [`quadrotor::PlantSimulation`].

use std::borrow::Cow;

use fmi::variables::{Array, Terminal, Variable};
use fmi::{Continuous, Identity, Model};
use quadrotor::{PlantInputs, PlantMode, PlantSimulation, PlantSimulationState};
use serde::{Deserialize, Serialize};

use super::commands::Commands;
use super::equations::Equations;
use super::observed::Observed;
use super::settings::{Drive, Settings};
use super::{identity, inputs, outputs, parameters};
use crate::flight_error::FlightError;
use crate::tables::terminals;
use crate::tables::{arrays, numbers, ranges};

/// The quadrotor without its controllers.
pub struct QuadrotorPlant {
    pub(super) simulation: PlantSimulation,
    pub(super) drive: Drive,
    /// Once an importer's solver has gone through an event: the mode since then.
    pub(super) mode: Option<PlantMode>,
}

/// Everything that changes during a flight.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    simulation: PlantSimulationState,
    mode: Option<PlantMode>,
}

impl QuadrotorPlant {
    /// What acts on the plant under these inputs.
    pub(super) fn acting(&self, commands: &Commands) -> PlantInputs {
        commands.acting(self.drive)
    }

    /// The mode since the last event, or the one that the present state is in.
    pub(super) fn mode(&self, inputs: &PlantInputs) -> PlantMode {
        let natural = || self.simulation.plant().mode(&self.simulation.plant_state(), inputs);
        self.mode.unwrap_or_else(natural)
    }
}

impl Model for QuadrotorPlant {
    const IDENTITY: Identity = identity::IDENTITY;
    const VARIABLES: &'static [&'static [Variable<Self>]] = &[
        &inputs::COMMANDS,
        &inputs::DISTURBANCE,
        &outputs::MOTION,
        &outputs::DISCHARGE,
        &outputs::DERIVATIVES,
        &parameters::OWN,
        &parameters::TABLE,
        &numbers::airframe(),
        &parameters::NUMBERS,
        &inputs::GROUND,
    ];
    const ARRAYS: &'static [&'static [Array]] = &[
        inputs::ARRAYS,
        arrays::DISTURBANCE,
        arrays::MOTION,
        outputs::ARRAYS,
        arrays::AIRFRAME,
        arrays::AIRFRAME_OF_PLANT,
        arrays::INITIAL,
    ];
    const CONTINUOUS: Option<&'static dyn Continuous<Self>> = Some(&Equations);
    const OUTPUT_RATES: Option<fn(&Self) -> Observed> = Some(Self::rates);
    const TERMINALS: &'static [Terminal] = &[terminals::ACTUATION, terminals::DISTURBANCE, terminals::MOTION];
    type Parameters = Settings;
    type Inputs = Commands;
    type State = Run;
    type Outputs = Observed;
    type Error = FlightError;

    fn as_read(settings: &Settings) -> Cow<'_, Settings> {
        Cow::Owned(settings.as_read())
    }

    fn out_of_range(variable: &Variable<Self>, value: f64, minimum: f64, maximum: f64) -> (String, String) {
        ranges::out_of_range(variable, value, minimum, maximum)
    }

    fn new(settings: &Settings, commands: &Commands) -> Result<Self, FlightError> {
        let inputs = commands.acting(settings.drive);
        let simulation = PlantSimulation::new(&settings.flown(), &settings.start(), &inputs)?;
        Ok(Self { simulation, drive: settings.drive, mode: None })
    }

    fn from_state(settings: &Settings, run: &Run) -> Result<Self, FlightError> {
        let simulation = PlantSimulation::from_state(&settings.flown(), run.simulation)?;
        Ok(Self { simulation, drive: settings.drive, mode: run.mode })
    }

    fn state(&self) -> Run {
        Run { simulation: self.simulation.state(), mode: self.mode }
    }

    fn time_us(&self) -> u64 {
        self.simulation.time_us()
    }

    fn advance_to(&mut self, time_us: u64, inputs: &impl Fn(u64) -> Commands) -> Result<(), FlightError> {
        let drive = self.drive;
        Ok(self.simulation.advance_to(time_us, &|time_us| inputs(time_us).acting(drive))?)
    }

    fn outputs(&self) -> Observed {
        let (state, inputs) = (self.simulation.plant_state(), self.simulation.inputs());
        Observed::by_steps(self.simulation.plant(), self.mode(inputs), &state, inputs)
    }

    fn retune(&mut self, settings: &Settings) -> Result<(), FlightError> {
        Ok(self.simulation.reconfigure(&settings.flown())?)
    }
}

impl QuadrotorPlant {
    /// Time derivatives of all outputs under the inputs that act.
    fn rates(&self) -> Observed {
        let (plant, state, inputs) =
            (self.simulation.plant(), self.simulation.plant_state(), self.simulation.inputs());
        let mode = self.mode(inputs);
        let moving = state.with_seed(&plant.derivative_in(mode, &state, inputs));
        Observed::by_steps(plant, mode, &moving, &inputs.constant()).tangent()
    }
}
