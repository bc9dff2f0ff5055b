//! Requests that have changed something, and their answers: a retry is answered again, not carried out again.

use std::collections::VecDeque;

use super::message::{Client, Reply, Request, opcode};

/// Requests that are remembered.
const REMEMBERED: usize = 32;
/// For this long, µs of simulation time.
const REMEMBERED_US: u64 = 2_000_000;

#[derive(Debug)]
struct Done {
    client: Client,
    request: Request,
    reply: Reply,
    time_us: u64,
}

/// What was done lately.
#[derive(Debug, Default)]
pub struct Answered(VecDeque<Done>);

impl Answered {
    /// Whether a request changes something, so that it must not be carried out twice.
    pub fn concerns(request: &Request) -> bool {
        matches!(
            request.opcode,
            opcode::TERMINATE_SESSION
                | opcode::CREATE_FILE
                | opcode::REMOVE_FILE
                | opcode::CREATE_DIRECTORY
                | opcode::REMOVE_DIRECTORY
                | opcode::OPEN_FILE_WO
                | opcode::TRUNCATE_FILE
                | opcode::RENAME
        )
    }

    /// The answer to a request that was carried out a moment ago.
    pub fn find(&self, client: Client, request: &Request, time_us: u64) -> Option<Reply> {
        let recent = |done: &&Done| time_us < done.time_us + REMEMBERED_US;
        let same = |done: &&Done| done.client == client && done.request == *request;
        self.0.iter().filter(recent).find(same).map(|done| done.reply.clone())
    }

    /// Remembers an answer, if it is to a request that changes something.
    pub fn remember(&mut self, client: Client, request: &Request, reply: &Reply, time_us: u64) {
        if !Self::concerns(request) {
            return;
        }
        if self.0.len() >= REMEMBERED {
            self.0.pop_front();
        }
        self.0.push_back(Done { client, request: request.clone(), reply: reply.clone(), time_us });
    }

    /// Forgets the requests of a client.
    pub fn forget(&mut self, client: Client) {
        self.0.retain(|done| done.client != client);
    }
}
