#![doc = include_str!("../README.md")]
//!
//! # Map
//!
//! A call comes in through [`fmi2`], where `guard` checks the instance and what is legal now; the rest knows neither C
//! nor the version of the interface. `instance` and `values` are what an instance does, over a [`Model`] and its table
//! of [`variables`]; `clock` is its time, `snapshot` its state, `serialized` that state as bytes, `identity` the GUID.
//! `guard` catches panics, `logger` filters messages, `pointer` checks what C passes.
//!
//! There is no mutable global: instances are independent, on as many threads as the importer likes.

mod clock;
#[cfg(feature = "description")]
pub mod description;
mod error;
mod finite;
pub mod fmi2;
mod guard;
mod identity;
mod input_derivative;
mod instance;
#[cfg(test)]
#[path = "../../tests/lag/src/model.rs"]
mod lag;
mod lifecycle;
mod logger;
mod model;
mod pointer;
mod serialized;
mod snapshot;
mod values;
pub mod variables;

pub use identity::guid;
pub use model::{Data, Experiment, Identity, Model, SavedStateFormat, Words};

// The model of the tests names this crate as others do.
#[cfg(test)]
extern crate self as fmi;
