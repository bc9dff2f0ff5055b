//! What a parameter means, for a person.

use quadrotor::{Access, Unit};

use super::Entry;
use super::entry::Source;
use crate::vehicle::Conduct;

/// A parameter in words.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// What it is.
    pub text: String,
    /// Unit; empty for a number without one.
    pub unit: &'static str,
    /// Smallest and largest value.
    pub range: (f64, f64),
    /// Values that have names, if only those are allowed.
    pub names: Vec<(i32, String)>,
    /// What it belongs to.
    pub group: &'static str,
    /// Whether it only changes on the ground.
    pub fixed_in_flight: bool,
}

/// Text and unit of the vehicle's own parameters, by PX4's identifiers. ArduPilot's units are others: see [`ardupilot_unit`].
#[rustfmt::skip] // One line per parameter reads as the table that it is.
const CONDUCT: &[(&str, &str, &str)] = &[
    ("MIS_TAKEOFF_ALT", "Height above home of a takeoff that names none", "m"),
    ("COM_OF_LOSS_T", "Set-points are lost after this time without one", "s"),
    ("COM_OBL_RC_ACT", "What is done when set-points are lost", ""),
    ("RTL_RETURN_ALT", "Height above home of the way home", "m"),
    ("RTL_MIN_DIST", "Nearer to home than this a return lands without climbing", "m"),
    ("MPC_LAND_SPEED", "Sink rate near the ground", "m/s"),
    ("COM_DISARM_LAND", "Disarms this long after touch-down; negative: never", "s"),
    ("COM_DISARM_PRFLT", "Disarms this long after arming without a takeoff; negative: never", "s"),
    ("MPC_VEL_MANUAL", "Horizontal speed of a full stick", "m/s"),
    ("MPC_Z_V_MAN_UP", "Climb rate of a full stick", "m/s"),
    ("MPC_Z_V_MAN_DN", "Sink rate of a full stick", "m/s"),
    ("COM_RC_LOSS_T", "Sticks are lost after this time without them", "s"),
    ("BAT1_CAPACITY", "Charge of the full battery", "mAh"),
    ("NAV_ACC_RAD", "Waypoints that name no acceptance radius are passed within this one", "m"),
    ("SYS_FAILURE_EN", "Whether failures may be injected by command", ""),
    ("COM_DL_LOSS_T", "The ground station is lost after this time without its heartbeat", "s"),
    ("NAV_DLL_ACT", "What is done when the ground station is lost", ""),
    ("BAT_LOW_THR", "Remaining share at which the battery is low", "norm"),
    ("BAT_CRIT_THR", "Remaining share at which the battery is critical", "norm"),
    ("BAT_EMERGEN_THR", "Remaining share at which the battery is all but empty", "norm"),
    ("COM_LOW_BAT_ACT", "What is done when the battery is critical", ""),
    ("GF_ACTION", "What is done at the fence", ""),
    ("GF_PREDICT", "Whether it acts at the fence as soon as it could not stop before it", ""),
    ("GF_MAX_HOR_DIST", "Radius of the fence about home; 0: none", "m"),
    ("GF_MAX_VER_DIST", "Height of the fence above home; 0: none", "m"),
    ("COM_WIND_MAX", "Wind that is too high to fly in; negative: none is", "m/s"),
    ("COM_WIND_MAX_ACT", "What is done in too high a wind", ""),
    ("COM_POSCTL_NAVL", "What is done when the position estimate is lost", ""),
    ("COM_ACT_FAIL_ACT", "What is done when a rotor fails", ""),
    ("FENCE_ENABLE", "Whether the fence is looked at", ""),
    ("FENCE_TYPE", "What of the fence: 1 the greatest height, 2 the greatest distance, 4 zones; added up", ""),
    ("FENCE_ACTION", "What is done at the fence", ""),
    ("FS_GCS_ENABLE", "What is done when the ground station is lost", ""),
    ("BATT_FS_LOW_ACT", "What is done when the battery is low", ""),
    ("BATT_FS_CRT_ACT", "What is done when the battery is critical; all but empty it lands at the latest, unless this is 0", ""),
    ("COM_ARM_BAT_MIN", "Least remaining share of the battery to arm with", "norm"),
];

