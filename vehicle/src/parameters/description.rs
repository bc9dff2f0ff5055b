//! What a parameter means, for a person.

use quadrotor::{Access, Mutability, Parameter, ValueRange};

use super::entry::Source;
use super::limit_names::LimitName;
use super::loop_names::loop_name;
use super::named_value::SWITCH;
use super::{ConductParameter, Entry, NamedValue, SpeedParameter, Statistic};
use crate::kept::KeptParameter;

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
    /// Meanings of the bits, the lowest first, if the value is a sum of them.
    pub bits: &'static [&'static str],
    /// What it belongs to.
    pub group: &'static str,
    /// Whether a change takes effect at the next start only.
    pub needs_restart: bool,
    /// Whether it is only told: it follows from others, or from the start.
    pub read_only: bool,
}

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
        let (minimum, maximum) = (-short_below(-range.minimum), short_below(range.maximum));
        let range = if self.whole { range } else { ValueRange { minimum, maximum, ..range } };
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

/// A bound that can be read: one with many digits, as in another unit, becomes one with few that is allowed, too.
fn short_below(bound: f64) -> f64 {
    const FEW: i32 = 4;
    const MANY: i32 = 6;
    if bound == 0.0 || !bound.is_finite() {
        return bound;
    }
    let digits_before = libm::floor(libm::log10(libm::fabs(bound))) as i32 + 1;
    let step = |digits: i32| libm::pow(10.0, f64::from(digits - digits_before));
    let readable = libm::round(bound * step(MANY)) / step(MANY);
    // What is off by the rounding of doubles, or of single precision, is meant.
    if (readable - bound).abs() <= 1e-7 * bound.abs() {
        return bound;
    }
    libm::floor(bound * step(FEW)) / step(FEW)
}

impl Entry {
    /// What it means.
    pub fn describe(&self) -> Description {
        match self.source {
            Source::Loop(parameter) => describe_loop(parameter),
            Source::Conduct(parameter, scale) => describe_conduct(parameter, scale),
            Source::Alias(name, parameter, scale) => describe_alias(name, parameter, scale),
            Source::BoundSpeed(parameter) => describe_speed(parameter),
            Source::Kept(parameter, _) => describe_kept(parameter),
            Source::SystemId => Description {
                text: "MAVLink system id; set at the start".to_owned(),
                range: ValueRange { minimum: 1.0, maximum: 250.0, unit: "" },
                whole: true,
                names: Vec::new(),
                bits: &[],
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
                bits: &[],
                group: "Airframe",
                needs_restart: false,
                read_only: true,
            },
            Source::Statistic(statistic) => Description {
                text: statistic.text().to_owned(),
                range: ValueRange { minimum: 0.0, maximum: statistic.most(), unit: statistic.unit() },
                whole: true,
                names: statistic.choices().iter().map(|(value, name)| NamedValue::new(*value, name)).collect(),
                bits: &[],
                group: "Statistics",
                needs_restart: false,
                read_only: !matches!(statistic, Statistic::Boots | Statistic::Reset),
            },
            Source::Speed => Description {
                text: "Simulated seconds per second; 0 pauses, -1 is as fast as possible".to_owned(),
                range: ValueRange { minimum: -1.0, maximum: 1000.0, unit: "" },
                whole: false,
                names: Vec::new(),
                bits: &[],
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
        Access::Boolean { .. } => (0.0, 1.0, SWITCH.to_vec()),
    };
    Description {
        text: parameter.description.to_owned(),
        range: ValueRange { minimum, maximum, unit: parameter.unit.symbol() },
        whole: !matches!(parameter.access, Access::Real { .. }),
        names,
        bits: &[],
        group: group(parameter.name),
        needs_restart: parameter.mutability == Mutability::Start,
        read_only: false,
    }
}

/// In the unit of the name; nothing else differs.
fn describe_alias(name: &LimitName, parameter: &Parameter, scale: f64) -> Description {
    let known = describe_loop(parameter);
    let range = ValueRange {
        minimum: known.range.minimum * scale,
        maximum: known.range.maximum * scale,
        unit: name.unit_at(scale, known.range.unit),
    };
    let text =
        format!("{}; the same as {}", name.text, loop_name(name.dotted).map_or(name.dotted, |own| own.id));
    Description { text, range, ..known }
}

fn describe_speed(parameter: &SpeedParameter) -> Description {
    Description {
        text: parameter.text.to_owned(),
        range: ValueRange { minimum: parameter.minimum, maximum: parameter.maximum, unit: "m/s" },
        whole: false,
        names: Vec::new(),
        bits: &[],
        group: "Vehicle",
        needs_restart: false,
        read_only: false,
    }
}

fn describe_kept(parameter: &KeptParameter) -> Description {
    Description {
        text: format!("{} (no effect here: {})", parameter.text, parameter.reason),
        range: ValueRange { minimum: parameter.minimum, maximum: parameter.maximum, unit: parameter.unit },
        whole: parameter.integer,
        names: Vec::new(),
        bits: &[],
        group: "Without effect",
        needs_restart: false,
        read_only: false,
    }
}

fn describe_conduct(parameter: &ConductParameter, scale: f64) -> Description {
    let names = (parameter.names)();
    let values = || names.iter().map(|named| f64::from(named.value));
    // Of what has names only those are taken.
    let minimum = values().reduce(f64::min).unwrap_or(parameter.minimum * scale);
    let maximum = values().reduce(f64::max).unwrap_or(parameter.maximum * scale);
    let unit = if scale == 1.0 { parameter.unit } else { ardupilot_unit(parameter.unit) };
    Description {
        text: parameter.text.to_owned(),
        range: ValueRange { minimum, maximum, unit },
        whole: parameter.integer,
        names,
        bits: parameter.bits,
        group: "Vehicle",
        needs_restart: false,
        read_only: false,
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

    /// Its bounds are 0.05 and 1.2 rad, in degrees 2.8648 and 68.7549: what is named is allowed.
    #[test]
    fn a_bound_in_another_unit_has_few_digits_and_is_allowed() {
        let table = ParameterTable::new(Identity::Px4);
        assert_eq!(table.find("MPC_TILTMAX_AIR").expect("there").allowed(), "2.865–68.75 deg");
        assert_eq!(table.find("LIM_TILT").expect("there").allowed(), "0.05–1.2 rad (3°–69°)");
    }
}
