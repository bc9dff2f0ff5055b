#![doc = include_str!("../README.md")]
//!
//! # What becomes of a model
//!
#![doc = include_str!("parts.svg")]
//!
//! # Map
//!
//! Calls arrive in [`fmi2`] or [`fmi3`], where `guard` checks the instance and whether the call is allowed; the other modules are
//! independent of C and, but for `layout`, which knows the arrays of FMI 3.0, of the version of the interface. `component` is an instance
//! of any model of the `library`; `instance` and `values` implement that of one [`Model`] with its table of [`variables`]; `continuous` is
//! a model's equations, which `exchange` gives to importers' solvers and `derivatives` differentiates; `choice_number` reads enumerations
//! as integers; `clock` is its time, `snapshot` its state, `serialized` that state as bytes, `identity` the GUID. `guard` catches panics,
//! `logger` filters messages, `pointer` checks what C passes.
//!
//! There is no mutable global state: instances are independent and can run on any number of threads.

mod choice_number;
mod clock;
mod component;
mod continuous;
mod derivatives;
#[cfg(feature = "description")]
pub mod description;
mod error;
mod exchange;
mod finite;
mod finite_values;
mod floating_point;
pub mod fmi2;
pub mod fmi3;
mod guard;
mod identity;
mod input_derivative;
mod instance;
#[cfg(test)]
#[path = "../../tests/lag/src/model.rs"]
mod lag;
mod layout;
mod library;
mod lifecycle;
mod logger;
mod model;
mod pointer;
mod serialized;
mod snapshot;
mod stack;
mod values;
pub mod variables;

pub use continuous::{Continuous, Seed};
pub use identity::guid;
pub use library::LibraryModel;
pub use model::{Data, Experiment, Identity, Model, SavedStateFormat, Words};

// The model of the tests names this crate as others do.
#[cfg(test)]
extern crate self as fmi;