/// Names of values of the vehicle's own parameters.
#[rustfmt::skip] // As above.
const NAMES: &[(&str, &[(i32, &str)])] = &[
    ("COM_OBL_RC_ACT", &[(0, "Position mode"), (3, "Return"), (4, "Land"), (5, "Hold"), (6, "Terminate")]),
    ("SYS_FAILURE_EN", &[(0, "Off"), (1, "On")]),
    ("GF_PREDICT", &[(0, "Beyond the fence only"), (1, "Ahead of it")]),
    ("NAV_DLL_ACT", &[(0, "Nothing"), (1, "Hold"), (2, "Return"), (3, "Land"), (5, "Terminate")]),
    ("COM_LOW_BAT_ACT", &[(0, "Warn"), (2, "Land"), (3, "Return when critical, land when all but empty")]),
    ("GF_ACTION", &[(0, "Nothing"), (1, "Warn"), (2, "Hold"), (3, "Return"), (4, "Terminate"), (5, "Land")]),
    ("FENCE_ENABLE", &[(0, "Off"), (1, "On")]),
    ("FENCE_ACTION", &[(0, "Report only"), (1, "Return"), (2, "Land"), (4, "Brake")]),
    ("FS_GCS_ENABLE", &[(0, "Nothing"), (1, "Return"), (5, "Land"), (7, "Brake")]),
    ("BATT_FS_LOW_ACT", &[(0, "Warn"), (1, "Land"), (2, "Return"), (5, "Terminate"), (7, "Brake")]),
    ("BATT_FS_CRT_ACT", &[(0, "Warn"), (1, "Land"), (2, "Return"), (5, "Terminate"), (7, "Brake")]),
    ("COM_WIND_MAX_ACT", &[(0, "Nothing"), (1, "Warn"), (2, "Hold"), (3, "Return"), (4, "Terminate"), (5, "Land")]),
    ("COM_POSCTL_NAVL", &[(0, "Warn"), (1, "Land"), (2, "Terminate")]),
    ("COM_ACT_FAIL_ACT", &[(0, "Warn"), (1, "Hold"), (2, "Land"), (3, "Return"), (4, "Terminate")]),
];

