//! The guard around every call of an instance: it checks that the call is allowed, catches panics and logs errors.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::component::Component;
use crate::error::{CallError, Severity};

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
