//! Download of logs: a list of them, then their bytes, a piece a message, as many as links can take.

use mavlink::dialects::common::{LOG_DATA_DATA, LOG_ENTRY_DATA, MavMessage};
use vehicle::Severity;

use super::Service;
use crate::codec::{Frame, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin, PeerId};
use crate::file_store::{Access, LOGS, Listed, OpenFile};

/// Bytes of a piece.
const PIECE: usize = 90;
/// Downloads at the same time; the oldest makes room.
const MOST: usize = 8;

/// A download.
#[derive(Debug)]
struct Download {
    peer: PeerId,
    id: u16,
    file: Box<dyn OpenFile>,
    next: u32,
    end: u32,
}

/// Logs as they were listed last, by their ids, and downloads of them.
#[derive(Debug, Default)]
pub struct LogServer {
    listed: Vec<Listed>,
    downloads: Vec<Download>,
}

impl Service for LogServer {
    fn messages(&self) -> &'static [u32] {
        &[id::LOG_REQUEST_LIST, id::LOG_REQUEST_DATA, id::LOG_REQUEST_END, id::LOG_ERASE]
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        match frame.message_id() {
            id::LOG_REQUEST_LIST => self.request_list(context, origin, frame),
            id::LOG_REQUEST_DATA => self.request_data(context, origin, frame),
            id::LOG_REQUEST_END => self.request_end(origin),
            _ => self.erase(context, origin),
        }
    }

    /// Sends up to this many pieces, of all downloads in turn, to peers that have room.
    fn transfer(&mut self, context: &mut Context, pieces: usize, has_room: &dyn Fn(PeerId) -> Option<bool>) {
        self.downloads.retain(|download| has_room(download.peer).is_some());
        for _ in 0..pieces {
            let free = |download: &Download| has_room(download.peer) == Some(true);
            let Some(index) = self.downloads.iter().position(free) else { return };
            let mut download = self.downloads.remove(index);
            let piece = next_piece(&mut download);
            let (to, last) = (Destination::Peer(download.peer), usize::from(piece.count) < PIECE);
            if !last && download.next < download.end {
                self.downloads.push(download);
            }
            context.outbox.send(to, MavMessage::LOG_DATA(piece));
        }
    }
}

impl LogServer {
    /// Looks at what there is. Ids stay until somebody asks for the list again.
    fn look(&mut self, context: &mut Context) {
        let listed = context.files.list(LOGS).unwrap_or_default();
        self.listed = listed.into_iter().filter(|log| log.size.is_some()).collect();
    }

    /// LOG_REQUEST_LIST: an entry for each, or one that says that there is none.
    fn request_list(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let (first, last) = (frame.payload().u16(0), frame.payload().u16(2));
        // Asking for some only is asking again: their ids must be the ones that were told.
        if (first, last) == (0, u16::MAX) || self.listed.is_empty() {
            self.look(context);
        }
        let to = Destination::Peer(origin.peer);
        let count = u16::try_from(self.listed.len()).unwrap_or(u16::MAX);
        if count == 0 {
            context.outbox.send(to, MavMessage::LOG_ENTRY(LOG_ENTRY_DATA::default()));
            return;
        }
        let lowest = first_id(context);
        let highest = lowest.saturating_add(count - 1);
        let entries: Vec<LOG_ENTRY_DATA> = (lowest..=highest)
            .zip(&self.listed)
            .filter(|(id, _)| (first..=last).contains(id))
            .map(|(id, log)| LOG_ENTRY_DATA {
                time_utc: u32::try_from(log.modified_unix_s).unwrap_or(u32::MAX),
                size: u32::try_from(log.size.unwrap_or(0)).unwrap_or(u32::MAX),
                id,
                num_logs: count,
                last_log_num: highest,
            })
            .collect();
        for entry in entries {
            context.outbox.send(to, MavMessage::LOG_ENTRY(entry));
        }
    }

    /// LOG_REQUEST_DATA: begins a download, or goes on with it elsewhere.
    fn request_data(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let (offset, count, id) = (frame.payload().u32(0), frame.payload().u32(4), frame.payload().u16(8));
        if self.listed.is_empty() {
            self.look(context);
        }
        let place = id.checked_sub(first_id(context)).map(usize::from);
        let downloads = &mut self.downloads;
        let same = downloads.iter().position(|download| (download.peer, download.id) == (origin.peer, id));
        let file = match same.map(|index| downloads.remove(index).file) {
            Some(file) => Some(file),
            None => place
                .and_then(|place| self.listed.get(place))
                .and_then(|log| context.files.open(&format!("{LOGS}/{}", log.name), Access::Read).ok()),
        };
        // Who asks for what is not there gets an empty piece: the end.
        let Some(file) = file else {
            let piece = LOG_DATA_DATA { ofs: offset, id, count: 0, data: [0; PIECE] };
            context.outbox.send(Destination::Peer(origin.peer), MavMessage::LOG_DATA(piece));
            return;
        };
        let downloads = &mut self.downloads;
        // One peer looks at one log at a time.
        downloads.retain(|download| download.peer != origin.peer);
        if downloads.len() >= MOST {
            downloads.remove(0);
        }
        let end = offset.saturating_add(count);
        downloads.push(Download { peer: origin.peer, id, file, next: offset, end });
    }

    /// LOG_REQUEST_END: no more of it.
    fn request_end(&mut self, origin: &Origin) {
        self.downloads.retain(|download| download.peer != origin.peer);
    }

    /// LOG_ERASE: removes the logs of all flights that are over.
    fn erase(&mut self, context: &mut Context, origin: &Origin) {
        self.downloads.clear();
        self.listed.clear();
        let by = format!("{}/{}", origin.system, origin.component);
        let (severity, text) = match context.files.erase_logs() {
            Ok(()) => (Severity::Info, format!("Logs erased by {by}")),
            Err(error) => (Severity::Warning, format!("Logs not erased: {error}")),
        };
        context.say(severity, &text);
    }
}

/// The id of the first log. Clients expect PX4's to count from zero, and ArduPilot's from one.
fn first_id(context: &Context) -> u16 {
    u16::from(context.identity().is_ardupilot())
}

/// The next piece; one that is not full is the last.
fn next_piece(download: &mut Download) -> LOG_DATA_DATA {
    let mut data = [0; PIECE];
    let wanted = PIECE.min(download.end.saturating_sub(download.next) as usize);
    let into = data.get_mut(..wanted).unwrap_or_default();
    // What cannot be read any more ends here, as for the client.
    let read = download.file.read_at(u64::from(download.next), into).unwrap_or(0);
    let piece = LOG_DATA_DATA { ofs: download.next, id: download.id, count: read as u8, data };
    download.next = download.next.saturating_add(read as u32);
    piece
}
