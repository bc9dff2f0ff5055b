//! Units that break, and are mended: at once or at given times.

use std::collections::VecDeque;

use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;
use crate::fault::{Fault, Faults, ScheduledFault};

/// What is broken, and what is to break.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Injection {
    faults: Faults,
    /// Those to come, the next one first.
    scheduled: VecDeque<ScheduledFault>,
}

impl Injection {
    /// Everything works, until the schedule says otherwise.
    pub fn new(mut scheduled: Vec<ScheduledFault>) -> Self {
        scheduled.sort_by_key(|fault| fault.time_us);
        Self { faults: Faults::default(), scheduled: scheduled.into() }
    }

    /// Everything that is broken now.
    pub fn faults(&self) -> &Faults {
        &self.faults
    }

    /// Breaks and mends what is due by the schedule.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let is_due = |next: &&ScheduledFault| next.time_us <= situation.time_us;
        while let Some(scheduled) = self.scheduled.front().filter(is_due).copied() {
            self.scheduled.pop_front();
            self.inject(&scheduled.fault, proposal);
        }
    }

    /// Breaks a unit, or mends it.
    pub fn inject(&mut self, fault: &Fault, proposal: &mut Proposal) {
        self.faults.set(fault);
        proposal.say(Severity::Warning, format!("Failure injected: {fault}"));
    }
}
