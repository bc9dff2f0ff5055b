//! Limits of the closed loop by the names that PX4 and ArduPilot have for them.

/// Degrees in a radian, as PX4 counts angles.
const DEGREES: f64 = 180.0 / core::f64::consts::PI;
/// Hundredths of them, as ArduPilot counts some.
const CENTIDEGREES: f64 = 100.0 * DEGREES;

/// A limit of the closed loop, which other autopilots know as well.
#[derive(Clone, Copy, Debug)]
pub struct LimitName {
    /// Public name in the closed loop.
    pub dotted: &'static str,
    /// PX4's names, with how many of their units one of ours is.
    pub px4: &'static [(&'static str, f64)],
    /// ArduPilot's: before and after their renaming in version 4.7.
    pub ardupilot: &'static [(&'static str, f64)],
    /// What it is.
    pub text: &'static str,
}

impl LimitName {
    /// The unit of a name, from that of the closed loop.
    pub(super) fn unit_at(&self, scale: f64, unit: &'static str) -> &'static str {
        match unit {
            "rad" if scale == DEGREES => "deg",
            "rad" if scale == CENTIDEGREES => "cdeg",
            "rad/s" if scale == DEGREES => "deg/s",
            "rad/s" if scale == CENTIDEGREES => "cdeg/s",
            "m/s" if scale == 100.0 => "cm/s",
            "m/s2" if scale == 100.0 => "cm/s/s",
            _ => unit,
        }
    }
}

const fn limit(
    dotted: &'static str,
    px4: &'static [(&'static str, f64)],
    ardupilot: &'static [(&'static str, f64)],
    text: &'static str,
) -> LimitName {
    LimitName { dotted, px4, ardupilot, text }
}

/// All limits that have other names. They start at the limits of the airframe, not at the other autopilots' defaults.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static LIMIT_NAMES: &[LimitName] = &[
    limit("limits.speed.horizontal", &[("MPC_XY_CRUISE", 1.0)], &[("WPNAV_SPEED", 100.0), ("WP_SPD", 1.0)], "Horizontal speed of missions and on the way to goals"),
    limit("limits.speed.up", &[("MPC_Z_V_AUTO_UP", 1.0)], &[("WPNAV_SPEED_UP", 100.0), ("WP_SPD_UP", 1.0)], "Climb rate of missions and on the way to goals"),
    limit("limits.speed.down", &[("MPC_Z_V_AUTO_DN", 1.0)], &[("WPNAV_SPEED_DN", 100.0), ("WP_SPD_DN", 1.0)], "Sink rate of missions and on the way to goals"),
    limit("limits.acceleration.horizontal", &[("MPC_ACC_HOR", 1.0)], &[("WPNAV_ACCEL", 100.0), ("WP_ACC", 1.0)], "Horizontal acceleration"),
    limit("limits.acceleration.vertical", &[("MPC_ACC_UP_MAX", 1.0)], &[("WPNAV_ACCEL_Z", 100.0), ("WP_ACC_Z", 1.0)], "Vertical acceleration"),
    limit("limits.jerk.horizontal", &[("MPC_JERK_AUTO", 1.0)], &[("WPNAV_JERK", 1.0), ("WP_JERK", 1.0)], "Horizontal jerk"),
    limit("limits.tilt", &[("MPC_TILTMAX_AIR", DEGREES)], &[("ATC_ANGLE_MAX", DEGREES)], "Largest tilt"),
    limit("limits.yaw_rate", &[("MPC_YAWRAUTO_MAX", DEGREES)], &[("ATC_SLEW_YAW", CENTIDEGREES), ("ATC_RATE_WPY_MAX", DEGREES)], "Largest rate at which the vehicle turns by itself"),
];

#[cfg(test)]
mod tests {
    use crate::identity::Identity;
    use crate::parameters::{ParameterTable, ParameterValues, Speed};
    use crate::vehicle::Conduct;
    use quadrotor::Configuration;

    /// Whichever of the names a script sets, all show the same limit in their units.
    #[test]
    fn all_names_of_a_limit_are_one_limit() {
        for (identity, set, value, told) in [
            (Identity::ArduPilot, "WPNAV_SPEED", 350.0, &[("WP_SPD", 3.5), ("LIM_SPEED_HORIZ", 3.5)][..]),
            (Identity::ArduPilot, "WP_SPD_DN", 0.75, &[("WPNAV_SPEED_DN", 75.0), ("LIM_SPEED_DOWN", 0.75)]),
            (Identity::ArduPilot, "ATC_ANGLE_MAX", 20.0, &[("LIM_TILT", 20_f32.to_radians())]),
            (Identity::Px4, "MPC_XY_CRUISE", 3.5, &[("LIM_SPEED_HORIZ", 3.5)]),
            (Identity::Px4, "MPC_TILTMAX_AIR", 20.0, &[("LIM_TILT", 20_f32.to_radians())]),
        ] {
            let table = ParameterTable::new(identity);
            let (configuration, conduct) = (Configuration::default(), Conduct::new(identity.is_ardupilot()));
            let mut values = ParameterValues {
                configuration,
                conduct,
                system_id: 1,
                speed: Speed::Factor(1.0),
                statistics: Default::default(),
            };
            table.set(set, value, &mut values).expect(set);
            for (name, expected) in told {
                let shown = table.find(name).expect(name).value(&values).number();
                assert!((shown - f64::from(*expected)).abs() < 1e-4, "{set}: {name} = {shown}");
            }
        }
        let table = ParameterTable::new(Identity::ArduPilot);
        let range = table.find("WPNAV_SPEED").expect("there").describe().range;
        assert_eq!((range.unit, range.minimum, range.maximum), ("cm/s", 10.0, 5000.0));
    }
}
