//! Checks on a configuration: every range, then what must fit together.

use crate::design::controller_limits::{USABLE_THRUST_SHARE, commanded_tilt_rad};
use crate::plant::ground::greatest_start_z_m;
use crate::{
    Airframe, AirframePreset, Configuration, ConfigurationError, Controllers, GRAVITY_M_S2, Mixer,
    Mutability, PARAMETERS, Parameter, PlantState, Quantity, RigidBody,
};

/// Checks every parameter against its range and the values that depend on one another.
pub(crate) fn validate(configuration: &Configuration) -> Result<(), ConfigurationError> {
    PARAMETERS.iter().try_for_each(|parameter| parameter.check(configuration))?;
    if configuration.preset != AirframePreset::Paper {
        return Err(ConfigurationError::Unresolved { name: configuration.preset.name() });
    }
    if configuration.reference.shaping && !cfg!(feature = "shaper") {
        return Err(ConfigurationError::Unavailable { name: "reference.shaping" });
    }

    validate_rotors(&configuration.airframe)?;
    let airframe = &configuration.airframe;
    let limits = &configuration.limits;
    let leaning_m_s2 = GRAVITY_M_S2 * libm::tan(commanded_tilt_rad(configuration));
    if limits.acceleration_horizontal_m_s2 >= leaning_m_s2 {
        return Err(ConfigurationError::Inconsistent {
            name: "limits.acceleration.horizontal",
            value: Quantity { value: limits.acceleration_horizontal_m_s2, unit: "m/s²" },
            relation: "below",
            limit: rounded_down(leaning_m_s2, "m/s²"),
            reason: "the commanded tilt gives no more; raise limits.tilt",
        });
    }
    // The roll and pitch torques in hover must be able to follow the tilt commands, at half their pace at least.
    let [jx, jy, _] = airframe.inertia_kg_m2;
    let largest_n_m = Mixer::new(airframe)?.largest_torques_n_m(airframe.weight_n() / 4.0);
    let [roll_n_m, pitch_n_m, _] = largest_n_m;
    let strongest_n_m = roll_n_m.min(pitch_n_m);
    let followed = 2.0 * strongest_n_m / jx.max(jy);
    if limits.tilt_acceleration_rad_s2 > followed {
        return Err(ConfigurationError::Inconsistent {
            name: "limits.tilt_acceleration",
            value: Quantity { value: limits.tilt_acceleration_rad_s2, unit: "rad/s²" },
            relation: "at most",
            limit: rounded_down(followed, "rad/s²"),
            reason: "the rotors give airframe.inertia half of that in hover",
        });
    }
    validate_inertia(&airframe.inertia_kg_m2)?;
    validate_products_of_inertia(airframe)?;
    validate_rotor_inertia(airframe)?;
    validate_centre_of_gravity(airframe, largest_n_m)?;
    validate_battery(airframe)?;
    validate_spin(configuration, largest_n_m)?;
    validate_start(configuration)?;
    validate_sample_times(&configuration.controllers)
}

/// Checks what the airframe needs to fly at all: every value in its range, and rotors that carry it.
pub(crate) fn validate_airframe(configuration: &Configuration) -> Result<(), ConfigurationError> {
    let of_airframe = PARAMETERS.iter().filter(|parameter| parameter.name.starts_with("airframe."));
    of_airframe.into_iter().try_for_each(|parameter| parameter.check(configuration))?;
    validate_rotors(&configuration.airframe)?;
    Mixer::new(&configuration.airframe).map(|_| ())
}

/// Checks what a plant needs that nobody has to be able to control: airframe, environment and start in their ranges, a rigid
/// body's inertia, and a start above the ground.
pub(crate) fn validate_plant(configuration: &Configuration) -> Result<(), ConfigurationError> {
    let of_plant = |parameter: &&Parameter| {
        ["airframe.", "environment.", "initial."].iter().any(|group| parameter.name.starts_with(group))
    };
    PARAMETERS.iter().filter(of_plant).try_for_each(|parameter| parameter.check(configuration))?;
    if configuration.preset != AirframePreset::Paper {
        return Err(ConfigurationError::Unresolved { name: configuration.preset.name() });
    }
    validate_products_of_inertia(&configuration.airframe)?;
    validate_rotor_inertia(&configuration.airframe)?;
    validate_start(configuration)
}

