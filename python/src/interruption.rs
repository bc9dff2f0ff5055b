//! Ctrl-C while flights go on without Python's lock.

use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// How often it is looked whether the user has interrupted.
const PATIENCE: Duration = Duration::from_millis(50);

/// Looks now and then whether the user has interrupted.
pub struct Interruption(Instant);

impl Interruption {
    pub fn new() -> Self {
        Self(Instant::now())
    }

    /// `KeyboardInterrupt` if the user has interrupted.
    pub fn check(&mut self) -> PyResult<()> {
        if self.0.elapsed() < PATIENCE {
            return Ok(());
        }
        self.0 = Instant::now();
        Python::attach(|python| python.check_signals())
    }
}
