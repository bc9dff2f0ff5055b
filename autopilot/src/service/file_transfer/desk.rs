//! Requests for files that leave the flight as it is, carried out away from it.

use super::answered::Answered;
use super::content::Content;
use super::listing::{self, Listings};
use super::message::{Client, DATA, Nak, Reply, Request, opcode};
use super::root;
use super::sessions::Sessions;
use crate::file_store::{Access, FileStore};

/// Messages of one answer to a burst.
const BURST: usize = 64;

/// What a request is about, as far as the vehicle knows.
#[derive(Debug)]
pub enum Subject {
    /// A file or folder of the store.
    Stored,
    /// A file that is made of the vehicle's state, as it was when the request came.
    File(Vec<u8>),
    /// The entries of a folder of such files.
    Folder(Vec<Vec<u8>>),
}

/// A request with what is known of it.
#[derive(Debug)]
pub struct Task {
    /// Who asks.
    pub client: Client,
    /// For what.
    pub request: Request,
    /// About what.
    pub subject: Subject,
    /// Simulation time at which the request came, µs.
    pub time_us: u64,
}

/// How a task is to be answered.
#[derive(Debug)]
pub enum Outcome {
    /// With these.
    Replies(Vec<Reply>),
    /// With the checksum of a file.
    Checksum(Content),
}

/// Open files, listings, and what was done lately.
#[derive(Debug, Default)]
pub struct Desk {
    open: Sessions<Content>,
    listings: Listings,
    answered: Answered,
}

impl Desk {
    /// Carries a task out, except for checksums: they take long.
    pub fn carry_out(&mut self, store: &mut dyn FileStore, task: Task) -> Outcome {
        let Task { client, request, subject, time_us } = task;
        if Answered::concerns(&request)
            && let Some(reply) = self.answered.find(client, &request, time_us)
        {
            return Outcome::Replies(vec![reply]);
        }
        let replies = match request.opcode {
            opcode::CALC_FILE_CRC32 => match open(store, &request, subject, Access::Read) {
                Ok(content) => return Outcome::Checksum(content),
                Err(nak) => vec![Reply::to(&request, Err(nak))],
            },
            opcode::READ_FILE | opcode::BURST_READ_FILE => self.read(client, &request, time_us),
            _ => vec![Reply::to(&request, self.result(store, client, &request, subject, time_us))],
        };
        if let [reply] = replies.as_slice() {
            self.answered.remember(client, &request, reply, time_us);
        }
        Outcome::Replies(replies)
    }

    fn result(
        &mut self,
        store: &mut dyn FileStore,
        client: Client,
        request: &Request,
        subject: Subject,
        time_us: u64,
    ) -> Result<Vec<u8>, Nak> {
        let path = || root::writable(request.text()?);
        let access = match request.opcode {
            opcode::CREATE_FILE => Access::Create,
            opcode::OPEN_FILE_WO => Access::Write,
            _ => Access::Read,
        };
        match request.opcode {
            opcode::NONE => {}
            opcode::TERMINATE_SESSION => drop(self.open.close(client, request.session)),
            opcode::RESET_SESSIONS => {
                self.open.reset(client);
                self.listings.forget(client);
                self.answered.forget(client);
            }
            opcode::LIST_DIRECTORY => return self.list(store, client, request, subject, time_us),
            opcode::OPEN_FILE_RO | opcode::CREATE_FILE | opcode::OPEN_FILE_WO => {
                let content = open(store, request, subject, access)?;
                let size = content.size()?;
                self.open.open(client, request.session, content, time_us)?;
                return Ok(size.to_le_bytes().to_vec());
            }
            opcode::WRITE_FILE => {
                let content = self.open.find(client, request.session, time_us)?;
                content.write_at(u64::from(request.offset), &request.data)?;
                return Ok((request.data.len() as u32).to_le_bytes().to_vec());
            }
            opcode::REMOVE_FILE => store.remove_file(&path()?)?,
            opcode::CREATE_DIRECTORY => store.create_folder(&path()?)?,
            opcode::REMOVE_DIRECTORY => store.remove_folder(&path()?)?,
            opcode::TRUNCATE_FILE => store.truncate(&path()?, u64::from(request.offset))?,
            opcode::RENAME => {
                let (from, to) = request.two_texts()?;
                store.rename(&root::writable(from)?, &root::writable(to)?)?;
            }
            _ => return Err(Nak::UnknownCommand),
        }
        Ok(Vec::new())
    }

    fn list(
        &mut self,
        store: &dyn FileStore,
        client: Client,
        request: &Request,
        subject: Subject,
        time_us: u64,
    ) -> Result<Vec<u8>, Nak> {
        if let Subject::Folder(entries) = subject {
            return listing::piece(entries.get(request.offset as usize..).unwrap_or_default(), DATA);
        }
        let path = root::plain(request.text()?)?;
        let read = || root::list(store, &path, DATA);
        self.listings.piece((client, &path), request.offset, DATA, time_us, read)
    }

    /// Pieces of a file from the offset on: one, or a burst of them.
    fn read(&mut self, client: Client, request: &Request, time_us: u64) -> Vec<Reply> {
        match self.pieces(client, request, time_us) {
            Ok(pieces) => pieces,
            Err(nak) => vec![Reply::to(request, Err(nak))],
        }
    }

    fn pieces(&mut self, client: Client, request: &Request, time_us: u64) -> Result<Vec<Reply>, Nak> {
        let size = usize::from(request.size).clamp(1, DATA);
        let burst = request.opcode == opcode::BURST_READ_FILE;
        let content = self.open.find(client, request.session, time_us)?;
        let mut bytes = vec![0; if burst { BURST * size } else { size }];
        let read = content.read_at(u64::from(request.offset), &mut bytes)?;
        bytes.truncate(read);
        let piece = |(index, bytes): (usize, &[u8])| {
            let offset = request.offset.checked_add((index * size) as u32)?;
            let result = Ok(bytes.to_vec());
            Some(Reply { result, session: request.session, offset, burst_complete: false })
        };
        let mut pieces: Vec<Reply> = bytes.chunks(size).enumerate().map_while(piece).collect();
        let last = pieces.last_mut().ok_or(Nak::EndOfFile)?;
        last.burst_complete = burst;
        Ok(pieces)
    }
}

/// Opens the file that a request is about.
fn open(
    store: &mut dyn FileStore,
    request: &Request,
    subject: Subject,
    access: Access,
) -> Result<Content, Nak> {
    if let Subject::File(bytes) = subject {
        return Ok(Content::Made(bytes));
    }
    let path = request.text()?;
    let path = if access == Access::Read { root::plain(path)? } else { root::writable(path)? };
    Ok(Content::Stored(store.open(&path, access)?))
}
