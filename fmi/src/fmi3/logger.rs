//! The importer's logger.

use std::ffi::CString;

use super::types::{InstanceEnvironment, LogMessageCallback, Status};
use crate::logger::{Category, Sink, printable};

/// A sink that calls the importer's logger with its own environment; without a logger messages end here.
///
/// # Safety
/// `callback` must have the signature of the specification and stay valid, with `environment`, as long as the sink.
pub(super) unsafe fn sink(callback: Option<LogMessageCallback>, environment: InstanceEnvironment) -> Sink {
    Box::new(move |category, message| {
        let Some(callback) = callback else { return };
        let message: CString = printable(message);
        // SAFETY: the caller's promise; the strings are NUL-terminated and outlive the call.
        unsafe { callback(environment, status(category), category.name().as_ptr(), message.as_ptr()) };
    })
}

fn status(category: Category) -> Status {
    match category {
        Category::Events => Status::Ok,
        Category::Warning => Status::Warning,
        Category::Discard => Status::Discard,
        Category::Error => Status::Error,
        Category::Fatal => Status::Fatal,
    }
}
