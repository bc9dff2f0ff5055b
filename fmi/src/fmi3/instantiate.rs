//! `fmi3InstantiateModelExchange`, `fmi3InstantiateCoSimulation`, `fmi3InstantiateScheduledExecution` and `fmi3FreeInstance`.

use std::ffi::CStr;
use std::panic::{AssertUnwindSafe, catch_unwind};

use thiserror::Error;

use super::guard::Instance;
use super::logger::sink;
use super::types::{
    Boolean, ClockUpdateCallback, FALSE, Instance as Pointer, InstanceEnvironment,
    IntermediateUpdateCallback, LogMessageCallback, PreemptionCallback, String as Text, ValueReference,
};
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
    #[error("instantiationToken is NULL")]
    NoToken,
    #[error(
        "instantiationToken = {given:?} does not match the library, which has {expected}: modelDescription.xml comes from another build"
    )]
    OtherToken { given: String, expected: String },
    #[error("{model} does not support model exchange; call fmi3InstantiateCoSimulation")]
    NoModelExchange { model: &'static str },
    #[error("scheduled execution is not supported; call fmi3InstantiateCoSimulation")]
    NoScheduledExecution,
    #[error(
        "eventModeUsed must be fmi3False: there is no event mode in co-simulation (hasEventMode = false)"
    )]
    NoEventMode,
    #[error(
        "nRequiredIntermediateVariables = {count}; must be 0: there is no intermediate update (providesIntermediateUpdate = false)"
    )]
    NoIntermediateUpdate { count: usize },
    #[error("internal error: {0}")]
    Panic(String),
}

/// What the importer asks for.
#[derive(Clone, Copy)]
pub(super) enum Wanted {
    ModelExchange,
    CoSimulation { event_mode: bool, intermediate_variables: usize },
    ScheduledExecution,
}

/// What the importer passes, as far as it is used.
///
/// The path of the resources is not: there are none, so any path is good, or none at all.
pub(super) struct Request<'a> {
    pub function: &'static str,
    pub wanted: Wanted,
    pub name: Option<&'a CStr>,
    pub token: Option<&'a CStr>,
    pub logging_on: bool,
    pub environment: InstanceEnvironment,
    pub callback: Option<LogMessageCallback>,
}

/// Makes an instance of one of the `models` for model exchange; NULL if it cannot.
///
/// # Safety
/// As in the FMI 3.0 specification: strings are NULL or end with NUL, the logger and its environment stay valid as long as the
/// instance.
#[expect(clippy::too_many_arguments, reason = "those of the standard, and the models")]
pub unsafe fn model_exchange(
    models: &[LibraryModel],
    name: Text,
    token: Text,
    _resource_path: Text,
    _visible: Boolean,
    logging_on: Boolean,
    environment: InstanceEnvironment,
    callback: Option<LogMessageCallback>,
) -> Pointer {
    let (function, wanted) = ("fmi3InstantiateModelExchange", Wanted::ModelExchange);
    // SAFETY: this function's contract.
    unsafe { made(models, function, wanted, [name, token], logging_on, environment, callback) }
}

/// Makes an instance of one of the `models` for co-simulation; NULL if it cannot.
///
/// # Safety
/// As for [`model_exchange`].
#[expect(clippy::too_many_arguments, reason = "those of the standard, and the models")]
pub unsafe fn co_simulation(
    models: &[LibraryModel],
    name: Text,
    token: Text,
    _resource_path: Text,
    _visible: Boolean,
    logging_on: Boolean,
    event_mode_used: Boolean,
    _early_return_allowed: Boolean,
    _required_intermediate_variables: *const ValueReference,
    intermediate_variables: usize,
    environment: InstanceEnvironment,
    callback: Option<LogMessageCallback>,
    _intermediate_update: Option<IntermediateUpdateCallback>,
) -> Pointer {
    let function = "fmi3InstantiateCoSimulation";
    let wanted = Wanted::CoSimulation { event_mode: event_mode_used != FALSE, intermediate_variables };
    // SAFETY: this function's contract.
    unsafe { made(models, function, wanted, [name, token], logging_on, environment, callback) }
}

