//! One change: a unit breaks, or works again.

use std::fmt;
use std::str::FromStr;

use quadrotor::RotorFault;
use serde::{Deserialize, Serialize};

use super::{BatteryFault, Rotors, Sensor, SensorFault};

/// Share of the thrust that a weak rotor makes, unless it is named.
const WEAK_SHARE: f64 = 0.7;

/// A unit with what is wrong with it from now on; `None`: nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Fault {
    /// An instrument.
    Sensor(Sensor, Option<SensorFault>),
    /// The battery.
    Battery(Option<BatteryFault>),
    /// Rotors.
    Rotors(Rotors, Option<RotorFault>),
}

/// Why there is no such fault.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Meaningless(String);

/// FAILURE_UNIT
mod unit {
    pub const BATTERY: u32 = 100;
    pub const MOTOR: u32 = 101;
}

/// FAILURE_TYPE by number, with our names.
const KINDS: [&str; 8] = ["ok", "off", "stuck", "garbage", "wrong", "slow", "delayed", "intermittent"];

/// Of sensors, in the order of [`KINDS`].
const SENSOR_FAULTS: [Option<SensorFault>; 8] = [
    None,
    Some(SensorFault::Off),
    Some(SensorFault::Stuck),
    Some(SensorFault::Garbage),
    Some(SensorFault::Wrong),
    Some(SensorFault::Slow),
    Some(SensorFault::Delayed),
    Some(SensorFault::Intermittent),
];
const BATTERY_FAULTS: [(&str, Option<BatteryFault>); 4] = [
    ("ok", None),
    ("off", Some(BatteryFault::Off)),
    ("stuck", Some(BatteryFault::Stuck)),
    ("wrong", Some(BatteryFault::Wrong)),
];
const ROTOR_FAULTS: [(&str, Option<RotorFault>); 4] = [
    ("ok", None),
    ("off", Some(RotorFault::Off)),
    ("stuck", Some(RotorFault::Stuck)),
    ("weak", Some(RotorFault::Weak { share: WEAK_SHARE })),
];

impl Fault {
    /// By the numbers of MAV_CMD_INJECT_FAILURE: FAILURE_UNIT, FAILURE_TYPE, and the instance from 1, 0 for all. A rotor
    /// that is "slow" or "wrong" is a weak one.
    ///
    /// # Errors
    /// [`Meaningless`] with what there is.
    pub fn of_numbers(unit: u32, kind: u32, instance: u32) -> Result<Self, Meaningless> {
        let name = usize::try_from(kind).ok().and_then(|kind| KINDS.get(kind)).copied();
        let Some(name) = name else {
            return Err(Meaningless(format!("unknown failure type {kind}; use 0 to 7")));
        };
        if unit == unit::MOTOR {
            let Some(rotors) = Rotors::numbered(instance) else {
                return Err(Meaningless(format!("unknown motor {instance}; use 1 to 4, or 0 for all")));
            };
            let name = if matches!(name, "wrong" | "slow") { "weak" } else { name };
            return Ok(Self::Rotors(rotors, among("motor", name, &ROTOR_FAULTS)?));
        }
        let sensor = Sensor::ALL.into_iter().find(|sensor| sensor.number() == unit);
        if sensor.is_none() && unit != unit::BATTERY {
            let known =
                "0 gyroscope, 1 accelerometer, 2 magnetometer, 3 barometer, 4 GPS, 100 battery, 101 motor";
            return Err(Meaningless(format!("unknown failure unit {unit}; use {known}")));
        }
        if instance > 1 {
            return Err(Meaningless(format!("unknown instance {instance}; the unit has only one")));
        }
        match sensor {
            Some(sensor) => Ok(Self::Sensor(sensor, sensor_fault(sensor, name)?)),
            None => Ok(Self::Battery(among("battery", name, &BATTERY_FAULTS)?)),
        }
    }

