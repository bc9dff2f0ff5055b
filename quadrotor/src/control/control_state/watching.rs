//! What a control loop does at instants at which no controller samples.

use super::{ControlState, check};
use crate::control::control_inputs::{ControlInputs, ControlLaw, Target};
use crate::control::instants::Clocks;
use crate::design::loop_design::LoopDesign;
use crate::{ControlError, Inputs};

impl ControlState {
    /// Whether nothing but time goes on at its next instant under a reference: no controller samples, and it is shaped already.
    pub(crate) fn waits(&self) -> bool {
        let flies_a_reference = self.armed && !self.engage && self.law == ControlLaw::Cascade;
        self.next_us < self.sample_us && flies_a_reference && self.guidance.is_shaped()
    }

    /// Goes on to the instant after the next one while it [waits](Self::waits).
    pub(crate) fn wait(&mut self) {
        self.next_us = Clocks::next_instant_us(self.next_us, self.sample_us);
    }

    /// Goes on to the first instant at `time_us` or later, or to the next sample of a controller, while it [waits](Self::waits).
    pub(crate) fn wait_until(&mut self, time_us: u64) {
        self.next_us = Clocks::instant_from(time_us, self.sample_us);
    }

    /// Whether a controller samples at `time_us`, at its next instant or before it.
    pub(crate) fn is_due(&self, time_us: u64) -> bool {
        self.sample_us <= time_us
    }

    /// Whether these inputs leave it nothing to do at an instant at which no controller samples but to watch its reference.
    pub(crate) fn only_watches(&self, inputs: &Inputs) -> bool {
        inputs.armed == self.armed && !(self.armed && self.takes_over_for(inputs.law()))
    }

    /// Looks at such inputs at its next instant.
    pub(crate) fn watch(&mut self, design: &LoopDesign, inputs: &ControlInputs) -> Result<(), ControlError> {
        check(design, inputs, self.next_us)?;
        self.take_law(&design.configuration, inputs, self.next_us);
        if self.armed
            && let Target::Reference(reference) = &inputs.target
        {
            self.guidance.watch(reference, &design.configuration.limits, self.next_us);
        }
        self.wait();
        Ok(())
    }
}
