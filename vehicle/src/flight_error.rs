//! Why a flight cannot go on.

use quadrotor::{ConfigurationError, SimulationError};

/// Why a flight cannot go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlightError {
    /// Our simulation.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// It cannot begin: the closed loop cannot be built.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// A model from elsewhere: a sentence that names it.
    #[error("{reason} ({} s of simulation time)", *time_us as f64 / 1e6)]
    Foreign {
        /// When, µs.
        time_us: u64,
        /// What happened.
        reason: String,
    },
}
