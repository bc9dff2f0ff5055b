//! What can be wrong with a configuration.

use lmpc::DesignError;
use thiserror::Error;

use alloc::format;
use alloc::string::{String, ToString};

use super::remedy;
use crate::{Cause, NoiseEffect, Quantity, ValueRange};

/// A mass to 10 g, or to two digits if it is less than 100 g.
fn rounded(mass_kg: f64, to: fn(f64) -> f64) -> f64 {
    let digits = 2.0 - (libm::floor(libm::log10(mass_kg)) + 1.0).min(0.0);
    let scale = libm::pow(10.0, digits);
    to(mass_kg * scale) / scale
}

/// A time, s, to hundredths of its unit.
fn shown(time_s: f64) -> String {
    if time_s < 0.1 { format!("{:.2} ms", 1e3 * time_s) } else { format!("{time_s:.2} s") }
}

/// Where the ground is, unless it is at the height of the origin.
fn height_of(ground_z_m: f64) -> String {
    if ground_z_m == 0.0 { String::new() } else { format!(" at ground.z = {ground_z_m} m") }
}

/// Why a configuration was refused. Nothing has changed then.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ConfigurationError {
    /// A value is outside its range.
    #[error("{name} = {}; allowed {range}", range.quantity(*value))]
    OutOfRange {
        /// Public name of the parameter.
        name: &'static str,
        /// Given value.
        value: f64,
        /// Allowed values.
        range: ValueRange,
    },
    /// The rotors cannot carry the vehicle with thrust to spare for control.
    #[error(
        "airframe.mass = {mass_kg} kg is too heavy; allowed up to {} kg, which these rotors carry; lower it, or raise \
         airframe.rotor.speed_max",
        rounded(*carried_kg, libm::floor)
    )]
    TooHeavy {
        /// airframe.mass.
        mass_kg: f64,
        /// Mass that four fifths of the rotors' thrust carry.
        carried_kg: f64,
    },
    /// The idle rotors already lift the vehicle: it could not descend.
    #[error(
        "airframe.mass = {mass_kg} kg is too light; allowed from {} kg, which these rotors carry when idle; raise it, or lower \
         airframe.rotor.speed_min",
        rounded(*idle_kg, libm::ceil)
    )]
    TooLight {
        /// airframe.mass.
        mass_kg: f64,
        /// Mass that the rotors carry at their lowest speed.
        idle_kg: f64,
    },
    /// Two values do not fit together.
    #[error("{name} = {value} must be {relation} {limit}: {reason}")]
    Inconsistent {
        /// Public name of the parameter.
        name: &'static str,
        /// Its value.
        value: Quantity,
        /// "below", "at most", …
        relation: &'static str,
        /// What it is compared with.
        limit: Quantity,
        /// Where the limit comes from.
        reason: &'static str,
    },
    /// No rigid body has this inertia tensor.
    #[error(
        "airframe.inertia is no rigid body's: its principal moments {smallest:.3e}, {middle:.3e} and {largest:.3e} kg·m² must be \
         positive, and each at most the sum of the other two; reduce airframe.inertia.xy, .xz and .yz"
    )]
    Inertia {
        /// The smallest principal moment, kg·m².
        smallest: f64,
        /// The middle one, kg·m².
        middle: f64,
        /// The largest one, kg·m².
        largest: f64,
    },
    /// A controller or the Kalman predictor cannot be designed.
    #[error("cannot design the {part}: {source}{}", remedy::of_design(part, source))]
    Design {
        /// What, for a person: "altitude controller", "Kalman predictor", …
        part: &'static str,
        /// Why not.
        source: DesignError,
    },
    /// The closed loop is not stable, with the rotors' lag and the sampling that the controllers' models do not have.
    #[error(
        "the {name} loop is unstable: errors double every {}; {}",
        shown(*doubling_s),
        cause.as_ref().map_or_else(|| remedy::of_instability(name), Cause::to_string)
    )]
    Unstable {
        /// "roll", "pitch", "yaw", "north", "east" or "altitude".
        name: &'static str,
        /// Time in which an error doubles, s.
        doubling_s: f64,
        /// The value that is most likely to blame, if one alone is.
        cause: Option<Cause>,
    },
    /// Measurement noise with which the vehicle cannot be controlled.
    #[error("{name} = {value} is too much noise: {effect}; lower it")]
    Noise {
        /// Public name of the parameter with the greatest part in it.
        name: &'static str,
        /// Its value.
        value: Quantity,
        /// What it does.
        effect: NoiseEffect,
    },
    /// The rotors are not laid out as those of a quadrotor.
    #[error("airframe.layout cannot be flown: {reason}")]
    Layout {
        /// What is wrong with it.
        reason: &'static str,
    },
    /// The flight would start below the ground, which would throw the vehicle up.
    #[error(
        "initial.position.z = {z_m} m is below the ground{} (z points down); with environment.ground_plane = true and this \
         initial attitude, allowed up to {greatest_m:.3} m",
        height_of(*ground_z_m)
    )]
    BelowGround {
        /// Initial position down, m.
        z_m: f64,
        /// Greatest allowed value, at which the lowest foot touches the ground, m.
        greatest_m: f64,
        /// z of the ground below the start, NED, m.
        ground_z_m: f64,
    },
    /// A preset that has not been applied.
    #[error("airframe.preset = {name} is not applied; fly Configuration::resolved()")]
    Unresolved {
        /// Name of the preset.
        name: &'static str,
    },
    /// A function that this build was made without.
    #[error("{name} = true needs the cargo feature \"shaper\"")]
    Unavailable {
        /// Public name of the parameter.
        name: &'static str,
    },
    /// The measurement in which a control loop should take its vehicle over is not finite, or its quaternion is far from a
    /// unit one.
    #[error("the first measurement is not finite or has no valid attitude")]
    Measurement,
    /// A saved state that no flight with this configuration can have been in.
    #[error("the saved state does not belong to this flight: {reason}")]
    State {
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A parameter that describes the start of the flight would change.
    #[error("{name} is fixed for the whole flight: a change takes effect at the next start")]
    Fixed {
        /// Public name of the parameter.
        name: &'static str,
    },
}
