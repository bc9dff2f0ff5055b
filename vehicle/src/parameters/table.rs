//! All parameters in their order: reading and writing them.

use quadrotor::{PARAMETERS, Parameter};

use super::ardupilot_parameters::{ARDUPILOT_PARAMETERS, REPLACED};
use super::entry::{Entry, Source};
use super::identifier::identifier;
use super::loop_access::write;
use super::{CONDUCT_PARAMETERS, ConductParameter, ParameterValues, SetError, Speed, Value};
use crate::identity::Identity;
use crate::vehicle::Conduct;

/// Dotted names that describe the start of a flight, not the vehicle: they are set by the command line.
const NOT_THE_VEHICLE: [&str; 3] = ["initial.", "environment.", "reference."];

/// Identifier of the pace of simulation time.
pub const SPEED_PARAMETER: &str = "SIM_SPEEDUP";

/// What a parameter that was set belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Nothing has changed: it has the value already, in single precision.
    Nothing,
    /// The closed loop.
    ClosedLoop,
    /// The vehicle's behaviour.
    Conduct,
    /// The pace of its time.
    Speed,
}

/// All parameters, in alphabetical order: the order of their indices.
#[derive(Clone, Debug)]
pub struct ParameterTable {
    entries: Vec<Entry>,
}

impl ParameterTable {
    /// The table in the terms of an identity.
    pub fn new(identity: Identity) -> Self {
        let ardupilot = identity.is_ardupilot();
        let described =
            |parameter: &&Parameter| !NOT_THE_VEHICLE.iter().any(|prefix| parameter.name.starts_with(prefix));
        let of_loop = PARAMETERS
            .iter()
            .filter(described)
            .map(|parameter| Entry { id: identifier(parameter.name), source: Source::Loop(parameter) });
        let replaced = |parameter: &&ConductParameter| !ardupilot || !REPLACED.contains(&parameter.id);
        let own = if ardupilot { ARDUPILOT_PARAMETERS } else { &[] };
        let of_conduct = CONDUCT_PARAMETERS.iter().filter(replaced).chain(own).map(|parameter| {
            let (id, scale) = parameter.ardupilot.filter(|_| ardupilot).unwrap_or((parameter.id, 1.0));
            Entry { id: id.to_owned(), source: Source::Conduct(parameter, scale) }
        });
        let system = if ardupilot { "SYSID_THISMAV" } else { "MAV_SYS_ID" };
        let hover = if ardupilot { "MOT_THST_HOVER" } else { "MPC_THR_HOVER" };
        let others = [
            Entry { id: hover.to_owned(), source: Source::HoverThrust },
            Entry { id: system.to_owned(), source: Source::SystemId },
            Entry { id: SPEED_PARAMETER.to_owned(), source: Source::Speed },
        ];
        let mut entries: Vec<Entry> = of_loop.chain(of_conduct).chain(others).collect();
        entries.sort_by(|one, other| one.id.cmp(&other.id));
        Self { entries }
    }

    /// The parameters in order.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Position of an identifier.
    pub fn index_of(&self, id: &str) -> Option<usize> {
        self.entries.binary_search_by(|entry| entry.id.as_str().cmp(id)).ok()
    }

    /// Value of the parameter at a position.
    pub fn value(&self, index: usize, values: &ParameterValues) -> Option<Value> {
        Some(self.entries.get(index)?.value(values))
    }

    /// All parameters with their values, in order.
    pub fn values(&self, values: ParameterValues) -> impl Iterator<Item = (&str, Value)> {
        self.entries.iter().map(move |entry| (entry.id.as_str(), entry.value(&values)))
    }

    /// Writes a parameter into the values, after a check of its own range. Whether all of them fit together is for
    /// [`ParameterValues::check`] to say, or for the vehicle that takes them over.
    ///
    /// # Errors
    /// [`SetError`]; nothing has changed then.
    pub fn set(&self, id: &str, value: f64, values: &mut ParameterValues) -> Result<Change, SetError> {
        let entry = self.index_of(id).and_then(|index| self.entries.get(index));
        let entry = entry.ok_or_else(|| SetError::Unknown(id.to_owned()))?;
        let same = match entry.value(values) {
            Value::Real(present) => present == value as f32,
            Value::Integer(present) => f64::from(present) == value,
        };
        if same {
            return Ok(Change::Nothing);
        }
        match entry.source {
            Source::Loop(parameter) => {
                write(id, parameter, value, &mut values.configuration)?;
                Ok(Change::ClosedLoop)
            }
            Source::Conduct(parameter, scale) => {
                set_conduct(entry, parameter, value, scale, &mut values.conduct)?;
                Ok(Change::Conduct)
            }
            Source::SystemId => Err(SetError::ReadOnly(id.to_owned())),
            Source::HoverThrust => Err(SetError::Calculated(id.to_owned())),
            Source::Speed => {
                values.speed = Speed::from_parameter(value).ok_or_else(|| SetError::OutOfRange {
                    id: id.to_owned(),
                    value,
                    minimum: -1.0,
                    maximum: 1000.0,
                })?;
                Ok(Change::Speed)
            }
        }
    }

