//! Open files of all clients.

use vehicle::plan::PlanKind;

use super::message::{DATA, Nak, Reply, Request, opcode};
use super::plan_pack;
use crate::file_store::{FileError, OpenFile};

/// Open files at the same time, of all clients.
const MOST: usize = 16;
/// And of one of them; its oldest makes room.
const MOST_OF_ONE: usize = 4;
/// A file that nobody has asked anything of for this long makes room for others, µs of simulation time.
const IDLE_US: u64 = 10_000_000;
/// Messages of one answer to a burst.
const BURST: usize = 64;

/// System and component of a client.
pub type Client = (u8, u8);

/// What an open file is.
#[derive(Debug)]
pub enum Content {
    /// Made when it was opened.
    Made(Vec<u8>),
    /// In a store.
    Stored(Box<dyn OpenFile>),
    /// A packed plan that is being written, to be taken when it is closed.
    Received(PlanKind, Vec<u8>),
}

impl Content {
    /// Bytes of it; more than offsets can tell is not offered.
    pub fn size(&self) -> Result<u32, Nak> {
        let size = match self {
            Self::Made(bytes) | Self::Received(_, bytes) => bytes.len() as u64,
            Self::Stored(file) => file.size()?,
        };
        u32::try_from(size).map_err(|_| Nak::Fail)
    }

    /// Reads from an offset on; fewer bytes only at the end.
    pub fn read_at(&mut self, offset: u64, into: &mut [u8]) -> Result<usize, FileError> {
        match self {
            Self::Stored(file) => file.read_at(offset, into),
            Self::Made(bytes) | Self::Received(_, bytes) => {
                let start = usize::try_from(offset).unwrap_or(usize::MAX);
                let rest = bytes.get(start..).unwrap_or_default();
                for (byte, given) in into.iter_mut().zip(rest) {
                    *byte = *given;
                }
                Ok(rest.len().min(into.len()))
            }
        }
    }
}

/// An open file.
#[derive(Debug)]
struct Session {
    number: u8,
    client: Client,
    content: Content,
    used_us: u64,
}

/// All of them.
#[derive(Debug, Default)]
pub struct Sessions(Vec<Session>);

impl Sessions {
    /// Opens a file under the number that its client asks for: some clients tell their transfers apart by it. A second
    /// request under the same number is a retry whose answer was lost.
    pub fn open(&mut self, client: Client, number: u8, content: Content, time_us: u64) -> Result<(), Nak> {
        self.close(client, number);
        if self.0.iter().filter(|open| open.client == client).count() >= MOST_OF_ONE {
            // It has forgotten to close them.
            if let Some(oldest) = self.0.iter().position(|open| open.client == client) {
                self.0.remove(oldest);
            }
        }
        if self.0.len() >= MOST {
            let idle = self.0.iter().position(|open| open.used_us + IDLE_US <= time_us);
            self.0.remove(idle.ok_or(Nak::NoSessionsAvailable)?);
        }
        self.0.push(Session { number, client, content, used_us: time_us });
        Ok(())
    }

    /// Closes a file, if it is open, and returns what it was.
    pub fn close(&mut self, client: Client, number: u8) -> Option<Content> {
        let place = self.0.iter().position(|open| (open.client, open.number) == (client, number))?;
        Some(self.0.remove(place).content)
    }

    /// Closes all files of a client.
    pub fn reset(&mut self, client: Client) {
        self.0.retain(|open| open.client != client);
    }

    fn find(&mut self, client: Client, number: u8, time_us: u64) -> Result<&mut Content, Nak> {
        let found = self.0.iter_mut().find(|open| (open.client, open.number) == (client, number));
        let open = found.ok_or(Nak::InvalidSession)?;
        open.used_us = time_us;
        Ok(&mut open.content)
    }

    /// Writes into a file.
    pub fn write(&mut self, client: Client, request: &Request, time_us: u64) -> Result<Vec<u8>, Nak> {
        match self.find(client, request.session, time_us)? {
            Content::Made(_) => Err(Nak::FileProtected),
            Content::Received(kind, bytes) => {
                let start = request.offset as usize;
                let end = start.saturating_add(request.data.len());
                if end > plan_pack::largest(*kind) {
                    return Err(Nak::NoSpace);
                }
                bytes.resize(bytes.len().max(end), 0);
                for (byte, given) in bytes.iter_mut().skip(start).zip(&request.data) {
                    *byte = *given;
                }
                Ok((request.data.len() as u32).to_le_bytes().to_vec())
            }
            Content::Stored(file) => {
                file.write_at(u64::from(request.offset), &request.data)?;
                Ok((request.data.len() as u32).to_le_bytes().to_vec())
            }
        }
    }

    /// Pieces of a file from the offset on: one, or a burst of them.
    pub fn read(&mut self, client: Client, request: &Request, time_us: u64) -> Vec<Reply> {
        match self.pieces(client, request, time_us) {
            Ok(pieces) => pieces,
            Err(nak) => vec![Reply::to(request, Err(nak))],
        }
    }

    fn pieces(&mut self, client: Client, request: &Request, time_us: u64) -> Result<Vec<Reply>, Nak> {
        let size = usize::from(request.size).clamp(1, DATA);
        let burst = request.opcode == opcode::BURST_READ_FILE;
        let content = self.find(client, request.session, time_us)?;
        let mut pieces: Vec<Reply> = Vec::new();
        for index in 0..if burst { BURST } else { 1 } {
            let mut piece = vec![0; size];
            let Some(offset) = request.offset.checked_add((index * size) as u32) else { break };
            let read = content.read_at(u64::from(offset), &mut piece)?;
            if read == 0 {
                break;
            }
            piece.truncate(read);
            pieces.push(Reply { result: Ok(piece), session: request.session, offset, burst_complete: false });
        }
        let last = pieces.last_mut().ok_or(Nak::EndOfFile)?;
        last.burst_complete = burst;
        Ok(pieces)
    }
}
