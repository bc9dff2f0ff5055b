//! Which law flies a vehicle, and when it takes it over.

use super::ControlState;
use crate::Configuration;
use crate::control::control_inputs::{ControlInputs, ControlLaw};

impl ControlState {
    /// Whether reference and controllers take over the vehicle under these inputs, if they are armed.
    pub(super) fn takes_over(&self, inputs: &ControlInputs) -> bool {
        !self.armed || self.takes_over_for(inputs.target.law())
    }

    /// Whether they do while the rotors turn.
    pub(super) fn takes_over_for(&self, law: ControlLaw) -> bool {
        self.engage || (law != self.law && self.law != ControlLaw::Cascade)
    }

    /// Takes in which law is to fly, and whether its reference is shaped.
    pub(super) fn take_law(&mut self, configuration: &Configuration, inputs: &ControlInputs, time_us: u64) {
        let law = inputs.target.law();
        self.engage |= law != self.law && self.law != ControlLaw::Cascade;
        self.law = law;
        if let Some(shaping) = inputs.shaping.filter(|shaping| *shaping != self.guidance.is_shaped()) {
            let limits = (&self.limits.of_references(configuration), &configuration.response_times());
            self.guidance = self.guidance.switched(limits, shaping, time_us);
        }
    }
}
