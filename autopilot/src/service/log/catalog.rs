//! The list of logs with their ids, as it is sent to peers.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::sync::Arc;

use mavlink::dialects::ardupilotmega::LOG_ENTRY_DATA;

use crate::envelope::PeerId;
use crate::file_store::Listed;
use crate::turns::Turns;

/// A list on its way to a peer.
#[derive(Clone, Debug)]
struct Sending {
    logs: Arc<[Listed]>,
    /// Place of the next log, and of the last one.
    next: usize,
    last: usize,
}

/// Logs as they were listed last, by their ids. Ids stay until somebody asks for the whole list again.
#[derive(Clone, Debug, Default)]
pub struct Catalog {
    logs: Arc<[Listed]>,
    known: bool,
    /// Peers that wait for a listing, with the ids that they want.
    waiting: BTreeMap<PeerId, RangeInclusive<u16>>,
    sending: BTreeMap<PeerId, Sending>,
    turns: Turns,
}

impl Catalog {
    /// Whether the logs have been listed and there are any.
    pub fn is_known(&self) -> bool {
        self.known && !self.logs.is_empty()
    }

    /// Whether a peer waits for it, or for the rest of it.
    pub fn is_wanted(&self) -> bool {
        !(self.waiting.is_empty() && self.sending.is_empty())
    }

    /// The log at a place.
    pub fn get(&self, place: usize) -> Option<&Listed> {
        self.logs.get(place)
    }

    /// The logs that there are now.
    pub fn set(&mut self, logs: Vec<Listed>, first_id: u16) {
        (self.logs, self.known) = (logs.into(), true);
        for (peer, ids) in std::mem::take(&mut self.waiting) {
            self.send(peer, &ids, first_id);
        }
    }

    /// Forgets the logs: there are others now.
    pub fn forget(&mut self) {
        (self.logs, self.known) = (Arc::default(), false);
    }

    /// A peer gets the logs of these ids once they have been listed.
    pub fn wait(&mut self, peer: PeerId, ids: RangeInclusive<u16>) {
        self.waiting.insert(peer, ids);
    }

    /// Begins to send the logs of these ids. A second request of a peer begins again.
    pub fn send(&mut self, peer: PeerId, ids: &RangeInclusive<u16>, first_id: u16) {
        let place = |id: u16| usize::from(id.saturating_sub(first_id));
        let (next, last) = (place(*ids.start()), place(*ids.end()));
        if *ids.end() >= first_id {
            self.sending.insert(peer, Sending { logs: Arc::clone(&self.logs), next, last });
        }
    }

    /// Forgets peers that are gone.
    pub fn retain(&mut self, is_there: impl Fn(PeerId) -> bool) {
        self.waiting.retain(|peer, _| is_there(*peer));
        self.sending.retain(|peer, _| is_there(*peer));
    }

    /// The next entry and whom it is for; an entry without an id when there are no logs.
    pub fn next(
        &mut self,
        first_id: u16,
        is_ready: impl Fn(PeerId) -> bool,
    ) -> Option<(PeerId, LOG_ENTRY_DATA)> {
        loop {
            let peer = self.turns.next(self.sending.keys().copied().filter(|peer| is_ready(*peer)))?;
            let sending = self.sending.get_mut(&peer)?;
            let count = sending.logs.len().min(usize::from(u16::MAX - first_id));
            let place = sending.next;
            sending.next += 1;
            if count == 0 {
                self.sending.remove(&peer);
                return Some((peer, LOG_ENTRY_DATA::default()));
            }
            let log = sending.logs.get(place).filter(|_| place < count && place <= sending.last);
            let entry = log.map(|log| LOG_ENTRY_DATA {
                time_utc: u32::try_from(log.modified_unix_s).unwrap_or(u32::MAX),
                size: u32::try_from(log.size.unwrap_or(0)).unwrap_or(u32::MAX),
                id: first_id + place as u16,
                num_logs: count as u16,
                last_log_num: first_id + (count - 1) as u16,
            });
            match entry {
                Some(entry) => return Some((peer, entry)),
                None => {
                    self.sending.remove(&peer);
                }
            }
        }
    }
}
