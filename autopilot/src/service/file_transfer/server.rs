//! Requests for files, and their answers.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};

use mavlink::dialects::ardupilotmega::MavProtocolCapability;
use vehicle::identity::Identity;

use super::desk::{Desk, Subject, Task};
use super::job::{Answer, FileTransferJob};
use super::message::{Nak, Reply, Request, opcode};
use super::pack_upload::PackUploads;
use super::pending::Pending;
use super::root;
use crate::codec::{Frame, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin, PeerId};
use crate::service::Service;
use crate::speaker::Speaker;

/// Messages in one turn: a client asks for no more than a burst at once, so these may go faster than lists.
const MESSAGES: usize = 4;

/// Serves files.
#[derive(Debug)]
pub struct FileServer {
    plans: PackUploads,
    desk: Arc<Mutex<Desk>>,
    pending: Pending,
    answers: Receiver<Answer>,
    /// A copy for each job.
    to_answers: Sender<Answer>,
}

impl Default for FileServer {
    fn default() -> Self {
        let (to_answers, answers) = channel();
        Self {
            plans: PackUploads::default(),
            desk: Arc::default(),
            pending: Pending::default(),
            answers,
            to_answers,
        }
    }
}

impl Service for FileServer {
    fn summary(&self) -> &'static str {
        "Files (MAVLink FTP)"
    }

    fn answers(&self) -> &'static [u32] {
        &[id::FILE_TRANSFER_PROTOCOL]
    }

    fn messages(&self) -> &'static [u32] {
        &[id::FILE_TRANSFER_PROTOCOL]
    }

    /// Ground stations ask the camera for its definition.
    fn speakers(&self) -> &'static [Speaker] {
        &[Speaker::Autopilot, Speaker::Camera]
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
        let (client, time_us) = ((origin.system, origin.component), context.vehicle.time_us());
        if let Some(reply) = self.plans.take(context, client, &request, time_us) {
            send(context, origin, &request, &reply);
        } else if !self.pending.is_known(origin, &request) && !self.submit(context, origin, &request) {
            send(context, origin, &request, &Reply::to(&request, Err(Nak::Busy)));
        }
    }

    fn is_answering(&self) -> bool {
        self.pending.are_there()
    }

    fn transfer(&mut self, context: &mut Context, turns: usize, has_room: &dyn Fn(PeerId) -> Option<bool>) {
        while let Ok(Answer { number, replies }) = self.answers.try_recv() {
            self.pending.answer(number, replies);
        }
        self.pending.retain(|peer| has_room(peer).is_some());
        for _ in 0..turns.saturating_mul(MESSAGES) {
            let Some((peer, asked, message)) = self.pending.next(|peer| has_room(peer) == Some(true)) else {
                return;
            };
            context.outbox.answer_as(asked);
            context.outbox.send(Destination::Peer(peer), message);
            context.outbox.answer_as(Speaker::Autopilot);
        }
    }
}

impl FileServer {
    /// Hands a request to the desk; `false`: too many are there.
    fn submit(&mut self, context: &mut Context, origin: &Origin, request: &Request) -> bool {
        let Some(number) = self.pending.admit(origin.peer) else { return false };
        let task = Task {
            client: (origin.system, origin.component),
            request: request.clone(),
            subject: subject(context, request),
            time_us: context.vehicle.time_us(),
        };
        let job = FileTransferJob {
            desk: Arc::clone(&self.desk),
            number,
            task: Some(task),
            checksum: None,
            answers: self.to_answers.clone(),
        };
        let taken = context.files.submit(origin.peer, Box::new(job)).is_ok();
        if taken {
            self.pending.add(number, *origin, context.outbox.asked(), request.clone());
        }
        taken
    }
}

/// What a request is about, as far as the vehicle knows.
fn subject(context: &Context, request: &Request) -> Subject {
    let path = request.text().unwrap_or_default();
    match request.opcode {
        opcode::OPEN_FILE_RO | opcode::CALC_FILE_CRC32 => {
            root::made_file(context, path).map_or(Subject::Stored, Subject::File)
        }
        opcode::LIST_DIRECTORY => root::made_folder(context, path).map_or(Subject::Stored, Subject::Folder),
        _ => Subject::Stored,
    }
}

fn send(context: &mut Context, origin: &Origin, request: &Request, reply: &Reply) {
    let message = reply.encode(origin, request.opcode, request.sequence.wrapping_add(1));
    context.outbox.send(Destination::Peer(origin.peer), message);
}
