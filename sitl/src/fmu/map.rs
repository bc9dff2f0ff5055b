//! `--map FILE`: our names and an FMU's, its axes and its start values.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use quadrotor::{PARAMETERS, nearest_name};
use toml::Spanned;
use toml::de::{DeTable, DeValue};
use vehicle::foreign::ForeignRole;

use super::axes::Axes;
use super::signals::{ARMED, names};
use crate::configuration::read_text;
use crate::failure::Failure;

/// Keys that stand above the first table, and tables.
const KEYS: [&str; 6] = ["role", "frame", "preload", "step_timeout", "variables", "parameters"];

/// Longest time of a step unless the map has another, s.
const STEP_TIMEOUT_S: f64 = 5.0;

/// What one of our names stands for.
#[derive(Clone, Debug, PartialEq)]
pub enum Entry {
    /// A variable, with ours = factor · theirs + offset in SI units.
    Variable {
        /// Its name.
        name: String,
        /// The factor.
        factor: f64,
        /// The offset.
        offset: f64,
        /// Its unit, if it is another than the FMU says, or the FMU says none.
        unit: Option<String>,
    },
    /// A constant in SI units.
    Constant(f64),
    /// Nothing, although the FMU has a variable of this name.
    Nothing,
}

/// A start value, as it was written.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// True or false.
    Boolean(bool),
    /// A text, or the name of an enumeration's item.
    Text(String),
}

/// What a map says, or nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// What the FMU is in place of, if that is said.
    pub role: Option<ForeignRole>,
    /// Its axes.
    pub axes: Axes,
    /// Our names.
    pub entries: BTreeMap<String, Entry>,
    /// Its own names, with start values.
    pub parameters: BTreeMap<String, Value>,
    /// Libraries that it needs to be loaded before it.
    pub preload: Vec<PathBuf>,
    /// Longest time of a step, s.
    pub step_timeout_s: f64,
}

impl Default for Map {
    fn default() -> Self {
        Self {
            role: None,
            axes: Axes::default(),
            entries: BTreeMap::new(),
            parameters: BTreeMap::new(),
            preload: Vec::new(),
            step_timeout_s: STEP_TIMEOUT_S,
        }
    }
}

