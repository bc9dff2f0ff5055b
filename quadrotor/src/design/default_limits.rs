//! The limits that an airframe can fly within.

use crate::ConfigurationError;
use crate::configuration::settings::Limits;
use crate::design::default_bandwidths::{Agility, Bandwidths, default_bandwidths};
use crate::design::default_reach::{default_spare_thrust, default_tilt_rad};
use crate::plant::airframe::Airframe;

/// Largest error of the heading, rad, that the shaped reference may leave to the feedback while its rate changes.
const YAW_LAG_RAD: f64 = 0.19;

/// Largest rate of the heading reference, rad/s: 90° a second.
const FASTEST_YAW_RAD_S: f64 = core::f64::consts::FRAC_PI_2;

/// The default limits of an airframe. Those of the paper's airframe are [`Limits::default`]; the others follow from them:
///
/// | limit | why |
/// | --- | --- |
/// | tilt | 0.6 rad, or where holding the altitude takes half of the thrust that is left |
/// | tilt acceleration | with the angular acceleration in hover, and with ω²: the same share of the torque, and the same error behind the command |
/// | tilt rate | with the root of that: the same angle is covered in the time that the loop takes |
/// | thrust | 0.6 to 2 weights, or what the rotors make with a fifth in reserve |
/// | horizontal speed | 8 m/s, or where drag and the largest acceleration take all of the commanded tilt |
/// | acceleration | 2.5 and 2 m/s², or the same share of the tilt and of the thrust |
/// | jerk | with the bandwidth of tilt and altitude: a kick leaves the same error |
/// | yaw acceleration | 0.43 of the one that the rotors have in hover, and no more error than 0.19 rad behind the reference |
/// | yaw rate, yaw jerk | with the root of that, up to 90° per second; with that and the bandwidth |
///
/// # Errors
/// [`ConfigurationError::Layout`] when the rotors cannot make every torque.
pub(crate) fn default_limits(airframe: &Airframe) -> Result<Limits, ConfigurationError> {
    let paper = Airframe::default();
    let known = Limits::default();
    let (from, to) = (default_bandwidths(&paper)?, default_bandwidths(airframe)?);
    let (had, has) = (Agility::of(&paper)?, Agility::of(airframe)?);

    let spare = default_spare_thrust(airframe);
    let acceleration_m_s2 = known.acceleration_horizontal_m_s2
        * (has.horizontal_acceleration_m_s2 / had.horizontal_acceleration_m_s2);

    let brisk = (has.tilt_acceleration_rad_s2 / had.tilt_acceleration_rad_s2)
        .min(squared(to.tilt_rad_s / from.tilt_rad_s));
    let yaw = yaw_share(&had, &has, &to, &known);
    Ok(Limits {
        tilt_rad: default_tilt_rad(airframe),
        tilt_rate_rad_s: known.tilt_rate_rad_s * libm::sqrt(brisk),
        tilt_acceleration_rad_s2: known.tilt_acceleration_rad_s2 * brisk,
        thrust_min: known.thrust_min,
        thrust_max: 1.0 + spare,
        speed_horizontal_m_s: known
            .speed_horizontal_m_s
            .min(dragged_speed_m_s(airframe, has.horizontal_acceleration_m_s2 - acceleration_m_s2)),
        full_speed: known.full_speed,
        speed_up_m_s: known.speed_up_m_s,
        speed_down_m_s: known.speed_down_m_s,
        acceleration_horizontal_m_s2: acceleration_m_s2,
        acceleration_vertical_m_s2: known.acceleration_vertical_m_s2 * spare / default_spare_thrust(&paper),
        jerk_horizontal_m_s3: known.jerk_horizontal_m_s3 * libm::sqrt(brisk),
        jerk_vertical_m_s3: known.jerk_vertical_m_s3 * (to.altitude_rad_s / from.altitude_rad_s),
        yaw_rate_rad_s: known.yaw_rate_rad_s * libm::sqrt(yaw).min(FASTEST_YAW_RAD_S / known.yaw_rate_rad_s),
        yaw_acceleration_rad_s2: known.yaw_acceleration_rad_s2 * yaw,
        yaw_jerk_rad_s3: known.yaw_jerk_rad_s3 * yaw * (to.yaw_rad_s / from.yaw_rad_s),
    })
}

