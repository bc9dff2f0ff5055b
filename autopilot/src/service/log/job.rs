//! What is done on the disk: listing, reading ahead, erasing.

use std::sync::mpsc::Sender;

use crate::envelope::Origin;
use crate::file_store::{Access, FileError, FileStore, LAST_LOG, LOGS, Listed, OpenFile};
use crate::file_work::{FileJob, JobStep};

/// Bytes that are read at once.
pub const AHEAD: usize = 1 << 16;

/// What a job has found out.
#[derive(Debug)]
pub enum Answer {
    /// The logs that there are.
    Listed(Vec<Listed>),
    /// Bytes of a download, if the file is there.
    Read(Option<Ahead>, u64),
    /// The logs are erased, or not.
    Erased(Origin, Result<(), FileError>),
}

/// A file, and bytes of it from an offset on: fewer than [`AHEAD`] only at its end.
#[derive(Debug)]
pub struct Ahead {
    /// The file, to be read further.
    pub file: Box<dyn OpenFile>,
    /// Where the bytes begin.
    pub offset: u64,
    /// The bytes.
    pub bytes: Vec<u8>,
}

/// Lists the logs.
#[derive(Debug)]
pub struct ListJob(pub Sender<Answer>);

impl FileJob for ListJob {
    fn advance(&mut self, store: &mut dyn FileStore) -> JobStep {
        let mut listed = store.list(LOGS).unwrap_or_default();
        listed.retain(|log| log.size.is_some() && log.name != LAST_LOG);
        // Nobody waits for it any more if it cannot be sent; so for all jobs.
        let _gone = self.0.send(Answer::Listed(listed));
        JobStep::Done
    }
}

/// Reads a piece of a log.
#[derive(Debug)]
pub struct ReadJob {
    /// Name of the log.
    pub name: String,
    /// The file, if it is open already.
    pub file: Option<Box<dyn OpenFile>>,
    /// From where on.
    pub offset: u64,
    /// Number of the download.
    pub download: u64,
    /// Whom to tell.
    pub answers: Sender<Answer>,
}

impl ReadJob {
    fn read(&mut self, store: &mut dyn FileStore) -> Result<Ahead, FileError> {
        let mut file = match self.file.take() {
            Some(file) => file,
            None => store.open(&format!("{LOGS}/{}", self.name), Access::Read)?,
        };
        let mut bytes = vec![0; AHEAD];
        // What cannot be read any more ends here, as for the client.
        let length = file.read_at(self.offset, &mut bytes).unwrap_or(0);
        bytes.truncate(length);
        Ok(Ahead { file, offset: self.offset, bytes })
    }
}

impl FileJob for ReadJob {
    fn advance(&mut self, store: &mut dyn FileStore) -> JobStep {
        let ahead = self.read(store).ok();
        let _gone = self.answers.send(Answer::Read(ahead, self.download));
        JobStep::Done
    }
}

/// Erases the logs of flights that are over.
#[derive(Debug)]
pub struct EraseJob {
    /// Who asked for it.
    pub origin: Origin,
    /// Whom to tell.
    pub answers: Sender<Answer>,
}

impl FileJob for EraseJob {
    fn advance(&mut self, store: &mut dyn FileStore) -> JobStep {
        let _gone = self.answers.send(Answer::Erased(self.origin, store.erase_logs()));
        JobStep::Done
    }
}
