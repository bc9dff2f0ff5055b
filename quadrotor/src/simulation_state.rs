//! Everything that changes during a flight.

use serde::{Deserialize, Serialize};

use crate::control::control_state::ControlState;
use crate::control::instants::LATEST_US;
use crate::schedule::{next_look_us, next_point_us};
use crate::sensors::NoiseState;
use crate::{
    Airframe, Configuration, ConfigurationError, Disturbance, Inputs, Overload, Plant, PlantInputs,
    PlantState, RigidBody, RotorFault,
};

/// Everything that changes during a flight, and all there is to save and restore.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulationState {
    pub(crate) world: World,
    pub(crate) control: ControlState,
}

/// The same where it is. It is written like a copy.
#[derive(Serialize)]
pub(crate) struct StateInPlace<'a> {
    pub(crate) world: &'a World,
    pub(crate) control: &'a ControlState,
}

/// What changes beside the control loop: the plant, what acts on it, and the sensors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct World {
    /// The present, µs after the start.
    pub(crate) time_us: u64,
    /// The last event, at or before the present: the plant's state is the one there.
    pub(crate) event_us: u64,
    pub(crate) plant: PlantState,
    disturbance: Disturbance,
    rotor_faults: [Option<RotorFault>; 4],
    /// z of the ground below, NED, m.
    ground_z_m: f64,
    /// What the controllers take the vehicle's motion for, if somebody outside estimates it.
    pub(crate) estimate: Option<RigidBody>,
    pub(crate) noise: NoiseState,
}

impl World {
    /// The world at the start of a flight.
    pub(crate) fn new(configuration: &Configuration, inputs: &Inputs) -> Self {
        let initial = &configuration.initial;
        let plant = if inputs.armed {
            PlantState::hovering(initial, &configuration.airframe)
        } else {
            PlantState::at_rest(initial)
        };
        Self {
            time_us: 0,
            event_us: 0,
            plant,
            disturbance: inputs.disturbance,
            rotor_faults: inputs.rotor_faults,
            ground_z_m: inputs.ground_z_m,
            estimate: inputs.estimate,
            noise: NoiseState::default(),
        }
    }

    /// Takes in what acts on the plant and the sensors from now on.
    pub(crate) fn take(&mut self, inputs: &Inputs) {
        self.disturbance = inputs.disturbance;
        self.rotor_faults = inputs.rotor_faults;
        self.ground_z_m = inputs.ground_z_m;
        self.estimate = inputs.estimate;
    }

    /// Whether these inputs act on the plant as what acts on it already.
    pub(crate) fn is_acted_on_as_by(&self, inputs: &Inputs) -> bool {
        self.ground_z_m == inputs.ground_z_m
            && self.disturbance == inputs.disturbance
            && self.rotor_faults == inputs.rotor_faults
    }

    /// What acts on the plant and is stronger than its rotors.
    pub(crate) fn overload(&self, airframe: &Airframe) -> Option<Overload> {
        self.disturbance.overload(airframe)
    }

    /// What acts on the plant under these rotor commands, rad/s. Disarmed, broken rotors come to rest as all do.
    pub(crate) fn plant_inputs(&self, command_rad_s: [f64; 4], armed: bool) -> PlantInputs {
        PlantInputs {
            disturbance: self.disturbance,
            rotor_faults: if armed { self.rotor_faults } else { [None; 4] },
            ground_z_m: self.ground_z_m,
            ..PlantInputs::rotor_speeds(command_rad_s)
        }
    }
}

impl SimulationState {
    /// Whether a flight can have been in this state: saved states may come from anywhere.
    pub(crate) fn check(
        &self,
        configuration: &Configuration,
        plant: &Plant,
    ) -> Result<(), ConfigurationError> {
        let wrong = |reason| Err(ConfigurationError::State { reason });
        let World { time_us, event_us, .. } = self.world;
        if time_us > LATEST_US || event_us > time_us {
            return wrong("its last event lies in the future");
        }
        let inputs = self.world.plant_inputs(self.control.rotor_command_rad_s(), self.control.is_armed());
        let (point_us, look_us) =
            (next_point_us(event_us, plant, (&self.world.plant, &inputs)), self.control.next_us());
        if time_us > event_us && time_us > point_us.min(look_us) {
            return wrong("its last event is not the last");
        }
        if look_us < event_us || look_us > next_look_us(time_us) {
            return wrong("its controllers do not sample when they would");
        }
        if !self.world.ground_z_m.is_finite() {
            return wrong("its ground is not at a finite height");
        }
        if self.world.plant.has_diverged() {
            return wrong("its plant is not finite, or beyond what a vehicle can reach");
        }
        self.control.check(configuration)
    }
}
