//! The guard around every call of an instance: it checks that the call is allowed, catches panics and logs errors.

use std::any::Any;
use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::component::Component;
use crate::error::{CallError, Severity};
use crate::floating_point::DefaultEnvironment;
use crate::stack::with_room;

/// Calls `body` with what `pointer` leads to, in the default floating-point environment and with room on the stack; `None` if it is NULL.
///
/// # Safety
/// `pointer` must be NULL or lead to a `T` that is alive and not in use by another call.
pub(crate) unsafe fn entered<T, R>(pointer: *mut c_void, body: impl FnOnce(&mut T) -> R) -> Option<R> {
    let _environment = DefaultEnvironment::enter();
    // SAFETY: the caller's promise.
    let there = unsafe { pointer.cast::<T>().as_mut() }?;
    Some(with_room(|| body(there)))
}

/// Frees what `pointer` leads to; NULL is nothing.
///
/// # Safety
/// `pointer` must be NULL or come from `Box::into_raw` for a `T`, and not be used again.
pub(crate) unsafe fn free<T>(pointer: *mut c_void) {
    let _environment = DefaultEnvironment::enter();
    if !pointer.is_null() {
        // SAFETY: the caller's promise.
        let instance = unsafe { Box::from_raw(pointer.cast::<T>()) };
        // Also a lost instance can be dropped: Rust's values are whole after a panic. Should that panic
        // again, there is nobody left to tell.
        let _ = catch_unwind(AssertUnwindSafe(|| drop(instance)));
    }
}

/// Calls `body` with the instance if `function` is allowed in its phase.
pub(crate) fn guarded(
    instance: &mut dyn Component,
    function: &str,
    is_allowed: bool,
    body: &mut dyn FnMut(&mut dyn Component) -> Result<(), CallError>,
) -> Result<(), Severity> {
    let outcome = if is_allowed {
        // Unwind safety: after a panic the instance is given up, nobody sees it half changed.
        catch_unwind(AssertUnwindSafe(|| body(instance)))
            .unwrap_or_else(|payload| Err(CallError::Panic { message: message_of(&*payload) }))
    } else {
        Err(CallError::IllegalPhase { phase: instance.phase() })
    };
    outcome.map_err(|error| {
        let severity = error.severity();
        if severity == Severity::Fatal {
            instance.abandon();
        }
        instance.logger().error(function, &error);
        severity
    })
}

/// The message of a panic.
pub(crate) fn message_of(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message").to_owned()
}
