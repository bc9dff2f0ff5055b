//! What the engine refuses.

use quadrotor::{ConfigurationError, SimulationError};
use thiserror::Error;

/// What the engine refuses, in its own words.
#[derive(Debug, Error)]
pub enum FlightError {
    /// A configuration or a saved state.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// To fly on.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}
