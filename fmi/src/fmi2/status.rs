//! Statuses that an importer can ask for.

use super::types::{DO_STEP_STATUS, Status, StatusKind};
use crate::error::CallError;
use crate::instance::Instance;
use crate::model::Model;

/// `fmi2DoStepStatus`: how the last step ended.
pub(super) fn step_status<M: Model>(instance: &Instance<M>, kind: StatusKind) -> Result<Status, CallError> {
    match (kind, instance.last_step_failed()) {
        (DO_STEP_STATUS, false) => Ok(Status::Ok),
        (DO_STEP_STATUS, true) => Ok(Status::Error),
        _ => Err(no_status(kind)),
    }
}

/// There is no such status, or it is of another type.
pub(super) fn no_status(kind: StatusKind) -> CallError {
    CallError::NoAnswer(format!("status kind {kind} is not available"))
}
