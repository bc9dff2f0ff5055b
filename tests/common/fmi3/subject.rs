//! The models by their FMI 3.0 interface: the closed loop, a first-order lag, and an oscillator with vectors.

use fmi::Model;
use fmi::description::{model_description, model_description3};

use super::description::Description;
use super::library::Library;
use crate::common::description::Description as Description2;
use crate::common::subject::lag_model;

#[path = "../../lag/src/oscillator.rs"]
mod oscillator_model;

/// A model in a built library, with its description; and that of FMI 2.0, with which it must agree.
pub struct Subject {
    pub library: Library,
    pub description: Description,
    pub second: Description2,
}

impl Subject {
    fn of<M: Model>(library: &str) -> Self {
        Self {
            library: Library::load(library),
            description: Description::parse(model_description3::<M>()),
            second: Description2::parse(model_description::<M>()),
        }
    }

    /// The closed-loop quadrotor.
    pub fn closed_loop() -> Self {
        Self::of::<fmu::ClosedLoop>("fmu")
    }

    /// The first-order lag.
    pub fn lag() -> Self {
        Self::of::<lag_model::Lag>("lag")
    }

    /// The oscillator.
    pub fn oscillator() -> Self {
        Self::of::<oscillator_model::Oscillator>("lag")
    }
}
