//! A finished design that control loops share.

use alloc::sync::Arc;

use crate::design::loop_design::LoopDesign;
use crate::{Configuration, ConfigurationError, StabilityReport};

/// Controllers for a configuration, ready to fly: made once, shared by any number of flights, and never changed by them.
///
/// [`ControlLoop::prepared`](crate::ControlLoop::prepared) and [`Simulation::prepared`](crate::Simulation::prepared) begin a flight with it,
/// [`ControlLoop::hand_over`](crate::ControlLoop::hand_over) goes on with it in flight. A clone is the same design.
#[derive(Clone, Debug, PartialEq)]
pub struct PreparedDesign {
    pub(crate) design: Arc<LoopDesign>,
}

impl PreparedDesign {
    /// Checks a configuration, designs its controllers and judges the closed loop.
    ///
    /// # Errors
    /// [`ConfigurationError`] when a value is out of range, values contradict one another, a controller cannot be designed,
    /// or the closed loop is unstable or shaken by noise.
    pub fn new(configuration: &Configuration) -> Result<Self, ConfigurationError> {
        Ok(Self { design: Arc::new(LoopDesign::new(configuration)?) })
    }

    /// The design of another configuration: that of [`PreparedDesign::new`], with what does not depend on the difference taken over from
    /// this one instead of being designed again. Where a flight starts, for example, changes no controller. Zeros of either sign count
    /// as the same.
    ///
    /// # Errors
    /// Those of [`PreparedDesign::new`].
    pub fn adapted(&self, configuration: &Configuration) -> Result<Self, ConfigurationError> {
        Ok(Self { design: Arc::new(self.design.adapted(configuration, None)?) })
    }

    /// How the closed loop behaves about hover.
    pub fn stability(&self) -> &StabilityReport {
        &self.design.stability
    }

    /// What it was designed for.
    pub fn configuration(&self) -> &Configuration {
        &self.design.configuration
    }
}
