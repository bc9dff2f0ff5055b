//! Everything that a control loop computes before it flies.

use alloc::sync::Arc;

use crate::configuration::validation::same_start;
use crate::design::cascade_design::CascadeDesign;
use crate::design::rotor_loss_design::RotorLossDesign;
use crate::design::stability::stability_report::StabilityReport;
use crate::design::stability::verdict::judged;
use crate::{Configuration, ConfigurationError};

/// A configuration and the controllers designed from it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LoopDesign {
    pub(crate) configuration: Configuration,
    /// By far the largest part, which vehicles that differ in their start alone have in common.
    pub(crate) cascade: Arc<CascadeDesign>,
    pub(crate) rotor_loss: RotorLossDesign,
    pub(crate) stability: StabilityReport,
}

impl LoopDesign {
    /// Checks the configuration, designs its controllers and judges the closed loop.
    ///
    /// # Errors
    /// Those of [`StabilityReport::new`].
    pub(crate) fn new(configuration: &Configuration) -> Result<Self, ConfigurationError> {
        let cascade = CascadeDesign::new(configuration)?;
        let stability = judged(configuration, &cascade, None)?;
        let rotor_loss = RotorLossDesign::new(configuration);
        Ok(Self { configuration: *configuration, cascade: Arc::new(cascade), rotor_loss, stability })
    }

    /// The design for another configuration of the same flight. What does not depend on the change is taken over from this one.
    ///
    /// # Errors
    /// [`ConfigurationError::Fixed`] when a parameter of the start differs, and those of [`StabilityReport::new`].
    pub(crate) fn changed(&self, configuration: &Configuration) -> Result<Self, ConfigurationError> {
        same_start(&self.configuration, configuration)?;
        self.adapted(configuration, Some(&self.configuration))
    }

    /// The same for a configuration of another flight, or, with the one that flew, of this flight.
    ///
    /// # Errors
    /// Those of [`StabilityReport::new`].
    // One copy in the library, which is to stay small.
    #[inline(never)]
    pub(crate) fn adapted(
        &self,
        configuration: &Configuration,
        flown: Option<&Configuration>,
    ) -> Result<Self, ConfigurationError> {
        let cascade = CascadeDesign::adapted(&self.cascade, &self.configuration, configuration)?;
        let rotor_loss = if RotorLossDesign::is_same(&self.configuration, configuration) {
            self.rotor_loss.clone()
        } else {
            RotorLossDesign::new(configuration)
        };
        let stability = if StabilityReport::is_same(&self.configuration, configuration) {
            self.stability.clone()
        } else {
            judged(configuration, &cascade, flown)?
        };
        Ok(Self { configuration: *configuration, cascade, rotor_loss, stability })
    }
}
