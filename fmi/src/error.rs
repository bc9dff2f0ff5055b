//! Why a call was rejected.

use std::fmt::Display;

use thiserror::Error;

use crate::lifecycle::Phase;
use crate::model::Model;
use crate::variables::ValueReference;

/// How serious an error is; each version of the interface maps it to a status.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Severity {
    /// The requested information is not available.
    Discard,
    /// The call was rejected, or the run cannot continue.
    Error,
    /// The instance can only be freed.
    Fatal,
}

/// Why a call was rejected. Unless documented otherwise, a rejected call changes nothing.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum CallError {
    #[error("not allowed in the state \"{phase}\"")]
    IllegalPhase { phase: Phase },
    #[error("{argument} is NULL")]
    NullPointer { argument: &'static str },
    #[error("{argument} has {count} elements, which do not fit into memory")]
    TooMany { argument: &'static str, count: usize },
    #[error("unknown value reference {reference}")]
    UnknownReference { reference: ValueReference },
    #[error("{name} (value reference {reference}) has type {declared}, not {asked}")]
    WrongType { name: &'static str, reference: ValueReference, declared: &'static str, asked: &'static str },
    #[error(
        "value reference {reference} is an element of the array {array}, which is read and set as a whole: use value \
         reference {first}"
    )]
    InsideArray { reference: ValueReference, array: &'static str, first: ValueReference },
    #[error("value reference {reference} is not a String: this model has no String variables")]
    NoStrings { reference: ValueReference },
    #[error("{name} cannot be set: it is {kind} (read-only)")]
    ReadOnly { name: &'static str, kind: &'static str },
    #[error("{name} is fixed: set it before the end of initialization mode")]
    Fixed { name: &'static str },
    #[error("{name} = {value}; allowed {allowed}")]
    OutOfRange { name: &'static str, value: String, allowed: String },
    #[error("{name} does not accept derivatives: only continuous Real inputs do")]
    NotContinuousInput { name: &'static str },
    #[error("{name}: derivative of order {order} is not supported; allowed 1 to {maximum}")]
    DerivativeOrder { name: &'static str, order: i32, maximum: i32 },
    #[error("{name}: derivative of order {order} = {value:?}; must be finite")]
    DerivativeNotFinite { name: &'static str, order: i32, value: f64 },
    #[error("{name} = {value:?}; must be a finite time, at most 285 years after startTime")]
    Time { name: &'static str, value: f64 },
    #[error("stopTime = {stop_s:?} is before startTime = {start_s:?}")]
    StopBeforeStart { start_s: f64, stop_s: f64 },
    #[error("communicationStepSize = {step_s:?}; must be a positive number")]
    StepSize { step_s: f64 },
    #[error(
        "communicationStepSize = {step_s:?}; must be at most {longest_s:?} s, because a step cannot be interrupted: \
         divide it into shorter steps"
    )]
    StepTooLong { step_s: f64, longest_s: f64 },
    #[error("currentCommunicationPoint = {given_s:?}; expected {expected_s:?}, where the last step ended")]
    CommunicationPoint { given_s: f64, expected_s: f64 },
    #[error("the step ends at {end_s:?}, after stopTime = {stop_s:?}")]
    PastStop { end_s: f64, stop_s: f64 },
    #[error("{argument} = {given}; must be {expected}, as in the model description")]
    Count { argument: &'static str, given: usize, expected: usize },
    #[error("state {name} = {value:?}; must be a finite number")]
    StateNotFinite { name: &'static str, value: f64 },
    #[error("{name} = {value:?} is not a finite number in this state; try a shorter step")]
    NoDerivative { name: &'static str, value: f64 },
    #[error("event indicator {place} = {value:?} is not a finite number in this state; try a shorter step")]
    NoIndicator { place: usize, value: f64 },
    #[error("{name} has no derivatives: only continuous outputs and derivatives of states do")]
    NotAnUnknown { name: &'static str },
    #[error("no derivative with respect to {name}: it must be a continuous input or state")]
    NotAKnown { name: &'static str },
    #[error(
        "{name} can only be set in event mode; in continuous-time mode only continuous inputs can be set"
    )]
    OnlyAtEvents { name: &'static str },
    #[error("unknown log category {name:?}; the model description lists them all")]
    UnknownCategory { name: String },
    #[error("{name} is {value}, not a finite number")]
    NotFinite { name: &'static str, value: f64 },
    /// Information that this library never provides, in the terms of the interface.
    #[error("{0}")]
    NoAnswer(String),
    /// A function that this library does not implement, in the terms of the interface.
    #[error("{0}")]
    NotOffered(&'static str),
    #[error(transparent)]
    SavedState(#[from] SavedStateError),
    /// An error of the model.
    #[error("{0}")]
    Model(String),
    #[error("the {run} cannot continue: {message}")]
    Step { run: &'static str, message: String },
    #[error("internal error; the instance can only be freed: {message}")]
    Panic { message: String },
}

impl CallError {
    /// The model rejected parameters or a state.
    pub fn of_model(error: impl Display) -> Self {
        Self::Model(error.to_string())
    }

    /// A run of `M` that cannot continue.
    pub fn of_step<M: Model>(message: String) -> Self {
        Self::Step { run: M::IDENTITY.words.run, message }
    }

    /// Its severity.
    pub fn severity(&self) -> Severity {
        match self {
            Self::Panic { .. } | Self::IllegalPhase { phase: Phase::Fatal } => Severity::Fatal,
            Self::NoAnswer(_) | Self::NoDerivative { .. } | Self::NoIndicator { .. } => Severity::Discard,
            _ => Severity::Error,
        }
    }
}

/// What is wrong with the bytes of a serialized state.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum SavedStateError {
    #[error("not a saved state: {size} bytes without the expected header")]
    NoHeader { size: usize },
    #[error("the saved state has format {found}; this library reads format {expected}")]
    Format { found: u32, expected: u32 },
    #[error("the saved state belongs to another model or another version of this model")]
    OtherModel,
    #[error("the saved state is that of the other kind, model exchange or co-simulation")]
    OtherKind,
    #[error("the saved state has {actual} bytes; expected {expected}")]
    Length { actual: usize, expected: usize },
    #[error("the saved state is corrupt: checksum mismatch")]
    Checksum,
    #[error("the saved state is corrupt: it cannot be decoded")]
    Undecodable,
    #[error("the saved state is corrupt: it contains NaN or infinity")]
    NotFinite,
    #[error("the saved state is inconsistent: {0}")]
    Inconsistent(&'static str),
    #[error("the saved state is inconsistent: the {run} is missing")]
    NoRun { run: &'static str },
    #[error("the saved state is inconsistent: the time of the {run} differs from the clock")]
    OtherTime { run: &'static str },
}