fn squared(value: f64) -> f64 {
    value * value
}

/// Acceleration of the heading as a multiple of the paper's airframe's.
fn yaw_share(had: &Agility, has: &Agility, to: &Bandwidths, known: &Limits) -> f64 {
    let by_torque = has.yaw_acceleration_rad_s2 / had.yaw_acceleration_rad_s2;
    by_torque.min(YAW_LAG_RAD * squared(to.yaw_rad_s) / known.yaw_acceleration_rad_s2)
}

/// Speed, m/s, at which drag decelerates by so many m/s²: infinite without drag, and never so small that nothing can be flown.
fn dragged_speed_m_s(airframe: &Airframe, deceleration_m_s2: f64) -> f64 {
    let [north, east, _] = airframe.drag_n_s_m;
    (airframe.mass_kg * deceleration_m_s2 / north.max(east)).max(0.5)
}

#[cfg(test)]
mod tests {
    use super::default_limits;
    use crate::{Airframe, AirframePreset, GRAVITY_M_S2, Limits};

    #[test]
    fn those_of_the_papers_airframe_are_the_defaults_bit_for_bit() {
        assert_eq!(default_limits(&Airframe::default()), Ok(Limits::default()));
    }

    /// Scaled by lengths as s and by masses as s³ at the same accelerations, a vehicle has 1/s of the angular accelerations and keeps
    /// its thrust to weight.
    #[test]
    fn a_larger_vehicle_turns_as_slowly_as_its_torques_demand() {
        let paper = Airframe::default();
        let scale: f64 = 4.0;
        let larger = Airframe {
            mass_kg: paper.mass_kg * scale.powi(3),
            arm_length_m: paper.arm_length_m * scale,
            inertia_kg_m2: paper.inertia_kg_m2.map(|inertia| inertia * scale.powi(5)),
            thrust_coefficient_n_s2: paper.thrust_coefficient_n_s2 * scale.powi(3),
            torque_coefficient_n_m_s2: paper.torque_coefficient_n_m_s2 * scale.powi(4),
            ..paper
        };
        let limits = default_limits(&larger).unwrap();
        let known = Limits::default();
        let near = |value: f64, expected: f64| assert!((value / expected - 1.0).abs() < 1e-9, "{limits:?}");
        near(limits.tilt_acceleration_rad_s2, known.tilt_acceleration_rad_s2 / scale);
        near(limits.tilt_rate_rad_s, known.tilt_rate_rad_s / scale.sqrt());
        near(limits.yaw_acceleration_rad_s2, known.yaw_acceleration_rad_s2 / scale);
        near(limits.thrust_max, known.thrust_max);
        near(limits.acceleration_horizontal_m_s2, known.acceleration_horizontal_m_s2);
    }

    #[test]
    fn weak_rotors_tilt_and_climb_less_and_drag_costs_speed() {
        let paper = Airframe::default();
        let weak = Airframe { mass_kg: 1.5, ..paper };
        let limits = default_limits(&weak).unwrap();
        // Four fifths of 21.87 N over 1.5 kg.
        let most = 0.8 * 21.87 / (1.5 * GRAVITY_M_S2);
        assert!((limits.thrust_max - most).abs() < 1e-12, "{limits:?}");
        assert!((limits.tilt_rad.cos().recip() - 1.0 - (most - 1.0) / 2.0).abs() < 1e-12, "{limits:?}");
        let slow = Airframe { drag_n_s_m: [0.5, 0.2, 0.0], ..paper };
        let limits = default_limits(&slow).unwrap();
        let deceleration_m_s2 = limits.speed_horizontal_m_s * 0.5 / 0.7;
        assert!(limits.speed_horizontal_m_s < 8.0, "{limits:?}");
        assert!(
            deceleration_m_s2 + limits.acceleration_horizontal_m_s2
                <= GRAVITY_M_S2 * (0.91 * 0.6_f64).tan() + 1e-9
        );
    }

    /// Whatever is published lies within the declared ranges.
    #[test]
    fn every_preset_has_limits() {
        for preset in AirframePreset::ALL {
            let limits = default_limits(&preset.airframe()).unwrap();
            assert!(limits.speed_horizontal_m_s > 2.0 && limits.tilt_rad > 0.5, "{preset:?}: {limits:?}");
        }
    }
}
