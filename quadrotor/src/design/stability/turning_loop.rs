//! The attitude controller on one axis alone.

use lmpc::DesignError;
use nalgebra::SVector;

use crate::Configuration;
use crate::design::stability::motion::{Motion, rotation};
use crate::design::stability::small_signal::{Reading, SmallSignal};
use crate::design::stability::turning_axis::{Turning, TurningAxis};

/// The attitude controller on one axis alone, with its reference at rest.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TurningLoop {
    axis: TurningAxis,
    motion: Motion<4>,
    sample_time_s: f64,
}

impl TurningLoop {
    /// Of an axis whose torque leads by `lead_s`, s: see [`rotation`].
    ///
    /// # Errors
    /// [`DesignError::ElementNotFinite`].
    pub(crate) fn new(
        configuration: &Configuration,
        axis: TurningAxis,
        lead_s: f64,
    ) -> Result<Self, DesignError> {
        let sample_time_s = configuration.controllers.attitude.sample_time_s();
        Ok(Self {
            axis: axis.leading(lead_s),
            motion: rotation(configuration, lead_s, sample_time_s)?,
            sample_time_s,
        })
    }
}

impl SmallSignal<{ Turning::SIZE }> for TurningLoop {
    fn events(&self) -> usize {
        1
    }

    fn period_s(&self) -> f64 {
        self.sample_time_s
    }

    fn after(
        &self,
        state: &SVector<f64, { Turning::SIZE }>,
        _event: usize,
        noise: &Reading,
    ) -> SVector<f64, { Turning::SIZE }> {
        let mut turning = Turning::from_values(&(*state).into());
        self.axis.sample(&mut turning, [0.0; 2], [noise.angle, noise.rate]);
        let [angle, rate, acceleration, _] =
            self.motion.after([turning.angle, turning.rate, turning.acceleration, turning.command]);
        (turning.angle, turning.rate, turning.acceleration) = (angle, rate, acceleration);
        turning.values().into()
    }
}