    /// As [`set`](Self::set), for a vehicle that is still to be made: the closed loop must be able to fly the values.
    ///
    /// # Errors
    /// [`SetError`]; nothing has changed then.
    pub fn set_checked(
        &self,
        id: &str,
        value: f64,
        values: &mut ParameterValues,
    ) -> Result<Change, SetError> {
        let mut changed = *values;
        let change = self.set(id, value, &mut changed)?;
        if change == Change::ClosedLoop {
            changed.check().map_err(|source| SetError::refused(id, source))?;
        }
        *values = changed;
        Ok(change)
    }
}

fn set_conduct(
    entry: &Entry,
    parameter: &ConductParameter,
    value: f64,
    scale: f64,
    into: &mut Conduct,
) -> Result<(), SetError> {
    let (minimum, maximum) = (parameter.minimum * scale, parameter.maximum * scale);
    let mut conduct = *into;
    // NaN is in no range.
    if !(minimum..=maximum).contains(&value) || !(parameter.set)(&mut conduct, value / scale) {
        let id = entry.id.clone();
        let names = entry.describe().names;
        if names.is_empty() {
            return Err(SetError::OutOfRange { id, value, minimum, maximum });
        }
        let meanings: Vec<_> = names.into_iter().map(|(value, name)| format!("{value} {name}")).collect();
        return Err(SetError::Meaningless { id, value, meanings: meanings.join(", ") });
    }
    *into = conduct;
    Ok(())
}

#[cfg(test)]
mod tests {
    use quadrotor::Configuration;

    use super::{Change, ParameterTable};
    use crate::identity::Identity;
    use crate::parameters::{ParameterValues, SetError, Speed, Value, parse, render};
    use crate::vehicle::Conduct;

    fn defaults() -> (ParameterTable, ParameterValues) {
        let (configuration, conduct) = (Configuration::default(), Conduct::new(false));
        let values = ParameterValues { configuration, conduct, system_id: 7, speed: Speed::Factor(1.0) };
        (ParameterTable::new(Identity::Px4), values)
    }

    #[test]
    fn what_is_set_is_read_again_and_a_refusal_changes_nothing() {
        let (table, mut values) = defaults();
        for (id, value, expected) in [
            ("AF_MASS", 0.8, Ok(Change::ClosedLoop)),
            ("AF_MASS", f64::from(0.8_f32), Ok(Change::Nothing)),
            ("MIS_TAKEOFF_ALT", 4.0, Ok(Change::Conduct)),
            ("SIM_SPEEDUP", 5.0, Ok(Change::Speed)),
            ("MAV_SYS_ID", 7.0, Ok(Change::Nothing)),
            ("MAV_SYS_ID", 8.0, Err(())),
            ("MPC_THR_HOVER", 0.5, Err(())),
            ("SIM_SPEEDUP", -2.0, Err(())),
            ("AF_MASS", f64::NAN, Err(())),
            ("COM_OBL_RC_ACT", 1.0, Err(())),
            ("NO_SUCH", 1.0, Err(())),
        ] {
            let before = values;
            assert_eq!(table.set(id, value, &mut values).map_err(|_| ()), expected, "{id} = {value}");
            match table.index_of(id).and_then(|index| table.value(index, &values)).map(Value::number) {
                Some(present) if expected.is_ok() => assert!((present - value).abs() < 1e-6, "{id}"),
                _ => assert_eq!(values, before, "{id} = {value}"),
            }
        }
    }

    /// More mass needs stronger rotors, in whichever order a file has them.
    #[test]
    fn values_that_only_fit_together_come_in_any_order() {
        let (table, start) = defaults();
        let index = table.index_of("AF_ROT_K1").expect("there");
        let k1 = table.value(index, &start).expect("there").number();
        let (heavy, strong) = ("AF_MASS 5", format!("AF_ROT_K1 {}", 8.0 * k1));
        let mut values = start;
        assert_eq!(table.set("AF_MASS", 5.0, &mut values.clone()), Ok(Change::ClosedLoop));
        let refused = table.set_checked("AF_MASS", 5.0, &mut values).expect_err("too heavy");
        assert!(matches!(&refused, SetError::Refused { id, .. } if id == "AF_MASS"), "{refused}");
        assert_eq!(values, start);
        for text in [format!("{heavy}\n{strong}"), format!("{strong}\n{heavy}")] {
            let mut values = start;
            parse(&text, &table, &mut values).expect("both");
            assert_eq!(values.configuration.airframe.mass_kg, 5.0);
            let mut again = start;
            parse(&render(&table, &values), &table, &mut again).expect("what was written");
            assert_eq!(render(&table, &again), render(&table, &values));
        }
        assert!(
            parse(heavy, &table, &mut values).expect_err("alone").to_string().starts_with("line 1: AF_MASS")
        );
    }
}
