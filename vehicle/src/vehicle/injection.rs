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

    /// Whether nothing is broken, and nothing is to break.
    pub fn is_over(&self) -> bool {
        self.scheduled.is_empty() && self.faults == Faults::default()
    }

    /// Whether the schedule has something for a time, µs.
    pub fn is_due(&self, time_us: u64) -> bool {
        self.scheduled.front().is_some_and(|next| next.time_us <= time_us)
    }

    /// Breaks and mends what is due by the schedule.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        while self.is_due(situation.time_us) {
            let Some(scheduled) = self.scheduled.pop_front() else { return };
            self.inject(&scheduled.fault, proposal);
        }
    }

    /// Breaks a unit, or mends it.
    pub fn inject(&mut self, fault: &Fault, proposal: &mut Proposal) {
        self.faults.set(fault);
        proposal.say(Severity::Warning, format!("Failure injected: {fault}"));
    }
}
