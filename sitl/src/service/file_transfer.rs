//! MAVLink FTP: the parameters as a file, and a prompt refusal of everything else.

mod parameter_pack;

use mavlink::dialects::common::{FILE_TRANSFER_PROTOCOL_DATA, MavMessage};

use super::{Destination, Origin};
use crate::autopilot::Autopilot;
use crate::codec::{Frame, Payload};

/// The one file.
const PARAMETER_FILE: &str = "@PARAM/param.pck";
/// Its directory.
const PARAMETER_DIRECTORY: &str = "@PARAM";
/// Data bytes of one message.
const DATA: usize = 239;
/// Messages of one answer to a burst.
const BURST: usize = 64;
/// Open files at the same time; the oldest makes room.
const SESSIONS: usize = 8;

mod opcode {
    pub const NONE: u8 = 0;
    pub const TERMINATE_SESSION: u8 = 1;
    pub const RESET_SESSIONS: u8 = 2;
    pub const LIST_DIRECTORY: u8 = 3;
    pub const OPEN_FILE_RO: u8 = 4;
    pub const READ_FILE: u8 = 5;
    pub const CALC_FILE_CRC32: u8 = 14;
    pub const BURST_READ_FILE: u8 = 15;
    pub const ACK: u8 = 128;
    pub const NAK: u8 = 129;
}

mod nak {
    pub const INVALID_SESSION: u8 = 4;
    pub const END_OF_FILE: u8 = 6;
    pub const UNKNOWN_COMMAND: u8 = 7;
    pub const FILE_NOT_FOUND: u8 = 10;
}

/// An open file: its bytes as they were when it was opened.
#[derive(Clone, Debug)]
struct Session {
    number: u8,
    client: (u8, u8),
    content: Vec<u8>,
}

/// Open files.
#[derive(Clone, Debug, Default)]
pub struct FileServer {
    sessions: Vec<Session>,
}

/// A request: header of 12 bytes, then data.
struct Request<'a> {
    sequence: u16,
    session: u8,
    opcode: u8,
    size: u8,
    offset: u32,
    payload: Payload<'a>,
}

impl Request<'_> {
    /// First byte of the header in the message.
    const HEADER: usize = 3;

    fn path(&self) -> String {
        let bytes: [u8; DATA] = self.payload.bytes(Self::HEADER + 12);
        let used =
            bytes.iter().take(usize::from(self.size)).take_while(|byte| **byte != 0).copied().collect();
        String::from_utf8(used).unwrap_or_default()
    }
}

/// An answer.
struct Reply {
    result: Result<Vec<u8>, u8>,
    session: u8,
    offset: u32,
    burst_complete: bool,
}

/// Answers a request.
pub fn handle(autopilot: &mut Autopilot, origin: &Origin, frame: &Frame) {
    let payload = frame.payload();
    let at = Request::HEADER;
    let request = Request {
        sequence: payload.u16(at),
        session: payload.u8(at + 2),
        opcode: payload.u8(at + 3),
        size: payload.u8(at + 4),
        offset: payload.u32(at + 8),
        payload,
    };
    // What is an answer is none of ours: two servers would talk for ever.
    if request.opcode >= opcode::ACK {
        return;
    }
    let mut sequence = request.sequence;
    for reply in replies(autopilot, origin, &request) {
        sequence = sequence.wrapping_add(1);
        let message = encode(origin, &request, &reply, sequence);
        autopilot.send(Destination::Peer(origin.peer), message);
    }
}

fn replies(autopilot: &mut Autopilot, origin: &Origin, request: &Request<'_>) -> Vec<Reply> {
    let client = (origin.system, origin.component);
    let reply = |result| {
        vec![Reply { result, session: request.session, offset: request.offset, burst_complete: false }]
    };
    match request.opcode {
        opcode::NONE => reply(Ok(Vec::new())),
        opcode::TERMINATE_SESSION => {
            autopilot.files.sessions.retain(|open| open.number != request.session || open.client != client);
            reply(Ok(Vec::new()))
        }
        opcode::RESET_SESSIONS => {
            autopilot.files.sessions.retain(|open| open.client != client);
            reply(Ok(Vec::new()))
        }
        opcode::LIST_DIRECTORY => reply(list(&request.path(), request.offset)),
        opcode::OPEN_FILE_RO => vec![open(autopilot, client, request)],
        opcode::CALC_FILE_CRC32 => reply(match file(autopilot, &request.path()) {
            Some(content) => Ok(checksum(&content).to_le_bytes().to_vec()),
            None => Err(nak::FILE_NOT_FOUND),
        }),
        opcode::READ_FILE | opcode::BURST_READ_FILE => {
            let sessions = &autopilot.files.sessions;
            match sessions.iter().find(|open| open.number == request.session && open.client == client) {
                Some(session) => read(session, request),
                None => reply(Err(nak::INVALID_SESSION)),
            }
        }
        _ => reply(Err(nak::UNKNOWN_COMMAND)),
    }
}