    /// The numbers of MAV_CMD_INJECT_FAILURE that name it: FAILURE_UNIT, FAILURE_TYPE and the instance. They have no share of
    /// the thrust: a weak rotor keeps the one that is weak by default.
    pub fn numbers(&self) -> [u32; 3] {
        let name = self.kind_name();
        let name = if name.starts_with("weak") { "wrong" } else { &name };
        let kind = (0..).zip(KINDS).find(|(_, known)| *known == name).map_or(0, |(number, _)| number);
        match self {
            Self::Sensor(sensor, _) => [sensor.number(), kind, 0],
            Self::Battery(_) => [unit::BATTERY, kind, 0],
            Self::Rotors(rotors, _) => [unit::MOTOR, kind, rotors.number()],
        }
    }

    /// Whether it changes what an instrument reads: ideal ones read nothing, they only fall silent.
    pub fn needs_readings(&self) -> bool {
        use SensorFault::{Delayed, Garbage, Slow, Wrong};
        matches!(self, Self::Sensor(_, Some(Garbage | Wrong | Slow | Delayed)))
    }

    /// Whether it is a rotor's.
    pub fn is_of_rotors(&self) -> bool {
        matches!(self, Self::Rotors(..))
    }

    fn unit_name(&self) -> String {
        match self {
            Self::Sensor(sensor, _) => sensor.name().to_owned(),
            Self::Battery(_) => "battery".to_owned(),
            Self::Rotors(Rotors::All, _) => "rotors".to_owned(),
            Self::Rotors(rotor, _) => format!("rotor{}", rotor.number()),
        }
    }

    fn kind_name(&self) -> String {
        match self {
            Self::Sensor(_, fault) => name_of(fault, KINDS.into_iter().zip(SENSOR_FAULTS)),
            Self::Battery(fault) => name_of(fault, BATTERY_FAULTS),
            Self::Rotors(_, Some(RotorFault::Weak { share })) => format!("weak:{share}"),
            Self::Rotors(_, fault) => name_of(fault, ROTOR_FAULTS),
        }
    }
}

/// `UNIT=KIND`, as it is written.
impl fmt::Display for Fault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}={}", self.unit_name(), self.kind_name())
    }
}

impl FromStr for Fault {
    type Err = Meaningless;

    /// `UNIT=KIND`; a weak rotor with the share of its thrust behind a colon.
    fn from_str(text: &str) -> Result<Self, Meaningless> {
        let Some((unit, kind)) = text.split_once('=') else {
            return Err(Meaningless(format!("`{text}` is not UNIT=KIND")));
        };
        let (unit, kind) = (unit.trim(), kind.trim());
        if let Some(sensor) = Sensor::ALL.into_iter().find(|sensor| sensor.name() == unit) {
            return Ok(Self::Sensor(sensor, sensor_fault(sensor, kind)?));
        }
        if unit == "battery" {
            return Ok(Self::Battery(among(unit, kind, &BATTERY_FAULTS)?));
        }
        let number = unit.strip_prefix("rotor").map(|number| if number == "s" { "0" } else { number });
        let rotors = number.and_then(|number| number.parse().ok()).and_then(Rotors::numbered);
        let Some(rotors) = rotors.filter(|_| unit != "rotor0") else {
            let sensors = Sensor::ALL.map(Sensor::name).join(", ");
            return Err(Meaningless(format!(
                "unknown unit `{unit}`; use {sensors}, battery, rotor1 to rotor4, rotors"
            )));
        };
        let fault = match kind.strip_prefix("weak:") {
            Some(share) => Some(weak(share)?),
            None => among(unit, kind, &ROTOR_FAULTS)?,
        };
        Ok(Self::Rotors(rotors, fault))
    }
}

fn weak(share: &str) -> Result<RotorFault, Meaningless> {
    let fault = share.parse().ok().map(|share| RotorFault::Weak { share });
    fault
        .filter(|fault| fault.is_valid())
        .ok_or_else(|| Meaningless(format!("the share of a weak rotor's thrust is 0 to 1, not `{share}`")))
}

