//! How an FMU in a process of its own can fail.

use std::fmt;
use std::time::Duration;

use crate::fmi2::Call;

/// What went wrong, in which call, and what the FMU said last. The message is one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GuestError {
    /// The FMU.
    pub(super) name: String,
    pub(super) cause: Cause,
    /// What it said last, oldest first.
    pub(super) last_words: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Cause {
    /// The host's process could not be started.
    NotStarted(String),
    /// A call failed, or the library could not be loaded.
    Failed(String),
    /// A signal or exception ended the process.
    Crashed(Call, String),
    /// It ended its own process.
    Exited(Call, Option<i32>),
    /// A call did not return in time.
    Hung(Call, Duration),
    /// It answered with something else than what the host sends.
    Babbled(String),
}

impl fmt::Display for GuestError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = &self.name;
        match &self.cause {
            Cause::NotStarted(why) => write!(formatter, "cannot start a process for the FMU {name}: {why}")?,
            Cause::Failed(what) => write!(formatter, "the FMU {name}: {what}")?,
            Cause::Crashed(call, how) => write!(formatter, "the FMU {name} crashed in {call}: {how}")?,
            Cause::Exited(call, Some(code)) => {
                write!(formatter, "the FMU {name} ended its process in {call}, with exit code {code}")?;
            }
            Cause::Exited(call, None) => write!(formatter, "the FMU {name} ended its process in {call}")?,
            Cause::Hung(call, within) => write!(
                formatter,
                "the FMU {name} did not return from {call} within {} s; its process was ended",
                within.as_secs_f64()
            )?,
            Cause::Babbled(why) => write!(formatter, "the process of the FMU {name} sent no answer: {why}")?,
        }
        if self.last_words.is_empty() {
            return Ok(());
        }
        write!(formatter, "; it said: {}", self.last_words.join(" | "))
    }
}

impl std::error::Error for GuestError {}
