//! Signing at the edge: the wall clock, the key files and the announcements.

use std::path::Path;
use std::time::{Duration, Instant};

use vehicle::Severity;

use crate::failure::Failure;
use crate::link::{Links, SigningSetup};
use crate::signing::{Counts, KeyFile, Signing, timestamp};

/// Rejected frames are announced this often.
const TOLD: Duration = Duration::from_secs(5);

/// What is to be said, and whether another key is used from now on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    /// For the pilots.
    pub lines: Vec<(Severity, String)>,
    /// Other hubs have to use it, too.
    pub new_key: bool,
}

/// Keeps the state of signing up to date, on the disk, too.
#[derive(Debug)]
pub struct SigningKeeper {
    file: Option<KeyFile>,
    start: Instant,
    start_timestamp: u64,
    told: Counts,
    told_at: Option<Instant>,
}

impl SigningKeeper {
    /// Reads the key, if there is a file for it, and begins to sign with it.
    ///
    /// # Errors
    /// As [`KeyFile::open`].
    pub fn new(path: Option<&Path>, hub: usize, unix_us: u64, links: &mut Links) -> Result<Self, Failure> {
        let start_timestamp = timestamp(unix_us);
        let file = match path.map(|path| KeyFile::open(path, hub)).transpose()? {
            Some((file, key, kept)) => {
                links.sign_with(Signing::new(key, kept));
                Some(file)
            }
            None => None,
        };
        links.signing().advance(start_timestamp);
        Ok(Self { file, start: Instant::now(), start_timestamp, told: Counts::default(), told_at: None })
    }

    /// Keeps what has changed, before it takes effect, and returns what is to be said.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn update(&mut self, links: &mut Links, now: Instant) -> Result<Said, Failure> {
        let since_start = now.saturating_duration_since(self.start).as_micros() as u64;
        links.signing().advance(self.start_timestamp + since_start / 10);
        let setups = links.take_setups();
        let new_key = setups.iter().any(|setup| !matches!(setup, SigningSetup::Refused(..)));
        if let Some(file) = &self.file {
            if let Some(kept) = links.signing().take_unkept() {
                file.keep(&kept)?;
            }
            if new_key {
                file.keep_key(links.signing().key())?;
            }
        }
        let mut lines: Vec<_> = setups.iter().map(|setup| (Severity::Warning, setup.to_string())).collect();
        lines.extend(self.refused(links.signing().counts(), now));
        Ok(Said { lines, new_key })
    }

    /// A line about refused frames, if there are more than were told, and it is time.
    fn refused(&mut self, counts: Counts, now: Instant) -> Option<(Severity, String)> {
        let early = self.told_at.is_some_and(|told| now.saturating_duration_since(told) < TOLD);
        if counts == self.told || early {
            return None;
        }
        (self.told, self.told_at) = (counts, Some(now));
        Some((Severity::Warning, format!("Signing: rejected so far: {counts}")))
    }

    /// Keeps the state at an end that was asked for.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn finish(&self, links: &mut Links) -> Result<(), Failure> {
        let counts = links.signing().counts();
        if counts != self.told {
            tracing::warn!("Signing: rejected in total: {counts}");
        }
        match &self.file {
            Some(file) => file.keep(&links.signing().at_end()),
            None => Ok(()),
        }
    }
}
