//! A preset applied to a configuration.

use crate::configuration::parameters::PARAMETERS;
use crate::configuration::settings::Configuration;
use crate::plant::presets::AirframePreset;
use crate::{ConfigurationError, RotorLayout};

impl Configuration {
    /// The configuration with its preset applied: what flies.
    ///
    /// Every `airframe.*` parameter that has its start value gets the preset's, and so does the layout. Then every `limits.*` and
    /// `controller.*` parameter that has its start value gets the one of [`Configuration::for_airframe`] for the airframe that results.
    /// Whatever has another value keeps it. The result therefore does not depend on the order in which values were set. With the paper's
    /// preset nothing changes.
    ///
    /// ```
    /// use quadrotor::{AirframePreset, Configuration};
    ///
    /// let mut configuration = Configuration { preset: AirframePreset::Iris, ..Configuration::default() };
    /// configuration.airframe.mass_kg = 1.7;
    /// let resolved = configuration.resolved()?;
    /// assert_eq!(resolved.airframe.mass_kg, 1.7);
    /// assert_eq!(resolved.airframe.rotor_speed_max_rad_s, 1100.0);
    /// # Ok::<(), quadrotor::ConfigurationError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Configuration::for_airframe`].
    pub fn resolved(&self) -> Result<Self, ConfigurationError> {
        let airframe = self.with_airframe();
        if self.preset == AirframePreset::Paper {
            return Ok(airframe);
        }
        Ok(airframe.filled(&["limits.", "controller."], &Self::for_airframe(&airframe.airframe)?))
    }

    /// The values as they read: those that fly, under the preset's own name. While they cannot fly, only the airframe's are known.
    #[must_use]
    pub fn as_read(&self) -> Self {
        let resolved = self.resolved().unwrap_or_else(|_| self.with_airframe());
        Self { preset: self.preset, ..resolved }
    }

    /// The configuration with the preset's airframe alone, under the paper's name: what a plant flies with that is not ours to
    /// control. Limits and controllers stay as they are.
    #[must_use]
    pub fn with_airframe(&self) -> Self {
        let mut published = Self { airframe: self.preset.airframe(), ..Self::default() };
        if self.airframe.layout != RotorLayout::default() {
            published.airframe.layout = self.airframe.layout;
        }
        let mut filled = self.filled(&["airframe."], &published);
        filled.airframe.layout = published.airframe.layout;
        filled.preset = AirframePreset::Paper;
        filled
    }

    /// The same with the values of another one, under these names, wherever the start value stands.
    fn filled(&self, names: &[&str], from: &Self) -> Self {
        let (start, mut filled) = (Self::default(), *self);
        for parameter in PARAMETERS {
            let named = names.iter().any(|name| parameter.name.starts_with(name));
            if named && parameter.access.same(self, &start) {
                parameter.access.copy(from, &mut filled);
            }
        }
        filled
    }
}

#[cfg(test)]
mod tests {
    use crate::{AirframePreset, Configuration, ConfigurationError, Simulation};

    fn of(preset: AirframePreset) -> Configuration {
        Configuration { preset, ..Configuration::default() }
    }

    #[test]
    fn a_preset_alone_is_its_airframes_configuration() {
        for preset in AirframePreset::ALL {
            let resolved = of(preset).resolved().unwrap();
            assert_eq!(resolved, Configuration::for_airframe(&preset.airframe()).unwrap());
            assert_eq!(resolved.resolved(), Ok(resolved), "{preset:?}");
            assert_eq!(of(preset).as_read(), Configuration { preset, ..resolved });
        }
    }

    #[test]
    fn what_is_set_is_kept_and_limits_follow_the_airframe_that_results() {
        let mut configuration = of(AirframePreset::Hummingbird);
        configuration.airframe.mass_kg = 1.4;
        configuration.limits.speed_up_m_s = 1.0;
        configuration.controllers.position.scale = 0.5;
        configuration.initial.position_m[2] = -3.0;
        let resolved = configuration.resolved().unwrap();
        let heavier = crate::Airframe { mass_kg: 1.4, ..AirframePreset::Hummingbird.airframe() };
        let expected = Configuration::for_airframe(&heavier).unwrap();
        assert_eq!(resolved.airframe, heavier);
        assert_eq!(resolved.limits, crate::Limits { speed_up_m_s: 1.0, ..expected.limits });
        assert!(resolved.limits.thrust_max < 2.0);
        assert_eq!(resolved.controllers.position.scale, 0.5);
        assert_eq!(resolved.controllers.attitude, expected.controllers.attitude);
        assert_eq!(resolved.initial, configuration.initial);
    }

    #[test]
    fn what_cannot_fly_is_refused_and_still_read() {
        let mut configuration = of(AirframePreset::Crazyflie);
        configuration.airframe.mass_kg = 1.0;
        assert!(matches!(configuration.resolved(), Err(ConfigurationError::TooHeavy { .. })));
        let read = configuration.as_read();
        assert_eq!((read.preset, read.airframe.mass_kg), (AirframePreset::Crazyflie, 1.0));
        assert_eq!(read.airframe.arm_length_m, 0.046);
    }

    /// Nobody flies one airframe and believes that it is another.
    #[test]
    fn a_preset_that_is_not_applied_does_not_fly() {
        let refused = Simulation::new(&of(AirframePreset::Iris), &crate::Inputs::default()).err();
        assert_eq!(refused, Some(ConfigurationError::Unresolved { name: "iris" }));
    }
}
