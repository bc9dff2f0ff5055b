//! The configuration that flies an airframe.

use crate::ConfigurationError;
use crate::configuration::settings::Configuration;
use crate::configuration::validation::validate_airframe;
use crate::design::default_limits::default_limits;
use crate::plant::airframe::Airframe;

impl Configuration {
    /// The default configuration of an airframe: limits that it can fly within. Weights are multiples of those that the airframe calls for
    /// and need no change. For the paper's airframe it is [`Configuration::default`].
    ///
    /// ```
    /// use quadrotor::{AirframePreset, Configuration, Inputs, PositionReference, Simulation};
    ///
    /// # if !cfg!(feature = "shaper") { return Ok(()); }
    /// let configuration = Configuration::for_airframe(&AirframePreset::Hummingbird.airframe())?;
    /// let goal = PositionReference::goal([1.0, 0.0, -1.0], 0.0);
    /// let inputs = Inputs { reference: goal, ..Inputs::default() };
    /// let mut flight = Simulation::new(&configuration, &inputs)?;
    /// flight.advance_to(15_000_000, &inputs)?;
    /// assert!((flight.outputs().position_m - goal.position_m).norm() < 0.01);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ConfigurationError`] when the airframe cannot fly: [`TooHeavy`](ConfigurationError::TooHeavy),
    /// [`TooLight`](ConfigurationError::TooLight), [`Layout`](ConfigurationError::Layout) and values out of their ranges.
    pub fn for_airframe(airframe: &Airframe) -> Result<Self, ConfigurationError> {
        let configuration = Self { airframe: *airframe, ..Self::default() };
        validate_airframe(&configuration)?;
        Ok(Self { limits: default_limits(airframe)?, ..configuration })
    }
}

#[cfg(test)]
mod tests {
    use crate::{Airframe, AirframePreset, Configuration, ConfigurationError};

    #[test]
    fn that_of_the_papers_airframe_is_the_default_bit_for_bit() {
        assert_eq!(Configuration::for_airframe(&Airframe::default()), Ok(Configuration::default()));
    }

    #[test]
    fn what_cannot_fly_is_refused_with_the_reason() {
        let crazyflie = AirframePreset::Crazyflie.airframe();
        let heavy = Airframe { mass_kg: 0.1, ..crazyflie };
        let refused = Configuration::for_airframe(&heavy);
        assert!(matches!(refused, Err(ConfigurationError::TooHeavy { .. })), "{refused:?}");
        let light = Airframe { rotor_speed_min_rad_s: 1700.0, ..crazyflie };
        let refused = Configuration::for_airframe(&light);
        assert!(matches!(refused, Err(ConfigurationError::TooLight { .. })), "{refused:?}");
        let broken = Airframe { inertia_kg_m2: [0.0; 3], ..crazyflie };
        let refused = Configuration::for_airframe(&broken);
        assert!(matches!(refused, Err(ConfigurationError::OutOfRange { .. })), "{refused:?}");
    }
}
