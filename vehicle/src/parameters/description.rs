//! What a parameter means, for a person.

use quadrotor::{Access, Mutability, Parameter, ValueRange};

use super::entry::Source;
use super::{ConductParameter, Entry, NamedValue, Statistic};
use crate::vehicle::Conduct;

/// A parameter in words.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// What it is.
    pub text: String,
    /// Smallest and largest value with their unit.
    pub range: ValueRange,
    /// Whether only whole numbers are allowed.
    pub whole: bool,
    /// Values that have names, if only those are allowed.
    pub names: Vec<NamedValue>,
    /// What it belongs to.
    pub group: &'static str,
    /// Whether a change takes effect at the next start only.
    pub needs_restart: bool,
    /// Whether it is only told: it follows from others, or from the start.
    pub read_only: bool,
}

/// Text and unit of the vehicle's own parameters, by PX4's identifiers. ArduPilot's units are others: see [`ardupilot_unit`].
#[rustfmt::skip] // One line per parameter reads as the table that it is.
const CONDUCT: &[(&str, &str, &str)] = &[
    ("MIS_TAKEOFF_ALT", "Height above home of a takeoff without an altitude of its own", "m"),
    ("COM_OF_LOSS_T", "Time without set-points after which they count as lost", "s"),
    ("COM_OBL_RC_ACT", "Action when set-points are lost", ""),
    ("RTL_RETURN_ALT", "Height above home at which the vehicle returns", "m"),
    ("RTL_MIN_DIST", "Distance from home within which a return lands without climbing first", "m"),
    ("MPC_LAND_SPEED", "Descent rate near the ground", "m/s"),
    ("COM_DISARM_LAND", "Delay from touch-down to automatic disarming; negative disables it", "s"),
    ("COM_DISARM_PRFLT", "Delay from arming without a takeoff to automatic disarming; negative disables it", "s"),
    ("MPC_VEL_MANUAL", "Horizontal speed at full stick deflection", "m/s"),
    ("MPC_Z_V_MAN_UP", "Climb rate at full stick deflection", "m/s"),
    ("MPC_Z_V_MAN_DN", "Descent rate at full stick deflection", "m/s"),
    ("COM_RC_LOSS_T", "Time without stick inputs after which they count as lost", "s"),
    ("BAT1_CAPACITY", "Capacity of the battery", "mAh"),
    ("NAV_ACC_RAD", "Acceptance radius of waypoints without one of their own", "m"),
    ("SYS_FAILURE_EN", "Allow failure injection by command", ""),
    ("COM_DL_LOSS_T", "Time without heartbeats after which the ground station counts as lost", "s"),
    ("NAV_DLL_ACT", "Action when the ground station is lost", ""),
    ("BAT_LOW_THR", "Remaining charge at which the battery is low", "norm"),
    ("BAT_CRIT_THR", "Remaining charge at which the battery is critical", "norm"),
    ("BAT_EMERGEN_THR", "Remaining charge at which the battery is almost empty", "norm"),
    ("COM_LOW_BAT_ACT", "Action when the battery is critical; 3 returns, then lands when the battery is almost empty", ""),
    ("GF_ACTION", "Action at the fence", ""),
    ("GF_PREDICT", "Act as soon as the vehicle could no longer stop before the fence", ""),
    ("GF_MAX_HOR_DIST", "Radius of the fence around home; 0 disables it", "m"),
    ("GF_MAX_VER_DIST", "Height of the fence above home; 0 disables it", "m"),
    ("COM_WIND_MAX", "Wind speed that is too high to fly in; negative disables the check", "m/s"),
    ("COM_WIND_MAX_ACT", "Action when the wind is too high", ""),
    ("COM_POSCTL_NAVL", "Action when the position estimate is lost", ""),
    ("COM_ACT_FAIL_ACT", "Action when a rotor fails", ""),
    ("FENCE_ENABLE", "Enable the fence", ""),
    ("FENCE_TYPE", "Enabled parts of the fence, added up: 1 maximum height, 2 maximum distance, 4 zones", ""),
    ("FENCE_ACTION", "Action at the fence", ""),
    ("FS_GCS_ENABLE", "Action when the ground station is lost", ""),
    ("BATT_FS_LOW_ACT", "Action when the battery is low", ""),
    ("BATT_FS_CRT_ACT", "Action when the battery is critical; when almost empty the vehicle lands at the latest, unless this is 0", ""),
    ("FD_FAIL_R", "Roll that counts as a failure; 0 disables it", "deg"),
    ("FD_FAIL_P", "Pitch that counts as a failure; 0 disables it", "deg"),
    ("FD_FAIL_R_TTRI", "Time that the roll must last to count as a failure", "s"),
    ("FD_FAIL_P_TTRI", "Time that the pitch must last to count as a failure", "s"),
    ("COM_LKDOWN_TKO", "Time from arming in which a failure stops the rotors", "s"),
    ("CBRK_FLIGHTTERM", "Circuit breaker of flight termination; 121212: a failure in flight is only reported", ""),
    ("LOG_BITMASK", "What is logged, added up as in ArduCopter: 1 fast attitude, 2 attitude, 4 GPS, 8 performance, 16 height, 32 position, 128 IMU, 512 battery, 1024 motors, 8192 compass, 131072 mixer, 262144 fast IMU", ""),
    ("LOG_DISARMED", "Log while disarmed, too", ""),
    ("LOG_FILE_DSRMROT", "Begin a new log with each flight instead of each boot", ""),
    ("FS_CRASH_CHECK", "Disarm a vehicle that has crashed", ""),
    ("COM_ARM_BAT_MIN", "Smallest remaining charge with which the vehicle arms", "norm"),
];

