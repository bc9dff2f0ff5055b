//! A vehicle as bytes.

use pyo3::prelude::*;
use quadrotor::{Configuration, PlantSimulationState, SimulationState};
use serde::{Deserialize, Serialize};

use super::actuation::Actuation;
use super::commands::Commands;
use crate::errors::ArgumentError;

/// How saved vehicles begin; the last byte is raised whenever their layout changes.
const MAGIC: [u8; 8] = *b"LMPCPY\0\x02";

/// Everything there is to save of a vehicle.
#[derive(Clone, Serialize, Deserialize)]
pub struct Saved {
    pub actuation: Actuation,
    pub configuration: Configuration,
    pub commands: Commands,
    pub engine: EngineState,
}

/// The state of what flies.
#[derive(Clone, Serialize, Deserialize)]
pub enum EngineState {
    /// Plant and controllers.
    Loop(Box<SimulationState>),
    /// The plant alone.
    Plant(Box<PlantSimulationState>),
}

impl Saved {
    /// As bytes.
    pub fn bytes(&self) -> PyResult<Vec<u8>> {
        let body = postcard::to_allocvec(self)
            .map_err(|error| ArgumentError::new_err(format!("cannot save the flight: {error}")))?;
        Ok([MAGIC.as_slice(), &body].concat())
    }

    /// From bytes.
    pub fn from_bytes(bytes: &[u8]) -> PyResult<Self> {
        let body = bytes
            .strip_prefix(&MAGIC)
            .ok_or_else(|| ArgumentError::new_err("saved is no flight that this version has saved"))?;
        match postcard::take_from_bytes(body) {
            Ok((saved, [])) => Ok(saved),
            Ok(_) => Err(ArgumentError::new_err("saved is damaged: it is longer than a saved flight")),
            Err(error) => Err(ArgumentError::new_err(format!("saved is damaged: {error}"))),
        }
    }
}
