//! `fmi2Instantiate` and `fmi2FreeInstance`.

use std::ffi::{CStr, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};

use thiserror::Error;

use super::logger::sink;
use super::types::{CO_SIMULATION, CallbackFunctions, CallbackLogger, Component as Pointer, MODEL_EXCHANGE};
use crate::component::Component;
use crate::floating_point::DefaultEnvironment;
use crate::guard::{self, message_of};
use crate::library::{LibraryModel, find};
use crate::lifecycle::Kind;
use crate::logger::Logger;

/// Why no instance was made.
#[derive(Debug, PartialEq, Error)]
pub(super) enum InstantiationError {
    #[error("instanceName is NULL or empty")]
    NoName,
    #[error("fmuType = {fmu_type}; {model} supports {supported}")]
    Kind { fmu_type: c_int, model: &'static str, supported: &'static str },
    #[error("fmuGUID is NULL")]
    NoGuid,
    #[error(
        "fmuGUID = {given:?} does not match the library, which has {expected}: modelDescription.xml comes from another build"
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

/// A new instance of one of the `models`; NULL, and a message, if the request is refused.
///
/// # Safety
/// The logger of `request` and its environment must stay valid as long as the instance.
pub(super) unsafe fn instantiate(models: &[LibraryModel], request: &Request<'_>) -> Pointer {
    let _environment = DefaultEnvironment::enter();
    let name = request.name.unwrap_or_default().to_owned();
    let environment = request.functions.component_environment;
    // SAFETY: the caller's promise.
    let logger = Logger::new(unsafe { sink(request.callback, environment, name) }, request.logging_on);
    let chosen = catch_unwind(AssertUnwindSafe(|| choose(models, request)))
        .unwrap_or_else(|payload| Err(InstantiationError::Panic(message_of(&*payload))));
    match chosen {
        Ok((model, kind)) => Box::into_raw(Box::new(model.instance(kind, logger))).cast(),
        Err(error) => {
            logger.refused(&format!("fmi2Instantiate: {error}"));
            std::ptr::null_mut()
        }
    }
}

fn choose<'a>(
    models: &'a [LibraryModel],
    request: &Request<'_>,
) -> Result<(&'a LibraryModel, Kind), InstantiationError> {
    if request.name.is_none_or(CStr::is_empty) {
        return Err(InstantiationError::NoName);
    }
    let given = request.guid.ok_or(InstantiationError::NoGuid)?.to_string_lossy();
    let model = find(models, &given)
        .map_err(|expected| InstantiationError::OtherGuid { given: given.into_owned(), expected })?;
    match request.fmu_type {
        CO_SIMULATION => Ok((model, Kind::CoSimulation)),
        MODEL_EXCHANGE if model.exchanges() => Ok((model, Kind::ModelExchange)),
        fmu_type => Err(InstantiationError::Kind {
            fmu_type,
            model: model.name(),
            supported: if model.exchanges() {
                "0 (fmi2ModelExchange) and 1 (fmi2CoSimulation)"
            } else {
                "only 1 (fmi2CoSimulation)"
            },
        }),
    }
}

/// Frees an instance; NULL is none.
///
/// # Safety
/// `component` must be NULL or come from [`instantiate`], and not be used again.
pub(super) unsafe fn free(component: Pointer) {
    // SAFETY: it came from Box::into_raw in `instantiate`; the rest is the caller's promise.
    unsafe { guard::free::<Box<dyn Component>>(component) }
}