fn sensor_fault(sensor: Sensor, name: &str) -> Result<Option<SensorFault>, Meaningless> {
    let faults: Vec<_> = KINDS.into_iter().zip(SENSOR_FAULTS).collect();
    among(sensor.name(), name, &faults)
}

fn among<T: Copy>(unit: &str, name: &str, faults: &[(&str, Option<T>)]) -> Result<Option<T>, Meaningless> {
    let found = faults.iter().find(|(known, _)| *known == name);
    found.map(|(_, fault)| *fault).ok_or_else(|| {
        let known: Vec<_> = faults.iter().map(|(known, _)| *known).collect();
        Meaningless(format!("a {unit} cannot be `{name}`; use {}", known.join(", ")))
    })
}

fn name_of<T: PartialEq>(
    fault: &Option<T>,
    among: impl IntoIterator<Item = (&'static str, Option<T>)>,
) -> String {
    among.into_iter().find(|(_, known)| known == fault).map_or("", |(name, _)| name).to_owned()
}

#[cfg(test)]
mod tests {
    use super::{Fault, KINDS};

    #[test]
    fn what_is_written_is_read_again() {
        for unit in [
            "gyroscope",
            "accelerometer",
            "magnetometer",
            "barometer",
            "gps",
            "battery",
            "rotor1",
            "rotor4",
            "rotors",
        ] {
            for kind in KINDS.into_iter().chain(["weak:0.25"]) {
                let text = format!("{unit}={kind}");
                if let Ok(fault) = text.parse::<Fault>() {
                    assert_eq!(fault.to_string(), text);
                }
            }
        }
        assert_eq!("rotor2=weak".parse::<Fault>().expect("weak").to_string(), "rotor2=weak:0.7");
    }

    #[test]
    fn what_there_is_not_is_refused_with_what_there_is() {
        for (text, reason) in [
            ("gps", "`gps` is not UNIT=KIND"),
            ("rotor5=off", "unknown unit `rotor5`; use gyroscope"),
            ("rotor0=off", "unknown unit `rotor0`; use gyroscope"),
            ("rotor1=garbage", "a rotor1 cannot be `garbage`; use ok, off, stuck, weak"),
            ("rotor1=weak:1.5", "thrust is 0 to 1, not `1.5`"),
            ("rotor1=weak:nan", "thrust is 0 to 1, not `nan`"),
            ("battery=slow", "ok, off, stuck, wrong"),
        ] {
            let error = text.parse::<Fault>().expect_err(text).to_string();
            assert!(error.contains(reason), "{error}");
        }
    }

    /// The numbers of MAVLink's FAILURE_UNIT and FAILURE_TYPE.
    #[test]
    fn numbers_are_those_of_the_protocol() {
        for ((unit, kind, instance), text) in [
            ((0, 3, 0), "gyroscope=garbage"),
            ((1, 4, 1), "accelerometer=wrong"),
            ((2, 2, 0), "magnetometer=stuck"),
            ((3, 7, 0), "barometer=intermittent"),
            ((4, 5, 0), "gps=slow"),
            ((4, 6, 0), "gps=delayed"),
            ((100, 1, 0), "battery=off"),
            ((101, 1, 1), "rotor1=off"),
            ((101, 5, 3), "rotor3=weak:0.7"),
            ((101, 0, 0), "rotors=ok"),
        ] {
            let fault = Fault::of_numbers(unit, kind, instance).expect(text);
            assert_eq!(fault.to_string(), text);
            let [unit, kind, instance] = fault.numbers();
            assert_eq!(Fault::of_numbers(unit, kind, instance), Ok(fault), "{text}");
        }
        for (unit, kind, instance) in [(5, 1, 0), (4, 8, 0), (4, 1, 2), (101, 1, 5), (101, 3, 1), (100, 5, 0)]
        {
            assert!(Fault::of_numbers(unit, kind, instance).is_err(), "{unit} {kind} {instance}");
        }
    }
}
