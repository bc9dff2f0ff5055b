//! An FMU in a record: it moves as it did.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use vehicle::FlightError;
use vehicle::foreign::{Demand, ForeignDescription, ForeignModel, ForeignMotion};

/// Motions that have been read and not been flown.
#[derive(Clone, Debug, Default)]
pub struct Motions(Arc<Mutex<VecDeque<Vec<f64>>>>);

impl Motions {
    /// The motion of the tick after those that wait.
    pub fn push(&self, values: Vec<f64>) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push_back(values);
    }

    fn pop(&self) -> Option<Vec<f64>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).pop_front()
    }
}

/// The model of a recorded flight.
#[derive(Debug)]
pub struct RecordedModel {
    description: ForeignDescription,
    motions: Motions,
}

impl RecordedModel {
    /// A model that moves by what is pushed.
    pub fn new(description: &ForeignDescription, motions: &Motions) -> Self {
        Self { description: description.clone(), motions: motions.clone() }
    }
}

impl ForeignModel for RecordedModel {
    fn description(&self) -> &ForeignDescription {
        &self.description
    }

    fn advance(&mut self, demand: &Demand) -> Result<ForeignMotion, FlightError> {
        let name = &self.description.name;
        let ended = |reason: String| FlightError::Foreign { time_us: demand.time_us, reason };
        let values =
            self.motions.pop().ok_or_else(|| ended(format!("{name} failed, as in the recorded flight")))?;
        let motion = self.description.start.with_values(&values);
        motion.ok_or_else(|| ended(format!("the recorded motion of {name} has {} values", values.len())))
    }
}
