//! The control laws for the loss of each rotor.

use crate::control::rotor_loss::RotorLossLaw;
use crate::{Configuration, ConfigurationError, ControlError, ValueRange};

/// The control laws for the loss of each rotor, as far as the airframe has them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RotorLossDesign {
    laws: [Result<RotorLossLaw, ConfigurationError>; 4],
}

impl RotorLossDesign {
    pub(crate) fn new(configuration: &Configuration) -> Self {
        Self { laws: core::array::from_fn(|lost| RotorLossLaw::new(configuration, lost)) }
    }

    /// Whether two configurations have the same laws.
    pub(crate) fn is_same(one: &Configuration, other: &Configuration) -> bool {
        one.airframe == other.airframe
            && one.controllers.attitude.sample_time_us == other.controllers.attitude.sample_time_us
    }

    /// The law for the loss of a rotor.
    pub(crate) fn of(&self, lost: usize) -> Result<&RotorLossLaw, ControlError> {
        let law = self.laws.get(lost).ok_or(ControlError::NoSuchRotor { rotor: lost })?;
        law.as_ref().map_err(|_| ControlError::NoRotorLossLaw { rotor: lost })
    }

    /// Why there is no law for the loss of a rotor, if there is none.
    pub(crate) fn check(&self, lost: usize) -> Result<(), ConfigurationError> {
        let range = ValueRange { minimum: 0.0, maximum: 3.0, unit: "" };
        let no_such_rotor = ConfigurationError::OutOfRange { name: "lost_rotor", value: lost as f64, range };
        match self.laws.get(lost) {
            None => Err(no_such_rotor),
            Some(Ok(_)) => Ok(()),
            Some(Err(error)) => Err(error.clone()),
        }
    }
}
