//! Who may upload while others want to: an upload that gets on is left alone, one that does not has to give way.

use crate::envelope::PeerId;

/// Time that a client has for itself, µs of the wall clock, and for each item that has come.
const PATIENCE_US: f64 = 10_000_000.0;
const PER_ITEM_US: f64 = 1_000_000.0;
/// Whoever begins again within this time, µs, has not begun anew.
const REMEMBERED_US: u64 = 10_000_000;

/// The latest uploads of a client, however often it began again.
#[derive(Clone, Copy, Debug)]
struct Hold {
    peer: PeerId,
    since_us: u64,
    ended_us: Option<u64>,
}

/// Since when a client has uploads for itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reservation(Option<Hold>);

impl Reservation {
    /// A client begins an upload, perhaps again.
    pub fn begin(&mut self, peer: PeerId, time_us: u64) {
        let is_again = |hold: &Hold| {
            let recent = hold.ended_us.is_none_or(|ended_us| time_us < ended_us + REMEMBERED_US);
            hold.peer == peer && recent
        };
        let since_us = self.0.filter(is_again).map_or(time_us, |hold| hold.since_us);
        self.0 = Some(Hold { peer, since_us, ended_us: None });
    }

    /// An upload is over. A complete one is no reason to hurry the next.
    pub fn end(&mut self, complete: bool, time_us: u64) {
        self.0 = self.0.filter(|_| !complete).map(|hold| Hold { ended_us: Some(time_us), ..hold });
    }

    /// Whether an upload of which so many items have come must give way to another client. Simulation time runs `pace` times as fast as
    /// the clients' clocks.
    pub fn must_yield(&self, items: usize, time_us: u64, pace: f64) -> bool {
        let allowed_us = (PATIENCE_US + items as f64 * PER_ITEM_US) * pace;
        self.0.is_some_and(|hold| time_us.saturating_sub(hold.since_us) as f64 > allowed_us)
    }
}
