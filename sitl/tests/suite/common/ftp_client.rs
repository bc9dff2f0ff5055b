//! A client of MAVLink FTP.

use std::path::Path;

use autopilot::codec::Message;
use autopilot::file_work::Immediate;
use mavlink::dialects::ardupilotmega::{FILE_TRANSFER_PROTOCOL_DATA, MavMessage};
use sitl::files::Disk;
use vehicle::identity::Identity;

use super::Bench;

/// Requests.
pub const TERMINATE: u8 = 1;
pub const RESET: u8 = 2;
pub const LIST: u8 = 3;
pub const OPEN: u8 = 4;
pub const READ: u8 = 5;
pub const CREATE: u8 = 6;
pub const WRITE: u8 = 7;
pub const REMOVE: u8 = 8;
pub const MAKE_FOLDER: u8 = 9;
pub const REMOVE_FOLDER: u8 = 10;
pub const OPEN_TO_WRITE: u8 = 11;
pub const TRUNCATE: u8 = 12;
pub const RENAME: u8 = 13;
pub const CHECKSUM: u8 = 14;
pub const BURST: u8 = 15;

/// Errors.
pub const FAIL: u8 = 1;
pub const ERRNO: u8 = 2;
pub const INVALID_SESSION: u8 = 4;
pub const END: u8 = 6;
pub const UNKNOWN: u8 = 7;
pub const EXISTS: u8 = 8;
pub const PROTECTED: u8 = 9;
pub const NOT_FOUND: u8 = 10;

/// An answer: its sequence, its session, its offset, whether it ends a burst, and data or an error.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    pub sequence: u16,
    pub opcode: u8,
    pub offset: u32,
    pub last: bool,
    pub result: Result<Vec<u8>, u8>,
}

pub fn request(sequence: u16, opcode: u8, session: u8, size: u8, offset: u32, data: &[u8]) -> MavMessage {
    let mut payload = [0; 251];
    let [low, high] = sequence.to_le_bytes();
    let [a, b, c, d] = offset.to_le_bytes();
    let header = [low, high, session, opcode, size, 0, 0, 0, a, b, c, d];
    for (byte, given) in payload.iter_mut().zip(header.iter().chain(data)) {
        *byte = *given;
    }
    let (target_system, target_component) = (1, 1);
    MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA {
        target_network: 0,
        target_system,
        target_component,
        payload,
    })
}

pub fn answers(heard: &[Message]) -> Vec<Answer> {
    let answer = |message: &Message| match message {
        Message::Typed(MavMessage::FILE_TRANSFER_PROTOCOL(answer)) => {
            let [low, high, _, kind, size, opcode, last, _, a, b, c, d] =
                *answer.payload.first_chunk::<12>().expect("a header");
            let data = answer.payload[12..12 + usize::from(size)].to_vec();
            Some(Answer {
                sequence: u16::from_le_bytes([low, high]),
                opcode,
                offset: u32::from_le_bytes([a, b, c, d]),
                last: last == 1,
                result: if kind == 128 { Ok(data) } else { Err(data[0]) },
            })
        }
        _ => None,
    };
    heard.iter().filter_map(answer).collect()
}

/// A client of a vehicle that shares a folder.
pub struct Client {
    pub bench: Bench,
    pub sequence: u16,
}

impl Client {
    pub fn of(files: Disk) -> Self {
        let mut bench = Bench::new(Identity::Px4);
        bench.autopilot.share(Box::new(Immediate(files)));
        Self { bench, sequence: 0 }
    }

    pub fn sharing(folder: &Path, writable: bool) -> Self {
        Self::of(Disk::open(None, Some(&(folder.to_owned(), writable))).expect("a folder"))
    }

    pub fn ask(&mut self, opcode: u8, offset: u32, data: &[u8]) -> Result<Vec<u8>, u8> {
        self.sequence = self.sequence.wrapping_add(2);
        self.bench.heard.clear();
        self.bench.send(request(self.sequence, opcode, 0, data.len() as u8, offset, data));
        let answers = answers(&self.bench.heard);
        assert_eq!(answers.len(), 1, "{answers:?}");
        assert_eq!((answers[0].sequence, answers[0].opcode), (self.sequence + 1, opcode));
        answers[0].result.clone()
    }

    pub fn on(&mut self, opcode: u8, path: &str) -> Result<Vec<u8>, u8> {
        self.ask(opcode, 0, path.as_bytes())
    }

    /// All of a file, as small clients read it.
    pub fn read(&mut self, path: &str) -> Result<Vec<u8>, u8> {
        let size = self.on(OPEN, path)?;
        let size = u32::from_le_bytes(size.try_into().expect("a size"));
        let mut content = Vec::new();
        loop {
            let piece = [0; 100];
            match self.ask(READ, content.len() as u32, &piece) {
                Ok(piece) => content.extend(piece),
                Err(END) => break,
                Err(code) => return Err(code),
            }
        }
        assert_eq!(content.len(), size as usize);
        self.ask(TERMINATE, 0, &[])?;
        Ok(content)
    }

    pub fn list(&mut self, path: &str) -> Result<Vec<String>, u8> {
        let mut entries = Vec::new();
        loop {
            match self.ask(LIST, entries.len() as u32, path.as_bytes()) {
                Ok(data) => {
                    let text = String::from_utf8(data).expect("text");
                    entries.extend(text.split_terminator('\0').map(str::to_owned));
                }
                Err(END) => return Ok(entries),
                Err(code) => return Err(code),
            }
        }
    }
}

/// Bytes in which every place is different from its neighbours.
pub fn noise(length: usize) -> Vec<u8> {
    let mut state = 1_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 56) as u8
    };
    (0..length).map(|_| next()).collect()
}

/// Bit by bit, as the polynomial says.
pub fn crc32(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0, |crc, byte| {
        (0..8).fold(
            crc ^ u32::from(*byte),
            |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 },
        )
    })
}
