//! Whether a vehicle can be flown with a configuration.

use core::f64::consts::LN_2;

use crate::design::stability::cause::Cause;
use crate::design::stability::loop_stability::LoopStability;
use crate::design::stability::noise_effect::NoiseEffect;
use crate::design::stability::stability_report::StabilityReport;
use crate::{CascadeDesign, Configuration, ConfigurationError};

/// So many standard deviations of the tilt must stay within limits.tilt: of a normal distribution all but 0.3 %. With fewer
/// the commands are cut so often that the loop is no longer closed, and the spread no longer that of a linear loop. It is a
/// bound on what can be predicted: of 196 random flights beyond it 4 were lost within 6 s, of 112 with three to six
/// deviations 3, and of 592 with more one, which was warned about for another reason.
const TILT_DEVIATIONS: f64 = 3.0;
/// Torque commands may spread over so many times what the rotors can make. A limiter passes on √(2/π)/4 = 0.2 of a small
/// command under normal noise of four times the limit: a fifth of the loop's gain is left. Of 27 random flights beyond it with
/// enough room for the tilt none was lost within 6 s, of 147 with one to four times 3, all warned about.
const MOST_TORQUE_SHARE: f64 = 4.0;

/// The report of a configuration with which the vehicle can be flown. `flown` is the configuration that flew before, if
/// there is one.
///
/// # Errors
/// [`ConfigurationError::Unstable`], [`ConfigurationError::Noise`], [`ConfigurationError::Design`].
pub(crate) fn judged(
    configuration: &Configuration,
    design: &CascadeDesign,
    flown: Option<&Configuration>,
) -> Result<StabilityReport, ConfigurationError> {
    let controllers = &configuration.controllers;
    if controllers.learning && controllers.mass_factor != 1.0 {
        // What flies is what will have been learned.
        let learned = configuration.with_mass_factor(1.0);
        return judged(&learned, &CascadeDesign::new(&learned)?, flown);
    }
    let report = report(configuration, design)?;
    if let Some(each) = report.unstable() {
        return Err(unstable(each, configuration, flown));
    }
    let (tilt_rad, limit_rad) = (report.tilt_spread_rad(), configuration.limits.tilt_rad);
    let share = report.torque_share(configuration, design);
    let effect = if TILT_DEVIATIONS * tilt_rad > limit_rad {
        NoiseEffect::Tilt { tilt_rad, limit_rad }
    } else if share > MOST_TORQUE_SHARE {
        NoiseEffect::Torque { share }
    } else {
        return Ok(report);
    };
    let (name, value) = effect.loudest_source(configuration, design)?;
    Err(ConfigurationError::Noise { name, value, effect })
}

fn unstable(
    each: &LoopStability,
    configuration: &Configuration,
    flown: Option<&Configuration>,
) -> ConfigurationError {
    // Another airframe differs in so many values from the default that what it flies with by default comes nearer.
    let (own, default) =
        (Configuration::for_airframe(&configuration.airframe).ok(), Configuration::default());
    ConfigurationError::Unstable {
        name: each.name,
        doubling_s: LN_2 / -each.decay_rate_1_s,
        cause: Cause::of(configuration, flown.into_iter().chain([&default]).chain(&own)),
    }
}

/// The report of a configuration, whatever it says.
///
/// # Errors
/// [`ConfigurationError::Design`].
pub(crate) fn report(
    configuration: &Configuration,
    design: &CascadeDesign,
) -> Result<StabilityReport, ConfigurationError> {
    StabilityReport::of(configuration, design)
        .map_err(|source| ConfigurationError::Design { part: "closed loop", source })
}