/// The rotors must carry the vehicle, with thrust to spare, and let it sink.
fn validate_rotors(airframe: &Airframe) -> Result<(), ConfigurationError> {
    let (weakest, strongest) = airframe.thrust_range_n();
    let (slowest, fastest) = (airframe.rotor_speed_min_rad_s, airframe.rotor_speed_max_rad_s);
    if slowest >= fastest {
        return Err(ConfigurationError::Inconsistent {
            name: "airframe.rotor.speed_min",
            value: Quantity { value: slowest, unit: "rad/s" },
            relation: "below",
            limit: Quantity { value: fastest, unit: "rad/s" },
            reason: "that is airframe.rotor.speed_max",
        });
    }
    let mass_kg = airframe.mass_kg;
    let carried_kg = USABLE_THRUST_SHARE * strongest / GRAVITY_M_S2;
    if mass_kg >= carried_kg {
        return Err(ConfigurationError::TooHeavy { mass_kg, carried_kg });
    }
    let idle_kg = weakest / GRAVITY_M_S2;
    if mass_kg <= idle_kg {
        return Err(ConfigurationError::TooLight { mass_kg, idle_kg });
    }
    Ok(())
}

/// Two moments of inertia may differ by so many times the third one.
const MOST_GYROSCOPIC: f64 = 100.0;

/// A small moment of inertia beside two that differ makes each turn about the other axes throw the vehicle about: ω × Jω. Of
/// a rigid body the difference is at most the third moment. At a hundred times that, turns of 1 rad/s about two axes
/// accelerate the third one by 100 rad/s², of which the lagging rotors correct a change one time constant late. Measured on
/// random moments, sample times and weights: below 50 none of 542 flights is lost, from 50 to 200 one in 38, from 500 on half.
fn validate_inertia([x, y, z]: &[f64; 3]) -> Result<(), ConfigurationError> {
    for (name, value, difference) in [
        ("airframe.inertia.x", *x, libm::fabs(y - z)),
        ("airframe.inertia.y", *y, libm::fabs(x - z)),
        ("airframe.inertia.z", *z, libm::fabs(x - y)),
    ] {
        let least = difference / MOST_GYROSCOPIC;
        if value < least {
            return Err(ConfigurationError::Inconsistent {
                name,
                value: Quantity { value, unit: "kg·m²" },
                relation: "at least",
                limit: rounded_up(least, "kg·m²"),
                reason: "the other two moments of inertia differ by a hundred times that; change one of them first, \
                         or set this limit for now",
            });
        }
    }
    Ok(())
}

/// Products of inertia must leave a tensor that a rigid body can have. Moments alone are not refused: the stability report
/// warns of those that contradict one another.
fn validate_products_of_inertia(airframe: &Airframe) -> Result<(), ConfigurationError> {
    if airframe.has_principal_axes() || airframe.has_physical_inertia() {
        return Ok(());
    }
    let [smallest, middle, largest] = airframe.principal_moments_kg_m2();
    Err(ConfigurationError::Inertia { smallest, middle, largest })
}

/// The rotors turn with the body, too: its moment about the down axis contains theirs.
fn validate_rotor_inertia(airframe: &Airframe) -> Result<(), ConfigurationError> {
    let [_, _, z] = airframe.inertia_kg_m2;
    let value = airframe.rotor_spin.inertia_kg_m2;
    if value <= z / 4.0 {
        return Ok(());
    }
    Err(ConfigurationError::Inconsistent {
        name: "airframe.rotor.inertia",
        value: Quantity { value, unit: "kg·m²" },
        relation: "at most",
        limit: rounded_down(z / 4.0, "kg·m²"),
        reason: "airframe.inertia.z includes all four rotors",
    })
}

/// Share of the roll and pitch torques in hover that an offset centre of gravity may take; the rest is left for control.
const MOST_TRIM: f64 = 0.5;

/// The rotors must balance the weight about their centre, with torque to spare.
fn validate_centre_of_gravity(
    airframe: &Airframe,
    [roll_n_m, pitch_n_m, _]: [f64; 3],
) -> Result<(), ConfigurationError> {
    let [x_m, y_m, _] = airframe.centre_of_gravity_m;
    // A weight ahead of the rotors' centre pitches, one beside it rolls.
    let most_m = [pitch_n_m, roll_n_m].map(|torque_n_m| MOST_TRIM * torque_n_m / airframe.weight_n());
    let shares = [libm::fabs(x_m) / most_m[0], libm::fabs(y_m) / most_m[1]];
    if shares[0] + shares[1] <= 1.0 {
        return Ok(());
    }
    let axis = usize::from(shares[1] > shares[0]);
    let left = (1.0 - shares[1 - axis]).max(0.0);
    let limit = if left > 0.0 { rounded_down(left * most_m[axis], "m").value } else { 0.0 };
    Err(ConfigurationError::Inconsistent {
        name: ["airframe.centre_of_gravity.x", "airframe.centre_of_gravity.y"][axis],
        value: Quantity { value: [x_m, y_m][axis], unit: "m" },
        relation: "within ±",
        limit: Quantity { value: limit, unit: "m" },
        reason: "balancing more takes over half of the roll and pitch torque in hover",
    })
}

