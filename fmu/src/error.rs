//! Why a call was not carried out.

use quadrotor::{ConfigurationError, SimulationError};
use thiserror::Error;

use crate::lifecycle::State;
use crate::types::{Status, StatusKind, ValueReference};
use crate::variables::{Type, Value};

/// Why a call was not carried out. Unless it says otherwise, nothing has changed then.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum CallError {
    #[error("must not be called in the state \"{state}\"")]
    IllegalState { state: State },
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
    #[error("output derivatives are not available (maxOutputDerivativeOrder = 0)")]
    NoOutputDerivatives,
    #[error("directional derivatives are not available (providesDirectionalDerivative = false)")]
    NoDirectionalDerivative,
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
    #[error("no status of kind {kind} is available")]
    NoStatus { kind: StatusKind },
    #[error(transparent)]
    SavedState(#[from] SavedStateError),
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    #[error("the flight cannot go on: {0}")]
    Simulation(#[from] SimulationError),
    #[error("internal fault, the instance is lost: {message}")]
    Panic { message: String },
}

impl CallError {
    /// What the function returns.
    pub fn status(&self) -> Status {
        match self {
            Self::Panic { .. } | Self::IllegalState { state: State::Fatal } => Status::Fatal,
            Self::NoStatus { .. } => Status::Discard,
            _ => Status::Error,
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
}
