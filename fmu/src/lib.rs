//! The closed-loop quadrotor as an FMI 2.0 co-simulation library.
//!
//! A call comes in through [`abi`], one line per exported function; `guard` checks the instance and the
//! state, and catches panics; `instance` is the safe implementation over [`quadrotor::Simulation`].
//! [`variables`] is the one table of names, value references, units, ranges and start values that the
//! library and its description (feature `description`) are made from.
//!
//! There is no mutable global: instances are independent, on as many threads as the importer likes.

pub mod abi;
mod clock;
#[cfg(feature = "description")]
pub mod description;
mod error;
mod finite;
mod guard;
mod guid;
mod input_derivative;
mod instance;
mod instantiate;
mod lifecycle;
mod logger;
mod pointer;
mod serialized;
mod snapshot;
pub mod types;
mod values;
pub mod variables;

pub use guid::guid;

/// Name of the model.
pub const MODEL_NAME: &str = "LmpcQuadrotor";
/// Name that the library's file must have, without its extension.
pub const MODEL_IDENTIFIER: &str = "LmpcQuadrotor";
