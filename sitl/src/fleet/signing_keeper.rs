//! Signing at the edge: the wall clock, the key files and the announcements.

use std::path::Path;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use vehicle::Severity;

use crate::failure::Failure;
use crate::files::{Notice, Upkeep};
use crate::link::{Links, SigningSetup};
use crate::rarely::Rarely;
use crate::signing::{Counts, KeyFile, Signing, timestamp};

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
    told: Counts,
    rejections: Rarely,
    refusals: Rarely,
}

impl SigningKeeper {
    /// Reads the key, if there is a file for it, and begins to sign with it. An empty file is refused unless the key may come
    /// by SETUP_SIGNING.
    ///
    /// # Errors
    /// As [`KeyFile::open`].
    pub fn new(path: Option<&Path>, hub: usize, waits: bool, links: &mut Links) -> Result<Self, Failure> {
        let files = match path {
            Some(path) => {
                let (key_file, key, kept) = KeyFile::open(path, hub)?;
                if key.is_none() && !waits {
                    let reason = "is empty; write a key of 64 hexadecimal digits into it, or add --accept-signing-setup to let a \
                                  local client set the key";
                    return Err(Failure::Content { path: path.to_owned(), reason: reason.to_owned() });
                }
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
        links.signing().set_clock(present());
        Ok(Self {
            files,
            told: Counts::default(),
            rejections: Rarely::default(),
            refusals: Rarely::default(),
        })
    }

    /// Keeps what has changed, before it takes effect, and returns what is to be said. What cannot be written is tried again each
    /// second; meanwhile signing goes on, and only a restart could forget which frames have come. `timestamp` is that of the present.
    pub fn update(&mut self, links: &mut Links, now: Instant, timestamp: u64) -> Said {
        links.signing().set_clock(timestamp);
        let setups = links.take_setups();
        let new_key = setups.iter().any(SigningSetup::is_change);
        let mut lines: Vec<_> = setups
            .iter()
            .filter(|setup| setup.is_change() || self.refusals.is_due(now))
            .map(|setup| (Severity::Warning, setup.to_string()))
            .collect();
        if let Some(files) = &mut self.files {
            files.new_key |= new_key;
            lines.extend(files.keep(links.signing(), now));
        }
        lines.extend(self.refused(links.signing().counts(), now));
        Said { lines, new_key }
    }

    /// A line about refused frames, if there are more than were told, and it is time.
    fn refused(&mut self, counts: Counts, now: Instant) -> Option<(Severity, String)> {
        if counts == self.told || !self.rejections.is_due(now) {
            return None;
        }
        let clocks = (counts.late, counts.early) != (self.told.late, self.told.early);
        self.told = counts;
        let hint = if clocks { "; compare the clocks" } else { "" };
        Some((Severity::Warning, format!("Signing: rejected so far: {counts}{hint}")))
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

/// The timestamp of the present, by the machine's clock as it is set now: it may be corrected while vehicles fly.
pub fn present() -> u64 {
    timestamp(SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_micros() as u64)
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
