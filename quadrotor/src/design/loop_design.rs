//! Everything that a control loop computes before it flies.

use crate::configuration::validation::only_tunables_differ;
use crate::design::cascade_design::CascadeDesign;
use crate::design::rotor_loss_design::RotorLossDesign;
use crate::{Configuration, ConfigurationError};

/// A configuration and the controllers designed from it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LoopDesign {
    pub(crate) configuration: Configuration,
    pub(crate) cascade: CascadeDesign,
    pub(crate) rotor_loss: RotorLossDesign,
}

impl LoopDesign {
    /// Checks the configuration and designs its controllers.
    ///
    /// # Errors
    /// Those of [`CascadeDesign::new`].
    pub(crate) fn new(configuration: &Configuration) -> Result<Self, ConfigurationError> {
        Ok(Self {
            configuration: *configuration,
            cascade: CascadeDesign::new(configuration)?,
            rotor_loss: RotorLossDesign::new(configuration),
        })
    }

    /// Takes in changed tunable parameters.
    ///
    /// # Errors
    /// [`ConfigurationError::Fixed`] when another parameter differs, and those of [`CascadeDesign::new`]; nothing has
    /// changed then.
    pub(crate) fn reconfigure(&mut self, configuration: &Configuration) -> Result<(), ConfigurationError> {
        only_tunables_differ(&self.configuration, configuration)?;
        self.cascade.redesign(&self.configuration, configuration)?;
        self.configuration = *configuration;
        Ok(())
    }
}
