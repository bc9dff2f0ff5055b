//! What the parameters are parameters of, as plain data.

use quadrotor::{Configuration, ConfigurationError, PreparedDesign};

use super::{Speed, Statistics};
use crate::designs::design;
use crate::vehicle::Conduct;

/// Everything that parameters are read from and written into. A running vehicle fills it from its state, and takes a changed
/// one over with [`Vehicle::adopt`](crate::Vehicle::adopt); before a flight it is all that there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterValues {
    /// The closed loop.
    pub configuration: Configuration,
    /// The vehicle's behaviour.
    pub conduct: Conduct,
    /// System id.
    pub system_id: u8,
    /// Pace of simulation time.
    pub speed: Speed,
    /// What it has counted.
    pub statistics: Statistics,
}

impl ParameterValues {
    /// The closed loop with these values, if it can be built. A [`Vehicle`](crate::Vehicle) that this thread makes with them next has the
    /// same one.
    ///
    /// # Errors
    /// [`ConfigurationError`] when values contradict one another, a controller cannot be designed, or the vehicle would be
    /// lost.
    pub fn check(&self) -> Result<PreparedDesign, ConfigurationError> {
        design(&self.configuration)
    }
}
