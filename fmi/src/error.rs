//! Why a call was not carried out.

use std::fmt::Display;

use thiserror::Error;

use crate::lifecycle::Phase;
use crate::model::Model;
use crate::variables::{Type, Value, ValueReference};

/// How bad it is; each version of the interface has a status for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Severity {
    /// The answer is not available.
    Discard,
    /// The call was refused, or the run cannot go on.
    Error,
    /// The instance is lost.
    Fatal,
}

/// Why a call was not carried out. Unless it says otherwise, nothing has changed then.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum CallError {
    #[error("must not be called in the state \"{phase}\"")]
    IllegalPhase { phase: Phase },
    #[error("{argument} is NULL")]
    NullPointer { argument: &'static str },
    #[error("{argument} has {count} elements, more than there is memory for")]
    TooMany { argument: &'static str, count: usize },
    #[error("there is no variable with value reference {reference}")]
    UnknownReference { reference: ValueReference },
    #[error("{name} (value reference {reference}) is of type {declared}, not {asked}")]
    WrongType { name: &'static str, reference: ValueReference, declared: Type, asked: Type },
    #[error("there is no String variable; value reference {reference} was given")]
    NoStrings { reference: ValueReference },
    #[error("{name} cannot be set: it is {causality}")]
    NotSettable { name: &'static str, causality: &'static str },
    #[error("{name} is fixed and cannot be set after initialization mode")]
    Fixed { name: &'static str },
    #[error("{name} = {value} is outside [{minimum}, {maximum}]")]
    OutOfRange { name: &'static str, value: Value, minimum: Value, maximum: Value },
    #[error("{name} has no derivatives: it is not a continuous Real input")]
    NotContinuousInput { name: &'static str },
    #[error("{name}: derivatives of order {order} are not supported, only 1 to {maximum}")]
    DerivativeOrder { name: &'static str, order: i32, maximum: i32 },
    #[error("{name}: the derivative of order {order} is {value:?}")]
    DerivativeNotFinite { name: &'static str, order: i32, value: f64 },
    #[error("{name} = {value:?} is not a usable time")]
    Time { name: &'static str, value: f64 },
    #[error("stopTime = {stop_s:?} is before startTime = {start_s:?}")]
    StopBeforeStart { start_s: f64, stop_s: f64 },
    #[error("communicationStepSize = {step_s:?} is not a positive number")]
    StepSize { step_s: f64 },
    #[error("currentCommunicationPoint = {given_s:?} is not where the last step ended, {expected_s:?}")]
    CommunicationPoint { given_s: f64, expected_s: f64 },
    #[error("the step ends at {end_s:?}, past stopTime = {stop_s:?}")]
    PastStop { end_s: f64, stop_s: f64 },
    #[error("no log category is named {name:?}")]
    UnknownCategory { name: String },
    /// An answer that this library never has, in the words of the interface.
    #[error("{0}")]
    NoAnswer(String),
    /// A function that this library does not offer, in the words of the interface.
    #[error("{0}")]
    NotOffered(&'static str),
    #[error(transparent)]
    SavedState(#[from] SavedStateError),
    /// In the words of the model.
    #[error("{0}")]
    Model(String),
    #[error("the {run} cannot go on: {message}")]
    Step { run: &'static str, message: String },
    #[error("internal fault, the instance is lost: {message}")]
    Panic { message: String },
}

impl CallError {
    /// Parameters or a state that the model refuses.
    pub fn of_model(error: impl Display) -> Self {
        Self::Model(error.to_string())
    }

    /// A run of `M` that cannot go on.
    pub fn of_step<M: Model>(error: M::Error) -> Self {
        Self::Step { run: M::IDENTITY.words.run, message: error.to_string() }
    }

    /// How bad it is.
    pub fn severity(&self) -> Severity {
        match self {
            Self::Panic { .. } | Self::IllegalPhase { phase: Phase::Fatal } => Severity::Fatal,
            Self::NoAnswer(_) => Severity::Discard,
            _ => Severity::Error,
        }
    }
}

/// What is wrong with the bytes of a serialized state.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum SavedStateError {
    #[error("these {size} bytes are not a saved state: they do not begin with its header")]
    NoHeader { size: usize },
    #[error("the saved state has format {found}, this library reads format {expected}")]
    Format { found: u32, expected: u32 },
    #[error("the saved state is of another model or another version of it")]
    OtherModel,
    #[error("the saved state has {actual} bytes, {expected} expected")]
    Length { actual: usize, expected: usize },
    #[error("the saved state is damaged: its checksum does not match")]
    Checksum,
    #[error("the saved state cannot be decoded")]
    Undecodable,
    #[error("the saved state contains a number that is not finite")]
    NotFinite,
    #[error("the saved state contradicts itself: {0}")]
    Contradiction(&'static str),
    #[error("the saved state contradicts itself: it has no {run}")]
    NoRun { run: &'static str },
    #[error("the saved state contradicts itself: the {run} is at another time")]
    OtherTime { run: &'static str },
}