/// The full battery must turn the rotors fast enough to carry the weight with thrust to spare.
fn validate_battery(airframe: &Airframe) -> Result<(), ConfigurationError> {
    if !airframe.battery.sag {
        return Ok(());
    }
    let (_, strongest_n) = airframe.thrust_range_n();
    // Thrust goes with the square of the speed, and speed with the voltage.
    let least = libm::sqrt(airframe.weight_n() / (USABLE_THRUST_SHARE * strongest_n));
    let most_ohm = airframe.largest_resistance_ohm(least);
    if airframe.battery.resistance_ohm <= most_ohm {
        return Ok(());
    }
    Err(ConfigurationError::Inconsistent {
        name: "airframe.battery.resistance",
        value: Quantity { value: airframe.battery.resistance_ohm, unit: "Ohm" },
        relation: "at most",
        limit: rounded_down(most_ohm, "Ohm"),
        reason: "with more the voltage in hover is too low to carry the vehicle; raise airframe.battery.voltage",
    })
}

/// Angular rate, rad/s, that the largest torques in hover may spin the vehicle up to within a sample of the attitude
/// controller. In the next sample of 10 ms it turns by 0.3 rad, half of limits.tilt, before anybody sees it. This is a margin:
/// of 181 random flights beyond it whose moments differ by less than fifty times the smallest none was lost, and even a
/// vehicle of 30 g has about 3 rad/s.
const MOST_SPIN_RAD_S: f64 = 30.0;

/// The rotors must not spin the vehicle up faster than the attitude controller looks.
fn validate_spin(configuration: &Configuration, torques_n_m: [f64; 3]) -> Result<(), ConfigurationError> {
    let airframe = &configuration.airframe;
    let sample_time_s = configuration.controllers.attitude.sample_time_s();
    let names = ["airframe.inertia.x", "airframe.inertia.y", "airframe.inertia.z"];
    for ((name, value), torque_n_m) in names.into_iter().zip(airframe.inertia_kg_m2).zip(torques_n_m) {
        let least = torque_n_m * sample_time_s / MOST_SPIN_RAD_S;
        if value >= least {
            continue;
        }
        // No propeller's drag has a longer arm than its lift.
        let drags =
            airframe.torque_coefficient_n_m_s2 > airframe.thrust_coefficient_n_s2 * airframe.arm_length_m;
        if name == "airframe.inertia.z" && drags {
            let value_drag = airframe.torque_coefficient_n_m_s2;
            return Err(ConfigurationError::Inconsistent {
                name: "airframe.rotor.torque_coefficient",
                value: Quantity { value: value_drag, unit: "N·m·s²" },
                relation: "at most",
                limit: rounded_down(value_drag * value / least, "N·m·s²"),
                reason: "more spins the vehicle by over 30 rad/s within one controller.attitude.sample_time",
            });
        }
        return Err(ConfigurationError::Inconsistent {
            name,
            value: Quantity { value, unit: "kg·m²" },
            relation: "at least",
            limit: rounded_up(least, "kg·m²"),
            reason: "with less the rotors spin it by over 30 rad/s within one controller.attitude.sample_time",
        });
    }
    Ok(())
}

/// A flight over ground starts above it, in the attitude that it starts with.
fn validate_start(configuration: &Configuration) -> Result<(), ConfigurationError> {
    let start = PlantState::at_rest(&configuration.initial);
    validate_start_over(configuration, &start.body, 0.0)
}

/// A body starts above ground at a height, `ground_z_m`, NED. One that is not finite is refused by the first step.
#[inline(never)]
pub(crate) fn validate_start_over(
    configuration: &Configuration,
    body: &RigidBody,
    ground_z_m: f64,
) -> Result<(), ConfigurationError> {
    if !configuration.environment.ground_plane || !ground_z_m.is_finite() {
        return Ok(());
    }
    let z_m = body.position_m.z;
    let greatest_m = greatest_start_z_m(&configuration.airframe, body, ground_z_m);
    if z_m <= greatest_m {
        Ok(())
    } else {
        Err(ConfigurationError::BelowGround { z_m, greatest_m, ground_z_m })
    }
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
                value: Quantity { value: outer, unit: "s" },
                relation: "at least",
                limit: Quantity { value: inner, unit: "s" },
                reason: "that is controller.attitude.sample_time",
            });
        }
    }
    Ok(())
}

/// A limit with four significant digits that is allowed itself, or nearly.
fn rounded_down(value: f64, unit: &'static str) -> Quantity {
    let scale = libm::pow(10.0, 3.0 - libm::floor(libm::log10(value)));
    Quantity { value: libm::floor(value * scale) / scale, unit }
}

/// The same, from above.
fn rounded_up(value: f64, unit: &'static str) -> Quantity {
    let scale = libm::pow(10.0, 3.0 - libm::floor(libm::log10(value)));
    Quantity { value: libm::ceil(value * scale) / scale, unit }
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
