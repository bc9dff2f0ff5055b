//! Breaking units and mending them, at once or at given times.

use super::notice::{Refusal, Severity};
use super::state::Vehicle;
use crate::fault::{Fault, Faults};

impl Vehicle {
    /// Everything that is broken now.
    pub fn faults(&self) -> &Faults {
        &self.faults
    }

    /// Breaks a unit, or mends it, as a client asks.
    ///
    /// # Errors
    /// [`Refusal::Denied`] while the parameter SYS_FAILURE_EN forbids it, [`Refusal::Unsupported`] when it would change nothing.
    pub fn inject(&mut self, fault: &Fault) -> Result<(), Refusal> {
        if !self.conduct.failure_injection {
            return Err(Refusal::denied("Failure injection denied: SYS_FAILURE_EN is 0"));
        }
        if self.navigation.is_none() && fault.needs_readings() {
            let reason = "ideal sensors only fall silent: start with --sensors realistic";
            return Err(Refusal::Unsupported(format!("Failure injection: {fault}: {reason}")));
        }
        self.suffer(fault);
        Ok(())
    }

    /// Breaks and mends what is due by the schedule.
    pub(super) fn suffer_scheduled(&mut self) {
        let time_us = self.outputs.time_us;
        while let Some(scheduled) =
            self.scheduled_faults.front().copied().filter(|next| next.time_us <= time_us)
        {
            self.scheduled_faults.pop_front();
            self.suffer(&scheduled.fault);
        }
    }

    fn suffer(&mut self, fault: &Fault) {
        self.faults.set(fault);
        self.say(Severity::Warning, format!("Failure injected: {fault}"));
    }
}
