//! What stands between the importer and an instance, for every function: the instance exists, the call is
//! legal now, no panic gets out, and what goes wrong is logged.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::error::CallError;
use crate::instance::Instance;
use crate::lifecycle::Function;
use crate::types::{Component, Status};

/// Calls `body` with the instance.
///
/// # Safety
/// `component` must be NULL or come from `fmi2Instantiate`, not be freed, and not be in use by another
/// call.
pub(crate) unsafe fn call(
    component: Component,
    function: &Function,
    body: impl FnOnce(&mut Instance) -> Result<(), CallError>,
) -> Status {
    // SAFETY: the caller's promise.
    match unsafe { component.cast::<Instance>().as_mut() } {
        Some(instance) => guarded(instance, function, body),
        None => Status::Error,
    }
}

/// Calls `body` if the state of the instance allows it.
pub(crate) fn guarded(
    instance: &mut Instance,
    function: &Function,
    body: impl FnOnce(&mut Instance) -> Result<(), CallError>,
) -> Status {
    let state = instance.state();
    let outcome = if function.is_allowed_in(state) {
        // Unwind safety: after a panic the instance is given up, nobody sees it half changed.
        catch_unwind(AssertUnwindSafe(|| body(instance)))
            .unwrap_or_else(|payload| Err(CallError::Panic { message: message_of(&*payload) }))
    } else {
        Err(CallError::IllegalState { state })
    };
    match outcome {
        Ok(()) => Status::Ok,
        Err(error) => {
            let status = error.status();
            if status == Status::Fatal {
                instance.abandon();
            }
            instance.logger.error(function.name, &error);
            status
        }
    }
}

/// What `panic!` was given.
pub(crate) fn message_of(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message").to_owned()
}

// The logger below cannot stand in for a variadic one on Apple's ARM.
#[cfg(all(test, not(all(target_vendor = "apple", target_arch = "aarch64"))))]
mod tests {
    use std::ffi::{CStr, c_void};

    use super::guarded;
    use crate::instance::Instance;
    use crate::lifecycle::Function;
    use crate::logger::Logger;
    use crate::types::{CallbackLogger, ComponentEnvironment, Status, String as FmiString};

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

    fn instance(log: &mut Log) -> Instance {
        // SAFETY: see `record`.
        let callback =
            unsafe { std::mem::transmute::<*const c_void, CallbackLogger>(record as *const c_void) };
        Instance::new(Logger::new(callback, std::ptr::from_mut(log).cast(), c"test".into(), false))
    }

    #[test]
    fn panic_becomes_fatal() {
        let mut log = Log::new();
        let mut instance = instance(&mut log);
        let status = guarded(&mut instance, &Function::RESET, |_| panic!("a defect #{}", 1));
        assert_eq!(status, Status::Fatal);
        assert_eq!(guarded(&mut instance, &Function::RESET, Instance::reset), Status::Fatal);
        assert_eq!(log.len(), 2);
        assert_eq!((log[0].0, log[0].1.as_str()), (Status::Fatal, "logStatusFatal"));
        assert_eq!(log[0].2, "fmi2Reset: internal fault, the instance is lost: a defect ##1");
        assert_eq!(log[1].2, "fmi2Reset: must not be called in the state \"fatal\"");
    }
}
