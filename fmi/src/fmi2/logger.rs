//! The importer's logger: a variadic C function with a printf format.

use std::ffi::CString;

use super::types::{CallbackLogger, ComponentEnvironment, Status};
use crate::logger::{Category, Sink, printable};

/// A sink that calls the importer's logger with its own environment and the name of the instance.
///
/// # Safety
/// `callback` must have the signature of the specification and stay valid, with `environment`, as long as the sink.
pub(super) unsafe fn sink(
    callback: CallbackLogger,
    environment: ComponentEnvironment,
    instance_name: CString,
) -> Sink {
    Box::new(move |category, message| {
        let message = printable(message);
        // SAFETY: the caller's promise; the strings are NUL-terminated and outlive the call, and the only
        // variadic argument is what "%s" asks for.
        unsafe {
            callback(
                environment,
                instance_name.as_ptr(),
                status(category),
                category.name().as_ptr(),
                c"%s".as_ptr(),
                message.as_ptr(),
            );
        }
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
