//! What becomes of a file that cannot be written while vehicles fly, and what is said about it.

use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use vehicle::Severity;

/// How often files that grow are written, and files that could not be written are tried again, by the wall clock.
pub const WRITE_PERIOD: Duration = Duration::from_secs(1);

/// A line for the pilots.
pub type Notice = (Severity, String);

/// Judges each attempt to write a file: announces the first failure and the recovery, and knows at the end what is missing.
///
/// No file ends a flight.
#[derive(Debug)]
pub struct Upkeep {
    name: &'static str,
    path: PathBuf,
    /// Why the latest attempt failed; `None` if it did not.
    failure: Option<String>,
    /// When [`Self::attempt`] last tried.
    tried: Option<Instant>,
}

impl Upkeep {
    /// Of a file, with the name by which pilots know it.
    pub fn new(name: &'static str, path: &Path) -> Self {
        Self { name, path: path.to_owned(), failure: None, tried: None }
    }

    /// Whether the latest attempt failed.
    pub fn is_failing(&self) -> bool {
        self.failure.is_some()
    }

    /// Writes the file, unless that failed less than [`WRITE_PERIOD`] ago. Returns what to announce, if that is news.
    pub fn attempt(&mut self, now: Instant, write: impl FnOnce() -> io::Result<()>) -> Option<Notice> {
        let early = self.tried.is_some_and(|tried| now.saturating_duration_since(tried) < WRITE_PERIOD);
        if early && self.is_failing() {
            return None;
        }
        self.tried = Some(now);
        self.judge(write())
    }

    /// Takes in how an attempt ended. Returns what to announce, if that is news.
    pub fn judge(&mut self, result: io::Result<()>) -> Option<Notice> {
        let was_failing = self.is_failing();
        self.failure = result.err().map(|error| reason(&error));
        match &self.failure {
            Some(reason) if !was_failing => {
                tracing::warn!("cannot write {}: {reason}; the flight goes on", self.path.display());
                Some((Severity::Error, format!("{} not written: {reason}", self.name)))
            }
            None if was_failing => {
                tracing::info!("{} is written again", self.path.display());
                Some((Severity::Info, format!("{} written again", self.name)))
            }
            _ => None,
        }
    }

    /// A sentence about what is missing from the file, with the reason if it still cannot be written.
    pub fn lacks(&self, what: &str) -> String {
        let reason = self.failure.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
        format!("{} {what}{reason}", self.path.display())
    }
}

/// The reason of an error, without the number that the system appends and in lower case.
pub fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let text = text.split(" (os error").next().unwrap_or_default();
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| first.to_lowercase().chain(characters).collect())
}

#[cfg(test)]
mod tests {
    use std::io::{Error, ErrorKind};
    use std::path::Path;

    use std::time::Instant;

    use super::{Severity, Upkeep, WRITE_PERIOD};

    #[test]
    fn a_file_that_fails_is_tried_again_each_period_and_one_that_works_at_any_time() {
        let mut upkeep = Upkeep::new("Parameters", Path::new("a.params"));
        let (start, mut attempts) = (Instant::now(), 0);
        let mut attempt = |after, works| {
            let full = Error::from(ErrorKind::StorageFull);
            let write = || {
                attempts += 1;
                if works { Ok(()) } else { Err(full) }
            };
            let said = upkeep.attempt(start + after, write).is_some();
            (attempts, said)
        };
        let instant = WRITE_PERIOD / 10;
        assert_eq!(attempt(instant, true), (1, false));
        assert_eq!(attempt(2 * instant, false), (2, true), "one that works need not wait");
        assert_eq!(attempt(3 * instant, true), (2, false), "one that fails waits");
        assert_eq!(attempt(2 * instant + WRITE_PERIOD, false), (3, false));
        assert_eq!(attempt(2 * instant + 2 * WRITE_PERIOD, true), (4, true));
        assert_eq!(attempt(3 * instant + 2 * WRITE_PERIOD, true), (5, false));
    }

    #[test]
    fn a_failure_is_announced_once_and_so_is_its_end() {
        let mut upkeep = Upkeep::new("Record", Path::new("flight.lmpc"));
        assert_eq!(upkeep.judge(Ok(())), None);
        let full = || Err(Error::from(ErrorKind::StorageFull));
        let (severity, text) = upkeep.judge(full()).expect("news");
        assert_eq!((severity, text.as_str()), (Severity::Error, "Record not written: no storage space"));
        assert_eq!(upkeep.judge(full()), None);
        assert_eq!(upkeep.lacks("lacks its end"), "flight.lmpc lacks its end: no storage space");
        assert_eq!(upkeep.judge(Ok(())), Some((Severity::Info, "Record written again".to_owned())));
        assert_eq!(upkeep.judge(Ok(())), None);
        assert_eq!(upkeep.lacks("lacks its end"), "flight.lmpc lacks its end");
    }
}
