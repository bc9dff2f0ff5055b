//! `fmi2Instantiate` and `fmi2FreeInstance`.

use std::ffi::{CStr, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};

use thiserror::Error;

use crate::guid::guid;
use crate::instance::Instance;
use crate::logger::Logger;
use crate::types::{CO_SIMULATION, CallbackFunctions, CallbackLogger, Component};

/// Why no instance was made.
#[derive(Debug, PartialEq, Error)]
pub(crate) enum InstantiationError {
    #[error("instanceName is NULL or empty")]
    NoName,
    #[error("fmuType = {fmu_type} is not fmi2CoSimulation")]
    NotCoSimulation { fmu_type: c_int },
    #[error("fmuGUID is NULL")]
    NoGuid,
    #[error(
        "fmuGUID = {given:?} is not that of this library, {expected}: modelDescription.xml is of another build"
    )]
    OtherGuid { given: String, expected: String },
    #[error("internal fault: {0}")]
    Panic(String),
}

/// What the importer passes, as far as it is used.
///
/// The location of the resources is not: there are none, so any location is good, or none at all.
pub(crate) struct Request<'a> {
    pub name: Option<&'a CStr>,
    pub fmu_type: c_int,
    pub guid: Option<&'a CStr>,
    pub functions: &'a CallbackFunctions,
    pub callback: CallbackLogger,
    pub logging_on: bool,
}

/// A new instance; NULL, and a message, if the request is refused.
pub(crate) fn instantiate(request: &Request<'_>) -> Component {
    let name = request.name.unwrap_or_default().to_owned();
    let environment = request.functions.component_environment;
    let logger = Logger::new(request.callback, environment, name, request.logging_on);
    let checked = catch_unwind(AssertUnwindSafe(|| check(request)))
        .unwrap_or_else(|payload| Err(InstantiationError::Panic(crate::guard::message_of(&*payload))));
    match checked {
        Ok(()) => Box::into_raw(Box::new(Instance::new(logger))).cast(),
        Err(error) => {
            logger.refused(&error);
            std::ptr::null_mut()
        }
    }
}

fn check(request: &Request<'_>) -> Result<(), InstantiationError> {
    if request.name.is_none_or(CStr::is_empty) {
        return Err(InstantiationError::NoName);
    }
    if request.fmu_type != CO_SIMULATION {
        return Err(InstantiationError::NotCoSimulation { fmu_type: request.fmu_type });
    }
    let given = request.guid.ok_or(InstantiationError::NoGuid)?.to_string_lossy();
    let expected = guid();
    if given != expected {
        return Err(InstantiationError::OtherGuid { given: given.into_owned(), expected });
    }
    Ok(())
}

/// Frees an instance; NULL is none.
///
/// # Safety
/// `component` must be NULL or come from [`instantiate`], and not be used again.
pub(crate) unsafe fn free(component: Component) {
    let instance = component.cast::<Instance>();
    if !instance.is_null() {
        // SAFETY: it came from Box::into_raw in `instantiate`; the rest is the caller's promise.
        let instance = unsafe { Box::from_raw(instance) };
        // Also a lost instance can be dropped: Rust's values are whole after a panic. Should that panic
        // again, there is nobody left to tell.
        let _ = catch_unwind(AssertUnwindSafe(|| drop(instance)));
    }
}