/// Refuses to make an instance for scheduled execution, which is not offered.
///
/// # Safety
/// As for [`model_exchange`].
#[expect(clippy::too_many_arguments, reason = "those of the standard, and the models")]
pub unsafe fn scheduled_execution(
    models: &[LibraryModel],
    name: Text,
    token: Text,
    _resource_path: Text,
    _visible: Boolean,
    logging_on: Boolean,
    environment: InstanceEnvironment,
    callback: Option<LogMessageCallback>,
    _clock_update: Option<ClockUpdateCallback>,
    _lock_preemption: Option<PreemptionCallback>,
    _unlock_preemption: Option<PreemptionCallback>,
) -> Pointer {
    let (function, wanted) = ("fmi3InstantiateScheduledExecution", Wanted::ScheduledExecution);
    // SAFETY: this function's contract.
    unsafe { made(models, function, wanted, [name, token], logging_on, environment, callback) }
}

/// # Safety
/// As for [`model_exchange`].
unsafe fn made(
    models: &[LibraryModel],
    function: &'static str,
    wanted: Wanted,
    texts: [Text; 2],
    logging_on: Boolean,
    environment: InstanceEnvironment,
    callback: Option<LogMessageCallback>,
) -> Pointer {
    // SAFETY: this function's contract.
    let text = |text: Text| (!text.is_null()).then(|| unsafe { CStr::from_ptr(text) });
    let ([name, token], logging_on) = (texts.map(text), logging_on != FALSE);
    // SAFETY: this function's contract.
    unsafe {
        instantiate(models, &Request { function, wanted, name, token, logging_on, environment, callback })
    }
}

/// A new instance of one of the `models`; NULL, and a message, if the request is refused.
///
/// # Safety
/// The logger of `request` and its environment must stay valid as long as the instance.
pub(super) unsafe fn instantiate(models: &[LibraryModel], request: &Request<'_>) -> Pointer {
    let _environment = DefaultEnvironment::enter();
    // SAFETY: the caller's promise.
    let sink = unsafe { sink(request.callback, request.environment) };
    let logger = Logger::silenced(sink, request.logging_on);
    let chosen = catch_unwind(AssertUnwindSafe(|| {
        choose(models, request).map(|(model, kind)| (model, kind, model.layout()))
    }))
    .unwrap_or_else(|payload| Err(InstantiationError::Panic(message_of(&*payload))));
    match chosen {
        Ok((model, kind, layout)) => {
            let component = model.instance(kind, logger);
            Box::into_raw(Box::new(Instance { component, layout })).cast()
        }
        Err(error) => {
            logger.refused(&format!("{}: {error}", request.function));
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
    let given = request.token.ok_or(InstantiationError::NoToken)?.to_string_lossy();
    let model = find(models, &given)
        .map_err(|expected| InstantiationError::OtherToken { given: given.into_owned(), expected })?;
    let kind = match request.wanted {
        Wanted::ModelExchange if model.exchanges() => Kind::ModelExchange,
        Wanted::ModelExchange => return Err(InstantiationError::NoModelExchange { model: model.name() }),
        Wanted::CoSimulation { event_mode: true, .. } => return Err(InstantiationError::NoEventMode),
        Wanted::CoSimulation { intermediate_variables: 0, .. } => Kind::CoSimulation,
        Wanted::CoSimulation { intermediate_variables: count, .. } => {
            return Err(InstantiationError::NoIntermediateUpdate { count });
        }
        Wanted::ScheduledExecution => return Err(InstantiationError::NoScheduledExecution),
    };
    Ok((model, kind))
}

/// Frees an instance; NULL is none.
///
/// # Safety
/// `pointer` must be NULL or come from [`instantiate`], and not be used again.
pub(super) unsafe fn free(pointer: Pointer) {
    // SAFETY: it came from Box::into_raw in `instantiate`; the rest is the caller's promise.
    unsafe { guard::free::<Instance>(pointer) }
}
