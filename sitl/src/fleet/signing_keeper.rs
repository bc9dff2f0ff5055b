//! Signing at the edge: the wall clock, the key files and the announcements.

use std::path::Path;
use std::time::{Duration, Instant};

use vehicle::Severity;

use crate::failure::Failure;
use crate::files::{Notice, Upkeep};
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

/// The files of a key.
#[derive(Debug)]
struct Files {
    key_file: KeyFile,
    timestamps: Upkeep,
    key: Upkeep,
    /// Whether the key in use is another than that of the file.
    new_key: bool,
}

/// Keeps the state of signing up to date, on the disk, too.
#[derive(Debug)]
pub struct SigningKeeper {
    files: Option<Files>,
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
        let files = match path {
            Some(path) => {
                let (key_file, key, kept) = KeyFile::open(path, hub)?;
                links.sign_with(Signing::new(key, kept));
                Some(Files {
                    timestamps: Upkeep::new("Signing timestamps", key_file.timestamps()),
                    key: Upkeep::new("Signing key", path),
                    key_file,
                    new_key: false,
                })
            }
            None => None,
        };
        links.signing().advance(start_timestamp);
        Ok(Self { files, start: Instant::now(), start_timestamp, told: Counts::default(), told_at: None })
    }

    /// Keeps what has changed, before it takes effect, and returns what is to be said. What cannot be written is tried again each
    /// second; meanwhile signing goes on, and only a restart could forget which frames have come.
    pub fn update(&mut self, links: &mut Links, now: Instant) -> Said {
        let since_start = now.saturating_duration_since(self.start).as_micros() as u64;
        links.signing().advance(self.start_timestamp + since_start / 10);
        let setups = links.take_setups();
        let new_key = setups.iter().any(|setup| !matches!(setup, SigningSetup::Refused(..)));
        let mut lines: Vec<_> = setups.iter().map(|setup| (Severity::Warning, setup.to_string())).collect();
        if let Some(files) = &mut self.files {
            files.new_key |= new_key;
            lines.extend(files.keep(links.signing(), now));
        }
        lines.extend(self.refused(links.signing().counts(), now));
        Said { lines, new_key }
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

    /// Keeps the state at an end that was asked for. Returns what is missing from the files, a sentence each.
    pub fn finish(&mut self, links: &mut Links) -> Vec<String> {
        let counts = links.signing().counts();
        if counts != self.told {
            tracing::warn!("Signing: rejected in total: {counts}");
        }
        self.files.as_mut().map_or_else(Vec::new, |files| files.finish(links.signing()))
    }
}

impl Files {
    /// Keeps what has changed. Returns what to announce.
    fn keep(&mut self, signing: &mut Signing, now: Instant) -> Vec<Notice> {
        let Self { key_file, timestamps, key, new_key } = self;
        let mut notices = Vec::new();
        if signing.is_unkept() {
            notices.extend(timestamps.attempt(now, || {
                let result = signing.take_unkept().map_or(Ok(()), |kept| key_file.keep(&kept));
                if result.is_err() {
                    signing.keep_again();
                }
                result
            }));
        }
        if *new_key {
            notices.extend(key.attempt(now, || {
                key_file.keep_key(signing.key())?;
                *new_key = false;
                Ok(())
            }));
        }
        notices
    }

    fn finish(&mut self, signing: &Signing) -> Vec<String> {
        let _told_below = self.timestamps.judge(self.key_file.keep(&signing.at_end()));
        if self.new_key {
            let result = self.key_file.keep_key(signing.key());
            self.new_key = result.is_err();
            let _told_below = self.key.judge(result);
        }
        let timestamps = self.timestamps.is_failing().then(|| {
            self.timestamps.lacks(
                "lacks the latest timestamps, so that frames of this run could be replayed to the next",
            )
        });
        let key = self.new_key.then(|| self.key.lacks("lacks the key that was set by SETUP_SIGNING"));
        timestamps.into_iter().chain(key).collect()
    }
}
