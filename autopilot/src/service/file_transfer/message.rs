//! FILE_TRANSFER_PROTOCOL: a header of 12 bytes, then data.

use mavlink::dialects::ardupilotmega::{FILE_TRANSFER_PROTOCOL_DATA, MavMessage};

use crate::codec::{Frame, Payload};
use crate::envelope::Origin;
use crate::file_store::FileError;

/// Data bytes of one message.
pub const DATA: usize = 239;
/// First byte of the header in the message.
const HEADER: usize = 3;
/// Bytes of header and data.
const PAYLOAD: usize = 251;

pub mod opcode {
    pub const NONE: u8 = 0;
    pub const TERMINATE_SESSION: u8 = 1;
    pub const RESET_SESSIONS: u8 = 2;
    pub const LIST_DIRECTORY: u8 = 3;
    pub const OPEN_FILE_RO: u8 = 4;
    pub const READ_FILE: u8 = 5;
    pub const CREATE_FILE: u8 = 6;
    pub const WRITE_FILE: u8 = 7;
    pub const REMOVE_FILE: u8 = 8;
    pub const CREATE_DIRECTORY: u8 = 9;
    pub const REMOVE_DIRECTORY: u8 = 10;
    pub const OPEN_FILE_WO: u8 = 11;
    pub const TRUNCATE_FILE: u8 = 12;
    pub const RENAME: u8 = 13;
    pub const CALC_FILE_CRC32: u8 = 14;
    pub const BURST_READ_FILE: u8 = 15;
    pub const ACK: u8 = 128;
    pub const NAK: u8 = 129;
}

/// Why a request is refused, as the protocol numbers it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nak {
    /// It went wrong.
    Fail,
    /// The file system's own number: no space.
    NoSpace,
    /// The file system's own number: too much is being worked on.
    Busy,
    /// The data are not what the request needs.
    InvalidDataSize,
    /// No file is open under this number.
    InvalidSession,
    /// Others have all of them open.
    NoSessionsAvailable,
    /// There is nothing from this offset on.
    EndOfFile,
    /// There is no such request.
    UnknownCommand,
    /// It exists already.
    FileExists,
    /// It can only be read.
    FileProtected,
    /// It is not there.
    FileNotFound,
}

impl Nak {
    fn data(self) -> Vec<u8> {
        /// ENOSPC.
        const NO_SPACE: u8 = 28;
        /// EBUSY.
        const BUSY: u8 = 16;
        match self {
            Self::Fail => vec![1],
            Self::NoSpace => vec![2, NO_SPACE],
            Self::Busy => vec![2, BUSY],
            Self::InvalidDataSize => vec![3],
            Self::InvalidSession => vec![4],
            Self::NoSessionsAvailable => vec![5],
            Self::EndOfFile => vec![6],
            Self::UnknownCommand => vec![7],
            Self::FileExists => vec![8],
            Self::FileProtected => vec![9],
            Self::FileNotFound => vec![10],
        }
    }
}

impl From<FileError> for Nak {
    fn from(error: FileError) -> Self {
        match error {
            FileError::NotFound => Self::FileNotFound,
            FileError::Exists => Self::FileExists,
            FileError::Protected => Self::FileProtected,
            FileError::NoSpace => Self::NoSpace,
            FileError::Failed => Self::Fail,
        }
    }
}

/// A request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request {
    /// Number of the message; its answer has the next one.
    pub sequence: u16,
    /// Number that the client gave the open file.
    pub session: u8,
    /// What is wanted.
    pub opcode: u8,
    /// Bytes that are wanted, of a read.
    pub size: u8,
    /// From where on.
    pub offset: u32,
    /// Path, or bytes to be written.
    pub data: Vec<u8>,
}

impl Request {
    /// Reads a message.
    pub fn read(frame: &Frame) -> Self {
        let payload: Payload<'_> = frame.payload();
        let size = payload.u8(HEADER + 4);
        let data: [u8; DATA] = payload.bytes(HEADER + 12);
        Self {
            sequence: payload.u16(HEADER),
            session: payload.u8(HEADER + 2),
            opcode: payload.u8(HEADER + 3),
            size,
            offset: payload.u32(HEADER + 8),
            data: data.iter().take(usize::from(size)).copied().collect(),
        }
    }

    /// The data up to a zero, as text.
    pub fn text(&self) -> Result<&str, Nak> {
        let used = self.data.split(|byte| *byte == 0).next().unwrap_or_default();
        std::str::from_utf8(used).map_err(|_| Nak::FileNotFound)
    }

    /// Two texts with a zero between them.
    pub fn two_texts(&self) -> Result<(&str, &str), Nak> {
        let mut parts = self.data.split(|byte| *byte == 0).map(|part| std::str::from_utf8(part));
        match (parts.next(), parts.next()) {
            (Some(Ok(one)), Some(Ok(other))) => Ok((one, other)),
            _ => Err(Nak::InvalidDataSize),
        }
    }
}

/// System and component of a client.
pub type Client = (u8, u8);

/// An answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reply {
    /// Its data, or why there are none.
    pub result: Result<Vec<u8>, Nak>,
    /// Number of the open file.
    pub session: u8,
    /// Where its data begin.
    pub offset: u32,
    /// Whether nothing more comes of a burst.
    pub burst_complete: bool,
}

impl Reply {
    /// The only answer to a request.
    pub fn to(request: &Request, result: Result<Vec<u8>, Nak>) -> Self {
        Self { result, session: request.session, offset: request.offset, burst_complete: false }
    }

    /// As a message.
    pub fn encode(&self, origin: &Origin, opcode: u8, sequence: u16) -> MavMessage {
        let (kind, data) = match &self.result {
            Ok(data) => (opcode::ACK, data.clone()),
            Err(nak) => (opcode::NAK, nak.data()),
        };
        let [low, high] = sequence.to_le_bytes();
        let [a, b, c, d] = self.offset.to_le_bytes();
        let complete = u8::from(self.burst_complete);
        let header = [low, high, self.session, kind, data.len() as u8, opcode, complete, 0, a, b, c, d];
        let mut payload = [0; PAYLOAD];
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
}
