//! Requests for files and their answers.

use std::collections::VecDeque;

use mavlink::dialects::common::MavProtocolCapability;
use vehicle::identity::Identity;
use vehicle::plan::PlanKind;

use super::message::{DATA, Nak, Reply, Request, opcode};
use super::sessions::{Client, Content, Sessions};
use super::{plan_pack, root};
use crate::codec::checksum::Checksum;
use crate::codec::{Frame, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::file_store::Access;
use crate::service::Service;

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

impl Service for FileServer {
    fn messages(&self) -> &'static [u32] {
        &[id::FILE_TRANSFER_PROTOCOL]
    }

    fn capabilities(&self, _identity: Identity) -> MavProtocolCapability {
        MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_FTP
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let request = Request::read(frame);
        // What is an answer is none of ours: two servers would talk for ever.
        if request.opcode >= opcode::ACK {
            return;
        }
        let mut sequence = request.sequence;
        for reply in self.replies(context, (origin.system, origin.component), &request) {
            sequence = sequence.wrapping_add(1);
            let message = reply.encode(origin, request.opcode, sequence);
            context.outbox.send(Destination::Peer(origin.peer), message);
        }
    }
}

impl FileServer {
    fn replies(&mut self, context: &mut Context, client: Client, request: &Request) -> Vec<Reply> {
        let time_us = context.vehicle.time_us();
        if matches!(request.opcode, opcode::READ_FILE | opcode::BURST_READ_FILE) {
            return self.sessions.read(client, request, time_us);
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
        if changes && let Some(reply) = self.answer(client, request, time_us) {
            return vec![reply];
        }
        let result = self.carry_out(context, client, request, time_us);
        // The offset of an answer to an open file is nothing's.
        let reply = Reply::to(request, result);
        if changes {
            self.remember(Done { client, request: request.clone(), reply: reply.clone(), time_us });
        }
        vec![reply]
    }

    fn carry_out(
        &mut self,
        context: &mut Context,
        client: Client,
        request: &Request,
        time_us: u64,
    ) -> Result<Vec<u8>, Nak> {
        let path = || root::writable(request.text()?);
        match request.opcode {
            opcode::NONE => {}
            opcode::TERMINATE_SESSION => {
                if let Some(Content::Received(kind, bytes)) = self.sessions.close(client, request.session) {
                    take_plan(context, kind, &bytes)?;
                }
            }
            opcode::RESET_SESSIONS => {
                self.sessions.reset(client);
                self.done.retain(|done| done.client != client);
            }
            opcode::LIST_DIRECTORY => return root::list(context, request.text()?, request.offset, DATA),
            opcode::OPEN_FILE_RO => return self.open(context, client, request, Access::Read, time_us),
            opcode::CREATE_FILE => return self.open(context, client, request, Access::Create, time_us),
            opcode::OPEN_FILE_WO => return self.open(context, client, request, Access::Write, time_us),
            opcode::WRITE_FILE => return self.sessions.write(client, request, time_us),
            opcode::REMOVE_FILE => context.files.remove_file(&path()?)?,
            opcode::CREATE_DIRECTORY => context.files.create_folder(&path()?)?,
            opcode::REMOVE_DIRECTORY => context.files.remove_folder(&path()?)?,
            opcode::TRUNCATE_FILE => context.files.truncate(&path()?, u64::from(request.offset))?,
            opcode::RENAME => {
                let (from, to) = request.two_texts()?;
                context.files.rename(&root::writable(from)?, &root::writable(to)?)?;
            }
            opcode::CALC_FILE_CRC32 => {
                let content = root::open(context, request.text()?, Access::Read)?;
                return Ok(checksum_of(content)?.to_le_bytes().to_vec());
            }
            _ => return Err(Nak::UnknownCommand),
        }
        Ok(Vec::new())
    }

    /// Opens a file and tells its size.
    fn open(
        &mut self,
        context: &mut Context,
        client: Client,
        request: &Request,
        access: Access,
        time_us: u64,
    ) -> Result<Vec<u8>, Nak> {
        let content = root::open(context, request.text()?, access)?;
        let size = content.size()?;
        self.sessions.open(client, request.session, content, time_us)?;
        Ok(size.to_le_bytes().to_vec())
    }
}

/// Takes a packed plan over, or says why not: clients do not look at the answer to a close.
fn take_plan(context: &mut Context, kind: PlanKind, bytes: &[u8]) -> Result<(), Nak> {
    let items = plan_pack::unpack(bytes, kind);
    items.and_then(|items| context.vehicle.set_plan(kind, items)).map_err(|fault| {
        context.reject_plan(kind.name(), &fault);
        Nak::Fail
    })
}

fn checksum_of(mut content: Content) -> Result<u32, Nak> {
    if content.size()? > LARGEST_CHECKED {
        return Err(Nak::Fail);
    }
    let mut checksum = Checksum::default();
    let (mut piece, mut offset) = (vec![0; 1 << 16], 0);
    loop {
        let read = content.read_at(offset, &mut piece)?;
        if read == 0 {
            return Ok(checksum.finish());
        }
        checksum.update(piece.get(..read).unwrap_or_default());
        offset += read as u64;
    }
}
