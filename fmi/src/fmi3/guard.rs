//! The guard of the FMI 3.0 functions: from a pointer to an instance, and from an outcome to a status.

use super::types::{Instance as Pointer, Status};
use crate::component::Component;
use crate::error::{CallError, Severity};
use crate::guard::{entered, guarded};
use crate::layout::Layout;
use crate::lifecycle::Function;

/// What an importer's pointer leads to.
pub(super) struct Instance {
    /// The instance, whatever its model.
    pub component: Box<dyn Component>,
    /// Its variables.
    pub layout: Layout,
}

/// What a function does with an instance.
type Body<'a> = &'a mut dyn FnMut(&mut dyn Component, &Layout) -> Result<(), CallError>;

/// Calls `body` with the instance if the table of legal calls allows it.
///
/// # Safety
/// `pointer` must be NULL or come from [`instantiate`](super::instantiate::instantiate), not be freed, and not be in use by another call.
pub(super) unsafe fn call(
    pointer: Pointer,
    function: &Function,
    mut body: impl FnMut(&mut dyn Component, &Layout) -> Result<(), CallError>,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe { checked(pointer, function, &mut body) }
}

/// [`call`], compiled once for all functions: there are many.
///
/// # Safety
/// As for [`call`].
unsafe fn checked(pointer: Pointer, function: &Function, body: Body<'_>) -> Status {
    let checked = |Instance { component, layout }: &mut Instance| {
        let is_allowed = function.is_allowed_in(component.phase());
        match guarded(&mut **component, function.name, is_allowed, &mut |component| body(component, layout)) {
            Ok(()) => Status::Ok,
            Err(Severity::Discard) => Status::Discard,
            Err(Severity::Error) => Status::Error,
            Err(Severity::Fatal) => Status::Fatal,
        }
    };
    // SAFETY: the caller's promise.
    unsafe { entered(pointer, checked) }.unwrap_or(Status::Error)
}