/// Names of values of the vehicle's own parameters.
#[rustfmt::skip] // As above.
const NAMES: &[(&str, &[(i32, &str)])] = &[
    ("COM_OBL_RC_ACT", &[(0, "Position mode"), (3, "Return"), (4, "Land"), (5, "Hold"), (6, "Terminate")]),
    ("SYS_FAILURE_EN", &[(0, "Off"), (1, "On")]),
    ("LOG_DISARMED", &[(0, "Off"), (1, "On"), (2, "On, discarded on USB power"), (3, "On, discarded unless armed")]),
    ("LOG_FILE_DSRMROT", &[(0, "Off"), (1, "On")]),
    ("FS_CRASH_CHECK", &[(0, "Off"), (1, "On")]),
    ("GF_PREDICT", &[(0, "Beyond the fence only"), (1, "Ahead of it")]),
    ("NAV_DLL_ACT", &[(0, "Nothing"), (1, "Hold"), (2, "Return"), (3, "Land"), (5, "Terminate")]),
    ("COM_LOW_BAT_ACT", &[(0, "Warn"), (2, "Land"), (3, "Return, then land")]),
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

/// PX4's unit of shares of a whole, which says nothing to a person.
const SHARE: &str = "norm";

impl Description {
    /// The values that it can have: `0.05–1.2 rad (3°–69°)`, `whole numbers 1–8`, `1 (lmpc), 2 (ssmpc), 3 (dlqr)`.
    pub fn allowed(&self) -> String {
        if !self.names.is_empty() {
            let names = self.names.iter().map(|named| format!("{} ({})", named.value, named.name));
            return names.collect::<Vec<_>>().join(", ");
        }
        let range = self.shown_range();
        if self.whole { format!("whole numbers {range}") } else { range.to_string() }
    }

    /// A value with its unit.
    pub fn shown(&self, value: f64) -> String {
        self.shown_range().quantity(value).to_string()
    }

    fn shown_range(&self) -> ValueRange {
        ValueRange { unit: if self.range.unit == SHARE { "" } else { self.range.unit }, ..self.range }
    }
}

impl Entry {
    /// What it means.
    pub fn describe(&self) -> Description {
        match self.source {
            Source::Loop(parameter) => describe_loop(parameter),
            Source::Conduct(parameter, scale) => describe_conduct(parameter, scale),
            Source::SystemId => Description {
                text: "MAVLink system id; set at the start".to_owned(),
                range: ValueRange { minimum: 1.0, maximum: 250.0, unit: "" },
                whole: true,
                names: Vec::new(),
                group: "MAVLink",
                needs_restart: true,
                read_only: true,
            },
            Source::HoverThrust => Description {
                text: "Thrust in hover as a share of the largest thrust, as attitude set-points take it; calculated from mass \
                       and rotors (read-only)"
                    .to_owned(),
                range: ValueRange { minimum: 0.0, maximum: 1.0, unit: "norm" },
                whole: false,
                names: Vec::new(),
                group: "Airframe",
                needs_restart: false,
                read_only: true,
            },
            Source::Statistic(statistic) => Description {
                text: statistic.text().to_owned(),
                range: ValueRange { minimum: 0.0, maximum: f64::from(i32::MAX), unit: statistic.unit() },
                whole: true,
                names: statistic.choices().iter().map(|(value, name)| plain(*value, name)).collect(),
                group: "Statistics",
                needs_restart: false,
                read_only: statistic != Statistic::Reset,
            },
            Source::Speed => Description {
                text: "Simulated seconds per second; 0 pauses, -1 is as fast as possible".to_owned(),
                range: ValueRange { minimum: -1.0, maximum: 1000.0, unit: "" },
                whole: false,
                names: Vec::new(),
                group: "Simulation",
                needs_restart: false,
                read_only: false,
            },
        }
    }

    /// The values that it can have, for a person.
    pub fn allowed(&self) -> String {
        match self.source {
            Source::Speed => "0 (paused), 0.01–1000, -1 (as fast as possible)".to_owned(),
            _ => self.describe().allowed(),
        }
    }
}

fn describe_loop(parameter: &Parameter) -> Description {
    let (minimum, maximum, names) = match &parameter.access {
        Access::Real { minimum, maximum, .. } => (*minimum, *maximum, Vec::new()),
        Access::Integer { minimum, maximum, .. } => (f64::from(*minimum), f64::from(*maximum), Vec::new()),
        Access::Enumeration { choice, .. } => {
            let items = (1..).zip(choice.items.iter());
            let names = items.map(|(value, (name, text))| NamedValue { value, name, meaning: Some(text) });
            (1.0, choice.items.len() as f64, names.collect())
        }
        Access::Boolean { .. } => (0.0, 1.0, SWITCH.map(|(value, name)| plain(value, name)).to_vec()),
    };
    Description {
        text: parameter.description.to_owned(),
        range: ValueRange { minimum, maximum, unit: parameter.unit.symbol() },
        whole: !matches!(parameter.access, Access::Real { .. }),
        names,
        group: group(parameter.name),
        needs_restart: parameter.mutability == Mutability::Start,
        read_only: false,
    }
}

fn describe_conduct(parameter: &ConductParameter, scale: f64) -> Description {
    let known = CONDUCT.iter().find(|(id, ..)| *id == parameter.id);
    let (_, text, unit) = known.copied().unwrap_or((parameter.id, parameter.id, ""));
    let names = NAMES.iter().find(|(id, _)| *id == parameter.id);
    let names = names.map_or(&[][..], |(_, names)| names).iter();
    // What the parameter refuses is not offered.
    let takes = |value: i32| (parameter.set)(&mut Conduct::new(false), f64::from(value));
    let names = names.filter(|(value, _)| takes(*value));
    Description {
        text: text.to_owned(),
        range: ValueRange {
            minimum: parameter.minimum * scale,
            maximum: parameter.maximum * scale,
            unit: if scale == 1.0 { unit } else { ardupilot_unit(unit) },
        },
        whole: parameter.integer,
        names: names.map(|(value, name)| plain(*value, name)).collect(),
        group: "Vehicle",
        needs_restart: false,
        read_only: false,
    }
}

/// Names of the values of a switch.
const SWITCH: [(i32, &str); 2] = [(0, "Off"), (1, "On")];

fn plain(value: i32, name: &'static str) -> NamedValue {
    NamedValue { value, name, meaning: None }
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
        Some("controller") => "Controllers",
        Some("limits") => "Limits",
        Some("sensor") => "Sensors",
        _ => "Closed loop",
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
                assert!(description.range.minimum < description.range.maximum, "{}", entry.id);
            }
        }
        let table = ParameterTable::new(Identity::ArduPilot);
        let range = table.find("RTL_ALT").expect("there").describe().range;
        assert_eq!((range.unit, range.minimum, range.maximum), ("cm", 100.0, 100_000.0));
    }
}
