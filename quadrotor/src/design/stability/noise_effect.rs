//! What measurement noise does to a vehicle that cannot be flown with it.

use core::fmt::{Display, Formatter, Result as FormatResult};

use crate::design::stability::stability_report::StabilityReport;
use crate::design::stability::verdict::report;
use crate::{CascadeDesign, Configuration, ConfigurationError, Quantity, Sensors};

/// What measurement noise does to a vehicle that cannot be flown with it. Standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseEffect {
    /// It tilts the vehicle beyond its limit.
    Tilt {
        /// Tilt about one axis, rad.
        tilt_rad: f64,
        /// limits.tilt, rad.
        limit_rad: f64,
    },
    /// It asks for more torque than there is.
    Torque {
        /// Commanded torque as a multiple of the largest one in hover.
        share: f64,
    },
}

impl Display for NoiseEffect {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> FormatResult {
        match self {
            Self::Tilt { tilt_rad, limit_rad } => {
                write!(
                    formatter,
                    "the tilt would spread by {tilt_rad:.2} rad (1 sigma), more than a third of limits.tilt = {limit_rad} rad"
                )
            }
            Self::Torque { share } => {
                write!(
                    formatter,
                    "the torque commands would spread by {share:.1} times what the rotors can make"
                )
            }
        }
    }
}

impl NoiseEffect {
    /// Name and standard deviation of the noise that has the greatest part in it.
    ///
    /// # Errors
    /// [`ConfigurationError::Design`].
    pub(crate) fn loudest_source(
        &self,
        configuration: &Configuration,
        design: &CascadeDesign,
    ) -> Result<(&'static str, Quantity), ConfigurationError> {
        let all = configuration.sensors;
        let none = Sensors {
            position_noise_m: 0.0,
            velocity_noise_m_s: 0.0,
            attitude_noise_rad: 0.0,
            body_rate_noise_rad_s: 0.0,
            ..all
        };
        let mut loudest = (f64::NEG_INFINITY, "", Quantity { value: 0.0, unit: "" });
        for (name, value, unit, sensors) in [
            (
                "sensor.position_noise",
                all.position_noise_m,
                "m",
                Sensors { position_noise_m: all.position_noise_m, ..none },
            ),
            (
                "sensor.velocity_noise",
                all.velocity_noise_m_s,
                "m/s",
                Sensors { velocity_noise_m_s: all.velocity_noise_m_s, ..none },
            ),
            (
                "sensor.attitude_noise",
                all.attitude_noise_rad,
                "rad",
                Sensors { attitude_noise_rad: all.attitude_noise_rad, ..none },
            ),
            (
                "sensor.body_rate_noise",
                all.body_rate_noise_rad_s,
                "rad/s",
                Sensors { body_rate_noise_rad_s: all.body_rate_noise_rad_s, ..none },
            ),
        ] {
            let alone = Configuration { sensors, ..*configuration };
            let size = self.size(&report(&alone, design)?, &alone, design);
            if size > loudest.0 {
                loudest = (size, name, Quantity { value, unit });
            }
        }
        Ok((loudest.1, loudest.2))
    }

    fn size(&self, report: &StabilityReport, configuration: &Configuration, design: &CascadeDesign) -> f64 {
        match self {
            Self::Tilt { .. } => report.tilt_spread_rad(),
            Self::Torque { .. } => report.torque_share(configuration, design),
        }
    }
}
