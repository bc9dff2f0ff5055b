//! What is being done, with the time since the start.

use std::time::{Duration, Instant};

/// Prints the steps of a task as they begin.
pub struct Progress {
    start: Instant,
}

impl Progress {
    /// Starts the clock.
    pub fn start() -> Self {
        Self { start: Instant::now() }
    }

    /// A step begins.
    pub fn step(&self, text: &str) {
        eprintln!("[{:6.1} s] {text}", self.elapsed().as_secs_f64());
    }

    /// Time since the start.
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }
}
