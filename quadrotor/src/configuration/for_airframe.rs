//! The configuration that flies an airframe.

use nalgebra::SVector;

use crate::configuration::settings::{Configuration, Controllers};
use crate::configuration::validation::validate_airframe;
use crate::design::default_bandwidths::{Bandwidths, default_bandwidths};
use crate::design::default_limits::default_limits;
use crate::plant::airframe::Airframe;
use crate::{ConfigurationError, ControllerSettings};

impl Configuration {
    /// The default configuration of an airframe: limits that it can fly within and weights for the bandwidths that it can have
    /// ([`default_bandwidths`]). For the paper's airframe it is [`Configuration::default`].
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
        Ok(Self {
            controllers: default_controllers(airframe)?,
            limits: default_limits(airframe)?,
            ..configuration
        })
    }
}

/// The default controllers with the weights, Laguerre poles and horizons that close the loops of an airframe as those of the paper's
/// are closed, at its own bandwidths. In units of its own time, 1/ω, each loop is the same:
///
/// ```text
/// R = (1/(J ΔT ω³))², (g/(ΔT ω³))², (1/(ΔT ω³))²   attitude, position, altitude
/// Q on increments of rates ~ 1/ω⁴,   a ~ e^−ω,   N_p ~ 1/ω
/// ```
fn default_controllers(airframe: &Airframe) -> Result<Controllers, ConfigurationError> {
    let known = Controllers::default();
    let paper = Airframe::default();
    let Bandwidths { tilt_rad_s, yaw_rad_s, position_rad_s, altitude_rad_s } = default_bandwidths(&paper)?;
    let wanted = default_bandwidths(airframe)?;
    let tilt = wanted.tilt_rad_s / tilt_rad_s;
    let yaw = wanted.yaw_rad_s / yaw_rad_s;
    let inertia: [f64; 3] =
        core::array::from_fn(|axis| airframe.inertia_kg_m2[axis] / paper.inertia_kg_m2[axis]);
    let position = wanted.position_rad_s / position_rad_s;
    Ok(Controllers {
        attitude: faster(&known.attitude, [tilt, tilt, yaw], inertia),
        position: faster(&known.position, [position; 2], [1.0; 2]),
        altitude: faster(&known.altitude, [wanted.altitude_rad_s / altitude_rad_s], [1.0]),
        ..known
    })
}

/// Settings of a loop whose bandwidths are so many times as large and whose inertias are so many times as large, per input.
fn faster<const P: usize>(
    known: &ControllerSettings<P>,
    times: [f64; P],
    inertia: [f64; P],
) -> ControllerSettings<P> {
    let [first, ..] = times.as_slice() else { return *known };
    let increment = |input: usize| {
        let [times, inertia] = [times[input], inertia[input]];
        let relative = inertia * times * times * times;
        known.increment_weight[input] / (relative * relative)
    };
    let rate = |output: usize| {
        let squared = times[output] * times[output];
        known.rate_weight[output] / (squared * squared)
    };
    ControllerSettings {
        scale: libm::pow(known.scale, *first),
        prediction_horizon: libm::round(f64::from(known.prediction_horizon) / first).clamp(1.0, 1000.0)
            as u32,
        increment_weight: SVector::from_fn(|input, _| increment(input)),
        rate_weight: SVector::from_fn(|output, _| rate(output)),
        ..*known
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