impl Map {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Failure::File`], or [`Failure::Content`] with the line that is wrong.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = read_text(path)?;
        Self::parse(&text).map_err(|reason| Failure::Content { path: path.to_owned(), reason })
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// What is wrong in which line, and what is allowed.
    pub fn parse(text: &str) -> Result<Self, String> {
        let table = DeTable::parse(text).map_err(|error| {
            let reason = error.message().lines().collect::<Vec<_>>().join(" ");
            at(text, error.span().map_or(0, |span| span.start), &reason)
        })?;
        let mut map = Self::default();
        for (key, value) in table.get_ref() {
            let place = |reason: String| at(text, value.span().start, &reason);
            match key.get_ref().as_ref() {
                "role" => map.role = Some(role(value.get_ref()).map_err(place)?),
                "frame" => map.axes = axes(value.get_ref()).map_err(place)?,
                "preload" => map.preload = paths(value.get_ref()).map_err(place)?,
                "step_timeout" => map.step_timeout_s = timeout_s(value.get_ref()).map_err(place)?,
                "variables" => {
                    let table = value.get_ref().as_table().ok_or("it is a table: [variables]".to_owned());
                    map.entries(text, "", table.map_err(place)?)?;
                }
                "parameters" => {
                    let table = value.get_ref().as_table().ok_or("it is a table: [parameters]".to_owned());
                    map.parameters(text, "", table.map_err(place)?)?;
                }
                name => {
                    let meant = nearest_name(name, KEYS).map(|meant| format!("; did you mean {meant}?"));
                    let meant = meant.unwrap_or_else(|| format!("; allowed are {}", KEYS.join(", ")));
                    return Err(place(format!("unknown key `{name}`{meant}")));
                }
            }
        }
        Ok(map)
    }

    /// Entries of `[variables]`; tables are parts of names.
    fn entries(&mut self, text: &str, prefix: &str, table: &DeTable<'_>) -> Result<(), String> {
        for (key, value) in table {
            let name = dotted(prefix, key.get_ref());
            let place = |reason: String| at(text, value.span().start, &reason);
            match value.get_ref() {
                DeValue::Table(inner) if !is_signal(&name) && !inner.contains_key("variable") => {
                    self.entries(text, &name, inner)?;
                }
                given => {
                    misplaced(&name, "variables").map_err(place)?;
                    let entry = known(&name).and_then(|()| entry(&name, given)).map_err(place)?;
                    if self.entries.insert(name.clone(), entry).is_some() {
                        return Err(place(format!("{name} is mapped twice; keep only one of them")));
                    }
                }
            }
        }
        Ok(())
    }

    /// Entries of `[parameters]`; tables are parts of names.
    fn parameters(&mut self, text: &str, prefix: &str, table: &DeTable<'_>) -> Result<(), String> {
        for (key, value) in table {
            let name = dotted(prefix, key.get_ref());
            let place = |reason: String| at(text, value.span().start, &reason);
            let parsed = match value.get_ref() {
                DeValue::Table(inner) => {
                    self.parameters(text, &name, inner)?;
                    continue;
                }
                DeValue::Array(_) => {
                    misplaced(&name, "parameters").map_err(place)?;
                    return Err(place(format!("{name} must be a number, true, false or a text in quotes")));
                }
                DeValue::Boolean(value) => Value::Boolean(*value),
                DeValue::String(value) => Value::Text(value.to_string()),
                other => match number(other) {
                    Some(value) => Value::Number(value),
                    None => {
                        return Err(place(format!(
                            "{name} must be a number, true, false or a text in quotes"
                        )));
                    }
                },
            };
            if self.parameters.insert(name.clone(), parsed).is_some() {
                return Err(place(format!("{name} is set twice; keep only one of them")));
            }
        }
        Ok(())
    }
}

fn dotted(prefix: &str, key: &str) -> String {
    if prefix.is_empty() { key.to_owned() } else { format!("{prefix}.{key}") }
}

/// Whether one of our signals or parameters has this name.
fn is_signal(name: &str) -> bool {
    names().any(|signal| signal == name) || PARAMETERS.iter().any(|parameter| parameter.name == name)
}

/// Refuses a key of the whole map inside of a table: in TOML a key belongs to the table above it.
fn misplaced(name: &str, table: &str) -> Result<(), String> {
    if !KEYS.contains(&name) {
        return Ok(());
    }
    Err(format!("{name} stands below [{table}] and belongs to it; move this line above the first [table]"))
}

/// Refuses a name that is not ours.
fn known(name: &str) -> Result<(), String> {
    if is_signal(name) {
        return Ok(());
    }
    let signals: Vec<String> = names().collect();
    let parts: Vec<&str> = signals
        .iter()
        .filter(|signal| signal.strip_prefix(name).is_some_and(|rest| rest.starts_with('.')))
        .map(String::as_str)
        .collect();
    if !parts.is_empty() {
        return Err(format!("{name} has several parts; map each of them: {}", parts.join(", ")));
    }
    let parameters = PARAMETERS.iter().map(|parameter| parameter.name);
    Err(match nearest_name(name, signals.iter().map(String::as_str).chain(parameters)) {
        Some(meant) => format!("unknown name {name}; did you mean {meant}?"),
        None => format!(
            "unknown name {name}; the left side is one of our names, such as position.x or {ARMED}: see --fmu-check"
        ),
    })
}

fn entry(name: &str, value: &DeValue<'_>) -> Result<Entry, String> {
    let wrong = || {
        format!(
            "{name} is the name of a variable, {{ variable = \"NAME\", factor = 1, offset = 0, unit = \"UNIT\" }}, a constant, or \
             false for nothing"
        )
    };
    match value {
        DeValue::String(variable) => {
            Ok(Entry::Variable { name: variable.to_string(), factor: 1.0, offset: 0.0, unit: None })
        }
        DeValue::Boolean(false) => Ok(Entry::Nothing),
        DeValue::Table(table) => {
            let (mut variable, mut factor, mut offset, mut unit) = (None, 1.0, 0.0, None);
            for (key, value) in table {
                match (key.get_ref().as_ref(), value.get_ref()) {
                    ("variable", DeValue::String(name)) => variable = Some(name.to_string()),
                    ("unit", DeValue::String(name)) => unit = Some(name.to_string()),
                    ("factor", value) => {
                        factor = number(value).filter(|factor| *factor != 0.0).ok_or_else(wrong)?
                    }
                    ("offset", value) => offset = number(value).ok_or_else(wrong)?,
                    _ => return Err(wrong()),
                }
            }
            let lacks = || format!("{name} lacks the name of a variable: {name} = {{ variable = \"NAME\" }}");
            let name = variable.ok_or_else(lacks)?;
            Ok(Entry::Variable { name, factor, offset, unit })
        }
        other => number(other).map(Entry::Constant).ok_or_else(wrong),
    }
}

fn role(value: &DeValue<'_>) -> Result<ForeignRole, String> {
    match value.as_str() {
        Some("closed-loop") => Ok(ForeignRole::ClosedLoop),
        Some("plant") => Ok(ForeignRole::Plant),
        _ => Err("role is \"closed-loop\" or \"plant\"".to_owned()),
    }
}

fn axes(value: &DeValue<'_>) -> Result<Axes, String> {
    const ALLOWED: &str = "frame has world = \"NED\", body = \"FRD\" and origin = [0, 0, 0], in m";
    let table = value.as_table().ok_or_else(|| ALLOWED.to_owned())?;
    let (mut world, mut body, mut origin_m) = ("NED".to_owned(), "FRD".to_owned(), [0.0; 3]);
    for (key, value) in table {
        match (key.get_ref().as_ref(), value.get_ref()) {
            ("world", DeValue::String(letters)) => world = letters.to_string(),
            ("body", DeValue::String(letters)) => body = letters.to_string(),
            ("origin", DeValue::Array(values)) => {
                let values: Option<Vec<f64>> = values.iter().map(|value| number(value.get_ref())).collect();
                origin_m =
                    values.and_then(|values| values.try_into().ok()).ok_or_else(|| ALLOWED.to_owned())?;
            }
            (key, _) => {
                misplaced(key, "frame")?;
                return Err(ALLOWED.to_owned());
            }
        }
    }
    Axes::new(&world, &body, origin_m)
}

fn paths(value: &DeValue<'_>) -> Result<Vec<PathBuf>, String> {
    let path = |value: &Spanned<DeValue<'_>>| value.get_ref().as_str().map(PathBuf::from);
    let paths = value.as_array().and_then(|values| values.iter().map(path).collect());
    paths.ok_or_else(|| "preload is a list of libraries: [\"libpython3.11.so.1.0\"]".to_owned())
}

fn timeout_s(value: &DeValue<'_>) -> Result<f64, String> {
    let allowed = || "step_timeout is a time from 0.01 to 3600 s".to_owned();
    number(value).filter(|seconds| (0.01..=3600.0).contains(seconds)).ok_or_else(allowed)
}

/// A finite number.
fn number(value: &DeValue<'_>) -> Option<f64> {
    let text = match value {
        DeValue::Float(number) => number.to_string(),
        DeValue::Integer(number) => number.to_string(),
        _ => return None,
    };
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// The line of a place in the text, its content, and what is wrong with it.
fn at(text: &str, start: usize, reason: &str) -> String {
    let line = text.get(..start).unwrap_or_default().matches('\n').count();
    let content = text.lines().nth(line).unwrap_or_default().trim();
    format!("line {}, `{content}`: {reason}", line + 1)
}

#[cfg(test)]
mod tests {
    use vehicle::foreign::ForeignRole;

    use super::{Axes, Entry, Map, Value};

    #[test]
    fn a_map_is_read_as_a_person_writes_it() {
        let text = "role = \"plant\"\nstep_timeout = 2\npreload = [\"libpython3.11.so\"]\n\
            [frame]\nworld = \"ENU\"\nbody = \"FLU\"\norigin = [0, 0, 0.1]\n\
            [variables]\nposition.x = \"pos.x\"\nattitude.phi = 0.0\nwind.velocity.x = false\n\
            thrust = { variable = \"F\", factor = -1, unit = \"N\" }\nairframe.mass = \"m\"\n\
            [parameters]\nnested.gain = 3\n\"my mode\" = \"fast\"\non = true\n";
        let map = Map::parse(text).expect("a map");
        assert_eq!(map.role, Some(ForeignRole::Plant));
        assert_eq!(map.axes, Axes::new("ENU", "FLU", [0.0, 0.0, 0.1]).expect("axes"));
        assert_eq!((map.step_timeout_s, map.preload.len()), (2.0, 1));
        let variable = |name: &str, factor, unit: Option<&str>| Entry::Variable {
            name: name.to_owned(),
            factor,
            offset: 0.0,
            unit: unit.map(str::to_owned),
        };
        assert_eq!(map.entries["position.x"], variable("pos.x", 1.0, None));
        assert_eq!(map.entries["thrust"], variable("F", -1.0, Some("N")));
        assert_eq!(map.entries["airframe.mass"], variable("m", 1.0, None));
        assert_eq!(map.entries["attitude.phi"], Entry::Constant(0.0));
        assert_eq!(map.entries["wind.velocity.x"], Entry::Nothing);
        assert_eq!(map.parameters["nested.gain"], Value::Number(3.0));
        assert_eq!(map.parameters["my mode"], Value::Text("fast".to_owned()));
        assert_eq!(map.parameters["on"], Value::Boolean(true));
        assert_eq!(Map::parse("").expect("a map"), Map::default());
    }

    #[test]
    fn mistakes_are_named_with_their_line_and_what_is_allowed() {
        for (text, expected) in [
            ("role = \"robot\"", "line 1, `role = \"robot\"`: role is \"closed-loop\" or \"plant\""),
            ("\nrolle = \"plant\"", "line 2, `rolle = \"plant\"`: unknown key `rolle`; did you mean role?"),
            (
                "[variables]\nposition.q = \"x\"",
                "line 2, `position.q = \"x\"`: unknown name position.q; did you mean position.",
            ),
            ("[variables]\nbanana = \"x\"", "unknown name banana; the left side is one of our names"),
            ("[variables]\nthrust = { variable = \"F\", factor = 0 }", "thrust is the name of a variable"),
            ("[variables]\nthrust = nan", "thrust is the name of a variable"),
            ("[variables]\nthrust = true", "thrust is the name of a variable"),
            ("[frame]\nworld = \"NEU\"", "world = \"NEU\"; allowed are three right-handed axes"),
            ("step_timeout = 0", "step_timeout is a time from 0.01 to 3600 s"),
            ("variables = 3", "it is a table: [variables]"),
            (
                "[parameters]\na = [1]",
                "line 2, `a = [1]`: a must be a number, true, false or a text in quotes",
            ),
            ("x = = 3", "line 1, `x = = 3`: "),
            (
                "[variables]\nthrust = \"F\"\npreload = [\"a.so\"]",
                "line 3, `preload = [\"a.so\"]`: preload stands below [variables] and belongs to it; move this line above the first",
            ),
            ("[parameters]\npreload = [\"a.so\"]", "preload stands below [parameters]"),
            ("[frame]\nworld = \"ENU\"\nstep_timeout = 3", "step_timeout stands below [frame]"),
            (
                "[variables]\nposition.x = \"a\"\n\"position.x\" = \"b\"",
                "position.x is mapped twice; keep only one of them",
            ),
            ("[parameters]\na.b = 1\n\"a.b\" = 2", "a.b is set twice; keep only one of them"),
            (
                "[variables]\nposition.x = \"a\"\nposition.x = \"b\"",
                "line 3, `position.x = \"b\"`: duplicate key",
            ),
            (
                "[variables]\nthrust = { unit = \"N\" }",
                "thrust lacks the name of a variable: thrust = { variable = \"NAME\" }",
            ),
            (
                "[variables]\nposition = \"r\"",
                "position has several parts; map each of them: position.x, position.y, position.z",
            ),
        ] {
            let reason = Map::parse(text).expect_err(text);
            assert!(reason.contains(expected) && !reason.contains('\n'), "{text}: {reason}");
        }
    }
}
