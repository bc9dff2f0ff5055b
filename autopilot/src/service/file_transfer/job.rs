//! A request on its way to the desk and back.

use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, PoisonError};

use super::content::Content;
use super::desk::{Desk, Outcome, Task};
use super::message::{Nak, Reply, Request};
use crate::codec::checksum::Checksum;
use crate::file_store::FileStore;
use crate::file_work::{FileJob, JobStep};

/// Bytes of which a checksum is computed in one step.
const SLICE: usize = 1 << 20;

/// The replies to a request.
#[derive(Debug)]
pub struct Answer {
    /// Number of the request.
    pub number: u64,
    /// What it is answered.
    pub replies: Vec<Reply>,
}

/// Carries a request out.
#[derive(Debug)]
pub struct FileTransferJob {
    /// Where. It is locked while a job is at work there, and jobs follow one another: nobody waits for it.
    pub desk: Arc<Mutex<Desk>>,
    /// Number of the request.
    pub number: u64,
    /// The request, until it is carried out.
    pub task: Option<Task>,
    /// The checksum that is being computed.
    pub checksum: Option<ChecksumWork>,
    /// Whom to tell.
    pub answers: Sender<Answer>,
}

impl FileJob for FileTransferJob {
    fn advance(&mut self, store: &mut dyn FileStore) -> JobStep {
        if let Some(task) = self.task.take() {
            let request = task.request.clone();
            let outcome = self.desk.lock().unwrap_or_else(PoisonError::into_inner).carry_out(store, task);
            return match outcome {
                Outcome::Replies(replies) => self.answer(replies),
                Outcome::Checksum(content) => {
                    self.checksum = Some(ChecksumWork::new(request, content));
                    JobStep::More
                }
            };
        }
        match self.checksum.as_mut().and_then(ChecksumWork::advance) {
            Some(reply) => self.answer(vec![reply]),
            None if self.checksum.is_some() => JobStep::More,
            None => JobStep::Done,
        }
    }
}

impl FileTransferJob {
    fn answer(&self, replies: Vec<Reply>) -> JobStep {
        // A server that is gone waits for no answer.
        let _gone = self.answers.send(Answer { number: self.number, replies });
        JobStep::Done
    }
}

/// The checksum of a file, a slice at a time.
#[derive(Debug)]
pub struct ChecksumWork {
    request: Request,
    content: Content,
    checksum: Checksum,
    offset: u64,
}

impl ChecksumWork {
    fn new(request: Request, content: Content) -> Self {
        Self { request, content, checksum: Checksum::default(), offset: 0 }
    }

    /// The next slice; the answer behind the last one.
    fn advance(&mut self) -> Option<Reply> {
        let mut slice = vec![0; SLICE];
        let read = match self.content.read_at(self.offset, &mut slice) {
            Ok(read) => read,
            Err(error) => return Some(Reply::to(&self.request, Err(Nak::from(error)))),
        };
        self.checksum.update(slice.get(..read).unwrap_or_default());
        self.offset += read as u64;
        let over = read < SLICE;
        over.then(|| Reply::to(&self.request, Ok(self.checksum.clone().finish().to_le_bytes().to_vec())))
    }
}
