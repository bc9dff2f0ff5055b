//! Messages to the importer.

use std::ffi::{CStr, CString};

use crate::error::CallError;
use crate::instantiate::InstantiationError;
use crate::types::{CallbackLogger, ComponentEnvironment, Status};

/// A log category, as a bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Category {
    /// What happens to the instance.
    Events = 1,
    /// Requests that are ignored.
    Warning = 2,
    /// Answers that are not available.
    Discard = 4,
    /// Refused calls and failed flights.
    Error = 8,
    /// Caught panics.
    Fatal = 16,
}

/// Categories by their standard names, with what they carry.
const CATEGORIES: [(Category, &CStr, &str); 5] = [
    (Category::Events, c"logEvents", "Initialization, redesign of the controllers, reset"),
    (Category::Warning, c"logStatusWarning", "Requests that are ignored"),
    (Category::Discard, c"logStatusDiscard", "Answers that are not available"),
    (Category::Error, c"logStatusError", "Refused calls, and flights that cannot go on; always logged"),
    (Category::Fatal, c"logStatusFatal", "Internal faults; always logged"),
];
const ALL: (&CStr, &str) = (c"logAll", "All messages");
const EVERY: u8 = u8::MAX;

/// Names and descriptions of the categories, for the description.
#[cfg(feature = "description")]
pub(crate) fn categories() -> impl Iterator<Item = (String, &'static str)> {
    CATEGORIES
        .into_iter()
        .map(|(_, name, description)| (name, description))
        .chain([ALL])
        .map(|(name, description)| (name.to_string_lossy().into_owned(), description))
}

/// The importer's logger and what it wants to hear.
pub(crate) struct Logger {
    callback: CallbackLogger,
    environment: ComponentEnvironment,
    instance_name: CString,
    enabled: u8,
}

impl Logger {
    /// A logger for one instance.
    pub fn new(
        callback: CallbackLogger,
        environment: ComponentEnvironment,
        instance_name: CString,
        logging_on: bool,
    ) -> Self {
        Self { callback, environment, instance_name, enabled: if logging_on { EVERY } else { 0 } }
    }

    /// Selects categories; none named means all of them.
    pub fn select(&mut self, logging_on: bool, names: &[&CStr]) -> Result<(), CallError> {
        let mut enabled = if names.is_empty() { EVERY } else { 0 };
        for name in names {
            enabled |= bits(name)?;
        }
        self.enabled = if logging_on { enabled } else { 0 };
        Ok(())
    }

    /// What happens to the instance.
    pub fn event(&self, message: &str) {
        self.log(Status::Ok, Category::Events, message);
    }

    /// A request that is ignored.
    pub fn warning(&self, message: &str) {
        self.log(Status::Warning, Category::Warning, message);
    }

    /// Why a function was not carried out.
    pub fn error(&self, function: &str, error: &CallError) {
        let status = error.status();
        let category = match status {
            Status::Fatal => Category::Fatal,
            Status::Discard => Category::Discard,
            _ => Category::Error,
        };
        self.log(status, category, &format!("{function}: {error}"));
    }

    /// Why there is no instance.
    pub fn refused(&self, error: &InstantiationError) {
        self.log(Status::Error, Category::Error, &format!("fmi2Instantiate: {error}"));
    }

    fn log(&self, status: Status, category: Category, message: &str) {
        let always = matches!(category, Category::Error | Category::Fatal);
        if !always && self.enabled & category as u8 == 0 {
            return;
        }
        let name =
            CATEGORIES.iter().find(|(known, ..)| *known == category).map_or(ALL.0, |(_, name, _)| name);
        // "#" begins a reference to a variable; a NUL would end the message.
        let message = message.replace('#', "##").replace('\0', " ");
        let message = CString::new(message).unwrap_or_default();
        // SAFETY: the importer gave the logger for the lifetime of the instance, with the signature of
        // the specification; the strings are NUL-terminated and outlive the call, and the only variadic
        // argument is what "%s" asks for.
        unsafe {
            (self.callback)(
                self.environment,
                self.instance_name.as_ptr(),
                status,
                name.as_ptr(),
                c"%s".as_ptr(),
                message.as_ptr(),
            );
        }
    }
}

fn bits(name: &CStr) -> Result<u8, CallError> {
    if name == ALL.0 {
        return Ok(EVERY);
    }
    CATEGORIES
        .iter()
        .find(|(_, known, _)| *known == name)
        .map(|(category, ..)| *category as u8)
        .ok_or_else(|| CallError::UnknownCategory { name: name.to_string_lossy().into_owned() })
}
