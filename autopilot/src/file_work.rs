//! Work on files, apart from the flight: a disk may be slow, or never answer.

use std::fmt::Debug;

use crate::envelope::PeerId;
use crate::file_store::FileStore;

/// Whether a job has more to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JobStep {
    /// Call it again; others may work in between.
    More,
    /// It is over.
    Done,
}

/// Work on files for a client. It hands its answer to whoever made it, by a channel.
pub trait FileJob: Debug + Send {
    /// Works for about a millisecond, or one operation of the disk.
    fn advance(&mut self, store: &mut dyn FileStore) -> JobStep;
}

/// Too many jobs are waiting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("too many requests are waiting")]
pub struct QueueFull;

/// Carries out jobs. The jobs of one client are carried out in their order; clients take turns.
pub trait FileWorker: Debug + Send {
    /// Takes a job of a client.
    ///
    /// # Errors
    /// [`QueueFull`]; the job is dropped then.
    fn submit(&mut self, client: PeerId, job: Box<dyn FileJob>) -> Result<(), QueueFull>;
}

/// Carries out each job at once, where it is submitted.
#[derive(Debug)]
pub struct Immediate<S>(pub S);

impl<S: FileStore> FileWorker for Immediate<S> {
    fn submit(&mut self, _client: PeerId, mut job: Box<dyn FileJob>) -> Result<(), QueueFull> {
        while job.advance(&mut self.0) == JobStep::More {}
        Ok(())
    }
}