impl Entry {
    /// What it means.
    pub fn describe(&self) -> Description {
        match self.source {
            Source::Loop(parameter) => {
                let (range, names) = match &parameter.access {
                    Access::Real { minimum, maximum, .. } => ((*minimum, *maximum), Vec::new()),
                    Access::Integer { minimum, maximum, .. } => {
                        ((f64::from(*minimum), f64::from(*maximum)), Vec::new())
                    }
                    Access::Enumeration { choice, .. } => {
                        let items = (1..).zip(choice.items.iter());
                        let names = items.map(|(value, (name, text))| (value, format!("{name}: {text}")));
                        ((1.0, choice.items.len() as f64), names.collect())
                    }
                    Access::Boolean { .. } => ((0.0, 1.0), vec![(0, "Off".to_owned()), (1, "On".to_owned())]),
                };
                Description {
                    text: parameter.description.to_owned(),
                    unit: symbol(parameter.unit),
                    range,
                    names,
                    group: group(parameter.name),
                    fixed_in_flight: !parameter.tunable,
                }
            }
            Source::Conduct(parameter, scale) => {
                let known = CONDUCT.iter().find(|(id, ..)| *id == parameter.id);
                let (_, text, unit) = known.copied().unwrap_or((parameter.id, parameter.id, ""));
                let names = NAMES.iter().find(|(id, _)| *id == parameter.id);
                let names = names.map_or(&[][..], |(_, names)| names).iter();
                // What the parameter refuses is not offered.
                let takes = |value: i32| (parameter.set)(&mut Conduct::new(false), f64::from(value));
                let names = names.filter(|(value, _)| takes(*value));
                Description {
                    text: text.to_owned(),
                    unit: if scale == 1.0 { unit } else { ardupilot_unit(unit) },
                    range: (parameter.minimum * scale, parameter.maximum * scale),
                    names: names.map(|(value, name)| (*value, (*name).to_owned())).collect(),
                    group: "Vehicle",
                    fixed_in_flight: false,
                }
            }
            Source::SystemId => Description {
                text: "MAVLink system id; set at the start".to_owned(),
                unit: "",
                range: (1.0, 250.0),
                names: Vec::new(),
                group: "MAVLink",
                fixed_in_flight: true,
            },
            Source::HoverThrust => Description {
                text: "Thrust in hover as a share of the largest thrust, as set-points of the attitude have it; read-only: \
                       weight / (4 AF_ROT_K1 × squared largest rotor speed)"
                    .to_owned(),
                unit: "norm",
                range: (0.0, 1.0),
                names: Vec::new(),
                group: "Airframe",
                fixed_in_flight: true,
            },
            Source::Speed => Description {
                text: "Simulated seconds per second; 0 pauses, -1 is as fast as possible".to_owned(),
                unit: "",
                range: (-1.0, 1000.0),
                names: Vec::new(),
                group: "Simulation",
                fixed_in_flight: false,
            },
        }
    }
}

/// ArduPilot counts metres in hundredths.
fn ardupilot_unit(unit: &'static str) -> &'static str {
    match unit {
        "m" => "cm",
        "m/s" => "cm/s",
        other => other,
    }
}

fn group(name: &str) -> &'static str {
    match name.split('.').next() {
        Some("airframe") => "Airframe",
        Some("controller" | "controllers") => "Controllers",
        Some("estimator") => "Estimator",
        Some("limits") => "Limits",
        Some("sensor" | "sensors") => "Sensors",
        _ => "Closed loop",
    }
}

fn symbol(unit: Unit) -> &'static str {
    match unit {
        Unit::One => "",
        Unit::Kilogram => "kg",
        Unit::Metre => "m",
        Unit::Second => "s",
        Unit::Radian => "rad",
        Unit::Newton => "N",
        Unit::NewtonMetre => "Nm",
        Unit::MetrePerSecond => "m/s",
        Unit::MetrePerSecondSquared => "m/s^2",
        Unit::MetrePerSecondCubed => "m/s^3",
        Unit::RadianPerSecond => "rad/s",
        Unit::RadianPerSecondSquared => "rad/s^2",
        Unit::RadianPerSecondCubed => "rad/s^3",
        Unit::KilogramSquareMetre => "kg m^2",
        Unit::NewtonSecondSquared => "N s^2",
        Unit::NewtonMetreSecondSquared => "Nm s^2",
        Unit::NewtonSecondPerMetre => "N s/m",
    }
}

#[cfg(test)]
mod tests {
    use crate::identity::Identity;
    use crate::parameters::ParameterTable;

    #[test]
    fn every_parameter_has_a_text_and_a_range_and_most_a_unit() {
        for identity in [Identity::Px4, Identity::ArduPilot] {
            let table = ParameterTable::new(identity);
            let described = table.entries().iter().map(|entry| (entry, entry.describe()));
            for (entry, description) in described {
                assert!(
                    !description.text.is_empty() && description.text != entry.id,
                    "{}: no text",
                    entry.id
                );
                assert!(description.range.0 < description.range.1, "{}", entry.id);
            }
        }
        let table = ParameterTable::new(Identity::ArduPilot);
        let altitude = table.index_of("RTL_ALT").and_then(|index| table.entries().get(index)).expect("there");
        let description = altitude.describe();
        assert_eq!((description.unit, description.range), ("cm", (100.0, 100_000.0)));
    }
}
