//! A vehicle whose simulation fails: it ends alone, the others fly on.

use std::fmt;
use std::time::Instant;

use vehicle::FlightError;

use super::Fleet;

/// A vehicle whose simulation failed, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Loss {
    /// System id of the vehicle.
    pub system_id: u8,
    /// Why.
    pub error: FlightError,
}

impl fmt::Display for Loss {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "system {}: {}", self.system_id, self.error)
    }
}

impl Fleet {
    /// The simulation of a vehicle has failed: its clients are told and hear no more of it, and its files end.
    pub(super) fn lose(&mut self, number: usize, error: FlightError, now: Instant) {
        let Some(member) = self.members.get_mut(number) else { return };
        let loss = Loss { system_id: member.autopilot.system_id(), error };
        tracing::error!("{loss}; the simulation of this vehicle has ended");
        self.books.failure(number, member.time_us(), member.digest());
        member.autopilot.give_up();
        self.send(number, now);
        if let Some(member) = self.members.get_mut(number) {
            member.end(loss, now);
        }
    }
}
