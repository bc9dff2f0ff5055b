//! Statuses that an importer can ask for.

use super::types::{DO_STEP_STATUS, LAST_SUCCESSFUL_TIME, PENDING_STATUS, Status, StatusKind, TERMINATED};
use crate::component::Component;
use crate::error::CallError;

/// `fmi2DoStepStatus`: how the last step ended.
pub(super) fn step_status(instance: &dyn Component, kind: StatusKind) -> Result<Status, CallError> {
    match (kind, instance.last_step_failed()) {
        (DO_STEP_STATUS, false) => Ok(Status::Ok),
        (DO_STEP_STATUS, true) => Ok(Status::Error),
        _ => Err(no_status(kind)),
    }
}

/// There is no such status, or it is of another type.
pub(super) fn no_status(kind: StatusKind) -> CallError {
    CallError::NoAnswer(match kind {
        DO_STEP_STATUS => "fmi2DoStepStatus is read by fmi2GetStatus".to_owned(),
        PENDING_STATUS => "fmi2PendingStatus is not available: no step is ever pending".to_owned(),
        LAST_SUCCESSFUL_TIME => "fmi2LastSuccessfulTime is read by fmi2GetRealStatus".to_owned(),
        TERMINATED => "fmi2Terminated is read by fmi2GetBooleanStatus".to_owned(),
        _ => format!("unknown status kind {kind}; must be 0 to 3"),
    })
}
