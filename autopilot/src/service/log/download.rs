//! Downloads of logs: pieces of what has been read ahead.

use mavlink::dialects::ardupilotmega::LOG_DATA_DATA;

use super::job::{AHEAD, Ahead};
use crate::envelope::PeerId;
use crate::turns::Turns;

/// Bytes of a piece.
pub const PIECE: usize = 90;
/// Downloads at the same time; the oldest makes room.
const MOST: usize = 8;

/// A download. Its file is with it, or with the job that reads it.
#[derive(Debug)]
pub struct Download {
    /// Number that no other download has.
    pub number: u64,
    /// Who gets it.
    pub peer: PeerId,
    /// Id of the log.
    pub id: u16,
    /// Name of the log; `None`: there is none with this id, or it is not known yet.
    pub name: Option<String>,
    /// The next byte, and the one behind the last.
    pub next: u32,
    end: u32,
    /// The file with what has been read of it.
    pub ahead: Option<Ahead>,
    /// Whether a job is reading.
    pub reading: bool,
    /// Whether there is nothing to be read.
    pub missing: bool,
}

impl Download {
    /// The next piece, if it has been read; one that is not full is the last.
    fn piece(&self) -> Option<LOG_DATA_DATA> {
        let piece = |bytes: &[u8]| {
            let mut data = [0; PIECE];
            for (byte, read) in data.iter_mut().zip(bytes) {
                *byte = *read;
            }
            LOG_DATA_DATA { ofs: self.next, id: self.id, count: bytes.len().min(PIECE) as u8, data }
        };
        if self.missing {
            return Some(piece(&[]));
        }
        let wanted = PIECE.min(self.end.saturating_sub(self.next) as usize);
        let ahead = self.ahead.as_ref()?;
        let start = usize::try_from(u64::from(self.next).checked_sub(ahead.offset)?).ok()?;
        let rest = ahead.bytes.get(start..)?;
        let at_end = ahead.bytes.len() < AHEAD;
        (at_end || rest.len() >= wanted).then(|| piece(rest.get(..wanted).unwrap_or(rest)))
    }

    /// Whether bytes have to be read before it can go on.
    pub fn is_dry(&self) -> bool {
        !self.reading && self.name.is_some() && self.piece().is_none()
    }
}

/// Downloads, one for each peer.
#[derive(Debug, Default)]
pub struct Downloads {
    all: Vec<Download>,
    next_number: u64,
    turns: Turns,
}

impl Downloads {
    /// Begins a download, or goes on with it elsewhere. One peer looks at one log at a time.
    pub fn begin(&mut self, peer: PeerId, id: u16, range: (u32, u32)) {
        let (offset, count) = range;
        let end = offset.saturating_add(count);
        if let Some(same) = self.all.iter_mut().find(|download| (download.peer, download.id) == (peer, id)) {
            (same.next, same.end) = (offset, end);
            return;
        }
        self.end(peer);
        if self.all.len() >= MOST {
            self.all.remove(0);
        }
        self.next_number += 1;
        self.all.push(Download {
            number: self.next_number,
            peer,
            id,
            name: None,
            next: offset,
            end,
            ahead: None,
            reading: false,
            missing: false,
        });
    }

    /// Whether there is one.
    pub fn are_under_way(&self) -> bool {
        !self.all.is_empty()
    }

    /// Ends the download of a peer.
    pub fn end(&mut self, peer: PeerId) {
        self.all.retain(|download| download.peer != peer);
    }

    /// Ends all downloads.
    pub fn clear(&mut self) {
        self.all.clear();
    }

    /// All of them.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut Download> {
        self.all.iter_mut()
    }

    /// Forgets peers that are gone.
    pub fn retain(&mut self, is_there: impl Fn(PeerId) -> bool) {
        self.all.retain(|download| is_there(download.peer));
    }

    /// Takes in what has been read for a download.
    pub fn take_in(&mut self, number: u64, ahead: Option<Ahead>) {
        let Some(download) = self.all.iter_mut().find(|download| download.number == number) else { return };
        (download.missing, download.reading, download.ahead) = (ahead.is_none(), false, ahead);
    }

    /// The next piece and whom it is for.
    pub fn next(&mut self, is_ready: impl Fn(PeerId) -> bool) -> Option<(PeerId, LOG_DATA_DATA)> {
        let ready = self.all.iter().filter(|download| is_ready(download.peer) && download.piece().is_some());
        let peer = self.turns.next(ready.map(|download| download.peer))?;
        let download = self.all.iter_mut().find(|download| download.peer == peer)?;
        let piece = download.piece()?;
        download.next = download.next.saturating_add(u32::from(piece.count));
        if usize::from(piece.count) < PIECE || download.next >= download.end {
            self.end(peer);
        }
        Some((peer, piece))
    }
}
