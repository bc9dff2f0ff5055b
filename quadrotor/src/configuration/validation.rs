//! Checks on a configuration: every range, then what must fit together.

use crate::design::controller_limits::{COMMANDED_TILT_SHARE, USABLE_THRUST_SHARE};
use crate::{
    Configuration, ConfigurationError, Controllers, GRAVITY_M_S2, Mixer, Mutability, PARAMETERS, Parameter,
};

/// Checks every parameter against its range and the values that depend on one another.
pub(crate) fn validate(configuration: &Configuration) -> Result<(), ConfigurationError> {
    PARAMETERS.iter().try_for_each(|parameter| parameter.check(configuration))?;
    if configuration.reference.shaping && !cfg!(feature = "shaper") {
        return Err(ConfigurationError::Unavailable { name: "reference.shaping" });
    }

    let airframe = &configuration.airframe;
    let limits = &configuration.limits;
    let (weakest, strongest) = airframe.thrust_range_n();
    below(
        ("airframe.rotor.speed_min", airframe.rotor_speed_min_rad_s),
        ("airframe.rotor.speed_max", airframe.rotor_speed_max_rad_s),
    )?;
    let carried_kg = USABLE_THRUST_SHARE * strongest / GRAVITY_M_S2;
    below(
        ("airframe.mass", airframe.mass_kg),
        ("the mass in kg that four fifths of the rotors' thrust carry", carried_kg),
    )?;
    below(
        ("the mass in kg that four idle rotors carry", weakest / GRAVITY_M_S2),
        ("airframe.mass", airframe.mass_kg),
    )?;
    below(
        ("limits.acceleration.horizontal", limits.acceleration_horizontal_m_s2),
        (
            "the acceleration at the commanded tilt",
            GRAVITY_M_S2 * libm::tan(COMMANDED_TILT_SHARE * limits.tilt_rad),
        ),
    )?;
    // The roll and pitch torques in hover must be able to follow the tilt commands, at half their pace at least.
    let [jx, jy, _] = airframe.inertia_kg_m2;
    let [roll_n_m, pitch_n_m, _] = Mixer::new(airframe)?.largest_torques_n_m(airframe.weight_n() / 4.0);
    let strongest_n_m = roll_n_m.min(pitch_n_m);
    let followed = 2.0 * strongest_n_m / jx.max(jy);
    if limits.tilt_acceleration_rad_s2 > followed {
        return Err(ConfigurationError::Inconsistent {
            name: "limits.tilt_acceleration",
            value: limits.tilt_acceleration_rad_s2,
            relation: "at most",
            other: "twice the angular acceleration that the rotors give airframe.inertia in hover",
            other_value: followed,
        });
    }
    validate_sample_times(&configuration.controllers)
}

/// The attitude controller is the inner one: it is the fastest.
fn validate_sample_times(controllers: &Controllers) -> Result<(), ConfigurationError> {
    for (name, outer) in [
        ("controller.position.sample_time", controllers.position.sample_time_s()),
        ("controller.altitude.sample_time", controllers.altitude.sample_time_s()),
    ] {
        let inner = controllers.attitude.sample_time_s();
        if outer < inner {
            return Err(ConfigurationError::Inconsistent {
                name,
                value: outer,
                relation: "at least",
                other: "controller.attitude.sample_time",
                other_value: inner,
            });
        }
    }
    Ok(())
}

/// What describes the start of a flight must not differ between two configurations of it.
pub(crate) fn same_start(old: &Configuration, new: &Configuration) -> Result<(), ConfigurationError> {
    if old.airframe.layout != new.airframe.layout {
        return Err(ConfigurationError::Fixed { name: "airframe.layout" });
    }
    for Parameter { name, mutability, access, .. } in PARAMETERS {
        if *mutability == Mutability::Start && !access.same(old, new) {
            return Err(ConfigurationError::Fixed { name });
        }
    }
    Ok(())
}

fn below(
    (name, value): (&'static str, f64),
    (other, other_value): (&'static str, f64),
) -> Result<(), ConfigurationError> {
    if value < other_value {
        Ok(())
    } else {
        Err(ConfigurationError::Inconsistent { name, value, relation: "below", other, other_value })
    }
}
