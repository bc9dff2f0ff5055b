//! The guard of the FMI 2.0 functions: from a component to an instance, and from an outcome to a status.

use super::types::{Component as Pointer, Status};
use crate::component::Component;
use crate::error::{CallError, Severity};
use crate::guard::{entered, guarded};
use crate::lifecycle::Function;

/// What a function does with an instance.
type Body<'a> = &'a mut dyn FnMut(&mut dyn Component) -> Result<(), CallError>;

/// Calls `body` with the instance.
///
/// # Safety
/// `component` must be NULL or come from [`instantiate`](super::instantiate::instantiate), not be freed, and not be in use by another call.
pub(super) unsafe fn call(
    component: Pointer,
    function: &Function,
    mut body: impl FnMut(&mut dyn Component) -> Result<(), CallError>,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe { found(component, function, &mut body) }
}

/// [`call`], compiled once for all functions: there are many.
///
/// # Safety
/// As for [`call`].
unsafe fn found(component: Pointer, function: &Function, body: Body<'_>) -> Status {
    let checked = |instance: &mut Box<dyn Component>| checked(&mut **instance, function, body);
    // SAFETY: the caller's promise.
    unsafe { entered(component, checked) }.unwrap_or(Status::Error)
}

/// Calls `body` if the table of legal calls allows it.
fn checked(instance: &mut dyn Component, function: &Function, body: Body<'_>) -> Status {
    let is_allowed = function.is_allowed_in(instance.phase());
    match guarded(instance, function.name, is_allowed, body) {
        Ok(()) => Status::Ok,
        Err(Severity::Discard) => Status::Discard,
        Err(Severity::Error) => Status::Error,
        Err(Severity::Fatal) => Status::Fatal,
    }
}

// The logger below cannot stand in for a variadic one on Apple's ARM.
#[cfg(all(test, not(all(target_vendor = "apple", target_arch = "aarch64"))))]
mod tests {
    use std::ffi::{CStr, c_void};

    use super::checked;
    use crate::fmi2::lifecycle::RESET;
    use crate::fmi2::logger::sink;
    use crate::fmi2::types::{CallbackLogger, ComponentEnvironment, Status, String as FmiString};
    use crate::instance::Instance;
    use crate::lag::Lag;
    use crate::lifecycle::Kind;
    use crate::logger::Logger;

    type Log = Vec<(Status, String, String)>;

    /// Rust can call variadic functions but not define them; the arguments lie where a function with six
    /// parameters finds them.
    unsafe extern "C" fn record(
        environment: ComponentEnvironment,
        _instance: FmiString,
        status: Status,
        category: FmiString,
        format: FmiString,
        message: FmiString,
    ) {
        // SAFETY: the logger passes the environment it was given, and NUL-terminated strings.
        unsafe {
            assert_eq!(CStr::from_ptr(format), c"%s");
            let text = |text| CStr::from_ptr(text).to_string_lossy().into_owned();
            (*environment.cast::<Log>()).push((status, text(category), text(message)));
        }
    }

    fn instance(log: &mut Log) -> Instance<Lag> {
        // SAFETY: see `record`.
        let callback =
            unsafe { std::mem::transmute::<*const c_void, CallbackLogger>(record as *const c_void) };
        // SAFETY: the log outlives the instance.
        let sink = unsafe { sink(callback, std::ptr::from_mut(log).cast(), c"test".into()) };
        Instance::new(Kind::CoSimulation, Logger::new(sink, false))
    }

    #[test]
    fn panic_becomes_fatal() {
        let mut log = Log::new();
        let mut instance = instance(&mut log);
        let status = checked(&mut instance, &RESET, &mut |_| panic!("a defect #{}", 1));
        assert_eq!(status, Status::Fatal);
        assert_eq!(checked(&mut instance, &RESET, &mut |instance| instance.reset()), Status::Fatal);
        assert_eq!(log.len(), 2);
        assert_eq!((log[0].0, log[0].1.as_str()), (Status::Fatal, "logStatusFatal"));
        assert_eq!(log[0].2, "fmi2Reset: internal error; the instance can only be freed: a defect ##1");
        assert_eq!(log[1].2, "fmi2Reset: not allowed in the state \"fatal\"");
    }
}
