//! Messages to the importer.

use std::ffi::{CStr, CString};

use crate::error::{CallError, Severity};
#[cfg(feature = "description")]
use crate::model::Words;

/// A log category, as a bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Category {
    /// Events in the life of the instance.
    Events = 1,
    /// Ignored requests and doubtful parameters.
    Warning = 2,
    /// Information that is not available.
    Discard = 4,
    /// Rejected calls and failed runs.
    Error = 8,
    /// Caught panics.
    Fatal = 16,
}

/// Categories by their standard names.
const CATEGORIES: [(Category, &CStr); 5] = [
    (Category::Events, c"logEvents"),
    (Category::Warning, c"logStatusWarning"),
    (Category::Discard, c"logStatusDiscard"),
    (Category::Error, c"logStatusError"),
    (Category::Fatal, c"logStatusFatal"),
];
const ALL: &CStr = c"logAll";
const EVERY: u8 = u8::MAX;

impl Category {
    /// Its standard name.
    pub fn name(self) -> &'static CStr {
        CATEGORIES.iter().find(|(known, _)| *known == self).map_or(ALL, |(_, name)| *name)
    }

    #[cfg(feature = "description")]
    fn description(self, words: &Words) -> &'static str {
        match self {
            Self::Events => words.events,
            Self::Warning => "Ignored requests and doubtful parameters",
            Self::Discard => "Information that is not available",
            Self::Error => words.errors,
            Self::Fatal => "Internal errors",
        }
    }
}

/// Names and descriptions of the categories, and whether they report errors, for the description.
#[cfg(feature = "description")]
pub(crate) fn categories(words: &Words) -> impl Iterator<Item = (String, &'static str, bool)> {
    CATEGORIES
        .into_iter()
        .map(|(category, name)| {
            (name, category.description(words), matches!(category, Category::Error | Category::Fatal))
        })
        .chain([(ALL, "All messages", false)])
        .map(|(name, description, of_errors)| (name.to_string_lossy().into_owned(), description, of_errors))
}

/// Passes one message to the importer in the form of its version of the interface.
pub(crate) type Sink = Box<dyn Fn(Category, &str)>;

/// A message as both versions of the interface want it: "#" begins a reference to a variable, and a NUL would end it.
pub(crate) fn printable(message: &str) -> CString {
    CString::new(message.replace('#', "##").replace('\0', " ")).unwrap_or_default()
}

/// Which categories the importer wants, and where messages go.
pub(crate) struct Logger {
    sink: Sink,
    enabled: u8,
    always: u8,
}

impl Logger {
    /// A logger for one instance. It passes on errors also when logging is off.
    pub fn new(sink: Sink, logging_on: bool) -> Self {
        Self { always: Category::Error as u8 | Category::Fatal as u8, ..Self::silenced(sink, logging_on) }
    }

    /// A logger for one instance, which is silent when logging is off.
    pub fn silenced(sink: Sink, logging_on: bool) -> Self {
        Self { sink, enabled: if logging_on { EVERY } else { 0 }, always: 0 }
    }

    /// Selects categories; no names select all of them.
    pub fn select(&mut self, logging_on: bool, names: &[&CStr]) -> Result<(), CallError> {
        let mut enabled = if names.is_empty() { EVERY } else { 0 };
        for name in names {
            enabled |= bits(name)?;
        }
        self.enabled = if logging_on { enabled } else { 0 };
        Ok(())
    }

    /// Logs an event.
    pub fn event(&self, message: &str) {
        self.log(Category::Events, message);
    }

    /// Logs an ignored request.
    pub fn warning(&self, message: &str) {
        self.log(Category::Warning, message);
    }

    /// Logs why a call was rejected.
    pub fn error(&self, function: &str, error: &CallError) {
        let category = match error.severity() {
            Severity::Discard => Category::Discard,
            Severity::Error => Category::Error,
            Severity::Fatal => Category::Fatal,
        };
        self.log(category, &format!("{function}: {error}"));
    }

    /// Tells why no instance was made, which is never kept back.
    pub fn refused(&self, message: &str) {
        (self.sink)(Category::Error, message);
    }

    fn log(&self, category: Category, message: &str) {
        if (self.enabled | self.always) & category as u8 != 0 {
            (self.sink)(category, message);
        }
    }
}

fn bits(name: &CStr) -> Result<u8, CallError> {
    if name == ALL {
        return Ok(EVERY);
    }
    CATEGORIES
        .iter()
        .find(|(_, known)| *known == name)
        .map(|(category, _)| *category as u8)
        .ok_or_else(|| CallError::UnknownCategory { name: name.to_string_lossy().into_owned() })
}