fn open(autopilot: &mut Autopilot, client: (u8, u8), request: &Request<'_>) -> Reply {
    let refused =
        |code| Reply { result: Err(code), session: request.session, offset: 0, burst_complete: false };
    let Some(content) = file(autopilot, &request.path()) else { return refused(nak::FILE_NOT_FOUND) };
    let files = &mut autopilot.files;
    // The number is the client's choice, and each has its own: some clients tell their transfers apart by it. A second
    // request under the same number is a retry whose answer was lost.
    files.sessions.retain(|open| (open.client, open.number) != (client, request.session));
    if files.sessions.len() >= SESSIONS {
        // Somebody has left without closing.
        files.sessions.remove(0);
    }
    let size = content.len() as u32;
    files.sessions.push(Session { number: request.session, client, content });
    Reply {
        result: Ok(size.to_le_bytes().to_vec()),
        session: request.session,
        offset: 0,
        burst_complete: false,
    }
}

/// Pieces of a file from the offset on: one, or a burst of them.
fn read(session: &Session, request: &Request<'_>) -> Vec<Reply> {
    let size = usize::from(request.size).clamp(1, DATA);
    let start = request.offset as usize;
    let rest = session.content.get(start..).unwrap_or_default();
    if rest.is_empty() {
        let result = Err(nak::END_OF_FILE);
        return vec![Reply {
            result,
            session: session.number,
            offset: request.offset,
            burst_complete: false,
        }];
    }
    let burst = request.opcode == opcode::BURST_READ_FILE;
    let count = if burst { BURST } else { 1 };
    let pieces: Vec<&[u8]> = rest.chunks(size).take(count).collect();
    let last = pieces.len() - 1;
    let reply = |(index, piece): (usize, &&[u8])| Reply {
        result: Ok(piece.to_vec()),
        session: session.number,
        offset: (start + index * size) as u32,
        burst_complete: burst && index == last,
    };
    pieces.iter().enumerate().map(reply).collect()
}

fn list(path: &str, offset: u32) -> Result<Vec<u8>, u8> {
    if path.trim_end_matches('/') != PARAMETER_DIRECTORY {
        return Err(nak::FILE_NOT_FOUND);
    }
    if offset == 0 { Ok(b"Fparam.pck\t0\0".to_vec()) } else { Err(nak::END_OF_FILE) }
}

/// The content of a file. Paths are compared, never opened: nothing on the disk can be reached.
fn file(autopilot: &Autopilot, path: &str) -> Option<Vec<u8>> {
    let name = path.split('?').next().unwrap_or_default();
    (name == PARAMETER_FILE).then(|| parameter_pack::pack(autopilot))
}

/// CRC-32 of the protocol: begins with zero and is not inverted.
fn checksum(content: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new_with_initial(u32::MAX);
    hasher.update(content);
    !hasher.finalize()
}

fn encode(origin: &Origin, request: &Request<'_>, reply: &Reply, sequence: u16) -> MavMessage {
    let (kind, data) = match &reply.result {
        Ok(data) => (opcode::ACK, data.clone()),
        Err(code) => (opcode::NAK, vec![*code]),
    };
    let [low, high] = sequence.to_le_bytes();
    let [a, b, c, d] = reply.offset.to_le_bytes();
    let complete = u8::from(reply.burst_complete);
    let header = [low, high, reply.session, kind, data.len() as u8, request.opcode, complete, 0, a, b, c, d];
    let mut payload = [0; 251];
    for (byte, given) in payload.iter_mut().zip(header.iter().chain(&data)) {
        *byte = *given;
    }
    MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA {
        target_network: 0,
        target_system: origin.system,
        target_component: origin.component,
        payload,
    })
}
