//! `fmi2Instantiate` and `fmi2FreeInstance`.

use std::ffi::{CStr, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};

use thiserror::Error;

use super::logger::sink;
use super::types::{CO_SIMULATION, CallbackFunctions, CallbackLogger, Component};
use crate::floating_point::DefaultEnvironment;
use crate::guard::message_of;
use crate::identity::guid;
use crate::instance::Instance;
use crate::logger::Logger;
use crate::model::Model;

/// Why no instance was made.
#[derive(Debug, PartialEq, Error)]
pub(super) enum InstantiationError {
    #[error("instanceName is NULL or empty")]
    NoName,
    #[error("fmuType = {fmu_type}; only fmi2CoSimulation is supported")]
    NotCoSimulation { fmu_type: c_int },
    #[error("fmuGUID is NULL")]
    NoGuid,
    #[error(
        "fmuGUID = {given:?} does not match the library's {expected}: modelDescription.xml comes from another build"
    )]
    OtherGuid { given: String, expected: String },
    #[error("internal error: {0}")]
    Panic(String),
}

/// What the importer passes, as far as it is used.
///
/// The location of the resources is not: there are none, so any location is good, or none at all.
pub(super) struct Request<'a> {
    pub name: Option<&'a CStr>,
    pub fmu_type: c_int,
    pub guid: Option<&'a CStr>,
    pub functions: &'a CallbackFunctions,
    pub callback: CallbackLogger,
    pub logging_on: bool,
}

/// A new instance; NULL, and a message, if the request is refused.
///
/// # Safety
/// The logger of `request` and its environment must stay valid as long as the instance.
pub(super) unsafe fn instantiate<M: Model>(request: &Request<'_>) -> Component {
    let _environment = DefaultEnvironment::enter();
    let name = request.name.unwrap_or_default().to_owned();
    let environment = request.functions.component_environment;
    // SAFETY: the caller's promise.
    let logger = Logger::new(unsafe { sink(request.callback, environment, name) }, request.logging_on);
    let checked = catch_unwind(AssertUnwindSafe(|| check::<M>(request)))
        .unwrap_or_else(|payload| Err(InstantiationError::Panic(message_of(&*payload))));
    match checked {
        Ok(()) => Box::into_raw(Box::new(Instance::<M>::new(logger))).cast(),
        Err(error) => {
            logger.refused(&format!("fmi2Instantiate: {error}"));
            std::ptr::null_mut()
        }
    }
}

fn check<M: Model>(request: &Request<'_>) -> Result<(), InstantiationError> {
    if request.name.is_none_or(CStr::is_empty) {
        return Err(InstantiationError::NoName);
    }
    if request.fmu_type != CO_SIMULATION {
        return Err(InstantiationError::NotCoSimulation { fmu_type: request.fmu_type });
    }
    let given = request.guid.ok_or(InstantiationError::NoGuid)?.to_string_lossy();
    let expected = guid::<M>();
    if given != expected {
        return Err(InstantiationError::OtherGuid { given: given.into_owned(), expected });
    }
    Ok(())
}

/// Frees an instance; NULL is none.
///
/// # Safety
/// `component` must be NULL or come from [`instantiate`] for the same `M`, and not be used again.
pub(super) unsafe fn free<M: Model>(component: Component) {
    let _environment = DefaultEnvironment::enter();
    let instance = component.cast::<Instance<M>>();
    if !instance.is_null() {
        // SAFETY: it came from Box::into_raw in `instantiate`; the rest is the caller's promise.
        let instance = unsafe { Box::from_raw(instance) };
        // Also a lost instance can be dropped: Rust's values are whole after a panic. Should that panic
        // again, there is nobody left to tell.
        let _ = catch_unwind(AssertUnwindSafe(|| drop(instance)));
    }
}
