//! MAVLink FTP: files that are made when they are read, and those of a store.

mod message;
mod parameter_pack;
mod plan_pack;
mod plan_text;
mod root;
mod sessions;

use std::collections::VecDeque;

use vehicle::Severity;
use vehicle::plan::PlanKind;

use self::message::{DATA, Nak, Reply, Request, opcode};
use self::sessions::{Client, Content, Sessions};
use super::{Destination, Origin, status_text};
use crate::autopilot::Autopilot;
use crate::codec::Frame;
use crate::file_store::Access;

/// Requests that have changed something and are remembered.
const REMEMBERED: usize = 32;
/// For this long, µs of simulation time.
const REMEMBERED_US: u64 = 2_000_000;
/// Bytes of the largest file whose checksum is computed: it takes a tenth of a second.
const LARGEST_CHECKED: u32 = 256 << 20;

/// A request that has changed something, and its answer: a retry is answered again, not carried out again.
#[derive(Debug)]
struct Done {
    client: Client,
    request: Request,
    reply: Reply,
    time_us: u64,
}

/// Open files, and what was done lately.
#[derive(Debug, Default)]
pub struct FileServer {
    sessions: Sessions,
    done: VecDeque<Done>,
}

impl FileServer {
    fn answer(&self, client: Client, request: &Request, time_us: u64) -> Option<Reply> {
        let recent = |done: &&Done| time_us < done.time_us + REMEMBERED_US;
        let same = |done: &&Done| done.client == client && done.request == *request;
        self.done.iter().filter(recent).find(same).map(|done| done.reply.clone())
    }

    fn remember(&mut self, done: Done) {
        if self.done.len() >= REMEMBERED {
            self.done.pop_front();
        }
        self.done.push_back(done);
    }
}

/// Answers a request.
pub fn handle(autopilot: &mut Autopilot, origin: &Origin, frame: &Frame) {
    let request = Request::read(frame);
    // What is an answer is none of ours: two servers would talk for ever.
    if request.opcode >= opcode::ACK {
        return;
    }
    let mut sequence = request.sequence;
    for reply in replies(autopilot, (origin.system, origin.component), &request) {
        sequence = sequence.wrapping_add(1);
        let message = reply.encode(origin, request.opcode, sequence);
        autopilot.send(Destination::Peer(origin.peer), message);
    }
}

fn replies(autopilot: &mut Autopilot, client: Client, request: &Request) -> Vec<Reply> {
    let time_us = autopilot.vehicle.time_us();
    if matches!(request.opcode, opcode::READ_FILE | opcode::BURST_READ_FILE) {
        return autopilot.files.sessions.read(client, request, time_us);
    }
    let changes = matches!(
        request.opcode,
        opcode::TERMINATE_SESSION
            | opcode::CREATE_FILE
            | opcode::REMOVE_FILE
            | opcode::CREATE_DIRECTORY
            | opcode::REMOVE_DIRECTORY
            | opcode::OPEN_FILE_WO
            | opcode::TRUNCATE_FILE
            | opcode::RENAME
    );
    if changes && let Some(reply) = autopilot.files.answer(client, request, time_us) {
        return vec![reply];
    }
    let result = carry_out(autopilot, client, request, time_us);
    // The offset of an answer to an open file is nothing's.
    let reply = Reply::to(request, result);
    if changes {
        autopilot.files.remember(Done { client, request: request.clone(), reply: reply.clone(), time_us });
    }
    vec![reply]
}

fn carry_out(
    autopilot: &mut Autopilot,
    client: Client,
    request: &Request,
    time_us: u64,
) -> Result<Vec<u8>, Nak> {
    let path = || root::writable(request.text()?);
    match request.opcode {
        opcode::NONE => {}
        opcode::TERMINATE_SESSION => {
            if let Some(Content::Received(kind, bytes)) =
                autopilot.files.sessions.close(client, request.session)
            {
                take_plan(autopilot, kind, &bytes)?;
            }
        }
        opcode::RESET_SESSIONS => {
            autopilot.files.sessions.reset(client);
            autopilot.files.done.retain(|done| done.client != client);
        }
        opcode::LIST_DIRECTORY => return root::list(autopilot, request.text()?, request.offset, DATA),
        opcode::OPEN_FILE_RO => return open(autopilot, client, request, Access::Read, time_us),
        opcode::CREATE_FILE => return open(autopilot, client, request, Access::Create, time_us),
        opcode::OPEN_FILE_WO => return open(autopilot, client, request, Access::Write, time_us),
        opcode::WRITE_FILE => return autopilot.files.sessions.write(client, request, time_us),
        opcode::REMOVE_FILE => autopilot.store.remove_file(&path()?)?,
        opcode::CREATE_DIRECTORY => autopilot.store.create_folder(&path()?)?,
        opcode::REMOVE_DIRECTORY => autopilot.store.remove_folder(&path()?)?,
        opcode::TRUNCATE_FILE => autopilot.store.truncate(&path()?, u64::from(request.offset))?,
        opcode::RENAME => {
            let (from, to) = request.two_texts()?;
            autopilot.store.rename(&root::writable(from)?, &root::writable(to)?)?;
        }
        opcode::CALC_FILE_CRC32 => {
            let content = root::open(autopilot, request.text()?, Access::Read)?;
            return Ok(checksum_of(content)?.to_le_bytes().to_vec());
        }
        _ => return Err(Nak::UnknownCommand),
    }
    Ok(Vec::new())
}

/// Opens a file and tells its size.
fn open(
    autopilot: &mut Autopilot,
    client: Client,
    request: &Request,
    access: Access,
    time_us: u64,
) -> Result<Vec<u8>, Nak> {
    let content = root::open(autopilot, request.text()?, access)?;
    let size = content.size()?;
    autopilot.files.sessions.open(client, request.session, content, time_us)?;
    Ok(size.to_le_bytes().to_vec())
}

/// Takes a packed plan over, or says why not: clients do not look at the answer to a close.
fn take_plan(autopilot: &mut Autopilot, kind: PlanKind, bytes: &[u8]) -> Result<(), Nak> {
    let items = plan_pack::unpack(bytes, kind);
    items.and_then(|items| autopilot.vehicle.set_plan(kind, items)).map_err(|fault| {
        status_text::send(autopilot, Severity::Warning, &format!("{} refused: {fault}", kind.name()));
        Nak::Fail
    })
}

fn checksum_of(mut content: Content) -> Result<u32, Nak> {
    if content.size()? > LARGEST_CHECKED {
        return Err(Nak::Fail);
    }
    let mut hasher = crc32fast::Hasher::new_with_initial(u32::MAX);
    let (mut piece, mut offset) = (vec![0; 1 << 16], 0);
    loop {
        let read = content.read_at(offset, &mut piece)?;
        if read == 0 {
            return Ok(!hasher.finalize());
        }
        hasher.update(piece.get(..read).unwrap_or_default());
        offset += read as u64;
    }
}

/// CRC-32 of the protocol: begins with zero and is not inverted.
pub fn checksum(content: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new_with_initial(u32::MAX);
    hasher.update(content);
    !hasher.finalize()
}
