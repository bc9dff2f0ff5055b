//! What the plant is.

use quadrotor::{Configuration, Configured, InitialState, PlantState};
use serde::{Deserialize, Serialize};

/// What drives the plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Drive {
    /// Commanded speeds of the rotors, which follow with their lag.
    RotorSpeeds,
    /// Thrust and torques at once.
    Wrench,
}

/// All parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Airframe, environment and start; limits and controllers have no effect.
    pub configuration: Configuration,
    /// What drives it.
    pub drive: Drive,
    /// Whether the rotors carry the weight at the start.
    pub hovering: bool,
}

/// The paper's vehicle, hovering, driven by its rotors.
impl Default for Settings {
    fn default() -> Self {
        Self { configuration: Configuration::default(), drive: Drive::RotorSpeeds, hovering: true }
    }
}

impl Configured for Settings {
    fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    fn configuration_mut(&mut self) -> &mut Configuration {
        &mut self.configuration
    }
}

impl Settings {
    /// The configuration with the preset's airframe, as it flies.
    pub(super) fn flown(&self) -> Configuration {
        self.configuration.with_airframe()
    }

    /// The values as they read: those that fly, under the preset's own name.
    pub(super) fn as_read(&self) -> Self {
        let configuration = Configuration { preset: self.configuration.preset, ..self.flown() };
        Self { configuration, ..*self }
    }

    /// Where a flight begins. What has thrust and torques in place of its rotors has rotors at rest.
    pub(super) fn start(&self) -> PlantState {
        let Configuration { airframe, initial, .. } = self.flown();
        let initial: &InitialState = &initial;
        if self.hovering && self.drive == Drive::RotorSpeeds {
            PlantState::hovering(initial, &airframe)
        } else {
            PlantState::at_rest(initial)
        }
    }
}
