//! All parameters in their order: reading and writing them.

use std::sync::OnceLock;

use quadrotor::{Access, Configuration, PARAMETERS, Parameter};

use super::ardupilot_parameters::ARDUPILOT_PARAMETERS;
use super::entry::{Entry, Source};
use super::equipment_parameters::equipment_parameters;
use super::limit_names::{LIMIT_NAMES, LimitName};
use super::loop_access::write;
use super::loop_names::loop_name;
use super::mode_parameters::{ARDUPILOT_MODE_PARAMETERS, PX4_MODE_PARAMETERS};
use super::px4_parameters::PX4_PARAMETERS;
use super::radio_parameters::radio_parameters;
use super::simulation_parameters::{PX4_WIND_PARAMETERS, SIMULATION_PARAMETERS, WIND_PARAMETERS};
use super::source_parameters::SOURCE_PARAMETERS;
use super::speed_parameters::{SPEED_PARAMETERS, settle};
use super::stream_rate_parameters::STREAM_RATE_PARAMETERS;
use super::suggestion::suggestion;
use super::surroundings_parameters::{ARDUPILOT_SURROUNDINGS, PX4_SURROUNDINGS};
use super::value::within;
use super::{
    CONDUCT_PARAMETERS, ConductParameter, ParameterValues, SetError, Speed, Statistic, Statistics, Value,
};
use crate::identity::Identity;
use crate::kept::{KeptParameter, Owner, kept_parameters};
use crate::vehicle::Conduct;

/// Name of the pace of simulation time.
pub const SPEED_PARAMETER: &str = "SIM_SPEEDUP";

/// The most that values beyond their range may be, in our units.
const FARTHEST: f64 = 1e6;

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
    /// What it counts begins anew.
    Statistics,
    /// How often it has booted.
    Boots,
}

/// All parameters, in alphabetical order: the order of their indices.
#[derive(Clone, Copy, Debug)]
pub struct ParameterTable {
    /// There are many of them. They are made once, for all vehicles of a program.
    entries: &'static [Entry],
    is_ardupilot: bool,
}

impl ParameterTable {
    /// The table in the terms of an identity.
    pub fn new(identity: Identity) -> Self {
        static OF_PX4: OnceLock<Vec<Entry>> = OnceLock::new();
        static OF_ARDUPILOT: OnceLock<Vec<Entry>> = OnceLock::new();
        static OF_NOBODY: OnceLock<Vec<Entry>> = OnceLock::new();
        let known = match identity {
            Identity::Px4 => &OF_PX4,
            Identity::ArduPilot => &OF_ARDUPILOT,
            Identity::Generic => &OF_NOBODY,
        };
        let entries = known.get_or_init(|| Self::entries_of(identity));
        Self { entries, is_ardupilot: identity.is_ardupilot() }
    }

    /// All parameters of an identity, in order.
    fn entries_of(identity: Identity) -> Vec<Entry> {
        let ardupilot = identity.is_ardupilot();
        let of_loop = PARAMETERS
            .iter()
            .filter_map(|parameter| Some(Entry::of_loop(loop_name(parameter.name)?, parameter)));
        let owner = if ardupilot { Owner::ArduPilot } else { Owner::Px4 };
        let kept = kept_parameters().filter(|(_, parameter)| parameter.owner == owner);
        let kept = kept.map(|(place, parameter)| Entry::new(parameter.id, Source::Kept(parameter, place)));
        let system = if ardupilot { "SYSID_THISMAV" } else { "MAV_SYS_ID" };
        let hover = if ardupilot { "MOT_THST_HOVER" } else { "MPC_THR_HOVER" };
        // ArduPilot's new name.
        let also = ardupilot.then(|| Entry::new("MAV_SYSID", Source::SystemId));
        let others = [
            Entry::new(hover, Source::HoverThrust),
            Entry::new(system, Source::SystemId),
            Entry::new(SPEED_PARAMETER, Source::Speed),
        ];
        let counted = if ardupilot { &Statistic::ALL[..] } else { &[] };
        let of_statistics =
            counted.iter().map(|(id, statistic)| Entry::new(id, Source::Statistic(*statistic)));
        let mut entries: Vec<Entry> = of_loop
            .chain(of_conduct(identity))
            .chain(of_limits(ardupilot))
            .chain(of_speeds(ardupilot))
            .chain(kept)
            .chain(others)
            .chain(also)
            .chain(of_statistics)
            .collect();
        entries.sort_by_key(|entry| entry.id);
        entries
    }

    /// The parameters in order.
    pub fn entries(&self) -> &'static [Entry] {
        self.entries
    }

    /// Position of a parameter by its MAVLink name, its former one or its dotted one.
    pub fn index_of(&self, name: &str) -> Option<usize> {
        let present = self.entries.binary_search_by(|entry| entry.id.cmp(name)).ok();
        present.or_else(|| self.entries.iter().position(|entry| entry.has_name(name)))
    }

    /// A parameter by any of its names.
    pub fn find(&self, name: &str) -> Option<&Entry> {
        self.entries.get(self.index_of(name)?)
    }

    /// A parameter by any of its names.
    ///
    /// # Errors
    /// [`SetError::Unknown`] with the name that may be meant.
    pub fn require(&self, name: &str) -> Result<&Entry, SetError> {
        let unknown = || SetError::Unknown { name: name.to_owned(), similar: suggestion(name, self.entries) };
        self.find(name).ok_or_else(unknown)
    }

    /// Value of the parameter at a position.
    pub fn value(&self, index: usize, values: &ParameterValues) -> Option<Value> {
        Some(self.entries.get(index)?.value(values))
    }

    /// All parameters with their values, in order.
    pub fn values(&self, values: ParameterValues) -> impl Iterator<Item = (&'static str, Value)> {
        self.entries.iter().map(move |entry| (entry.id, entry.value(&values)))
    }

    /// Writes a parameter, by any of its names, into the values, after a check of its own range. Whether all of them fit
    /// together is for [`ParameterValues::check`] to say, or for the vehicle that takes them over.
    ///
    /// # Errors
    /// [`SetError`]; nothing has changed then.
    pub fn set(&self, name: &str, value: f64, values: &mut ParameterValues) -> Result<Change, SetError> {
        let entry = self.require(name)?;
        let same = match entry.value(values) {
            Value::Real(present) => present == value as f32,
            Value::Integer(present) => f64::from(present) == value,
        };
        if same {
            return Ok(Change::Nothing);
        }
        let change = match entry.source {
            Source::Loop(parameter) => {
                write(parameter, value, &mut values.configuration).map(|()| Change::ClosedLoop)
            }
            Source::Conduct(parameter, scale) => {
                let is_open = self.is_ardupilot && is_open(parameter);
                set_conduct(parameter, value, scale, is_open, &mut values.conduct).map(|()| Change::Conduct)
            }
            Source::Alias(_, parameter, scale) => {
                set_alias(parameter, value, scale, &mut values.configuration).map(|()| Change::ClosedLoop)
            }
            Source::BoundSpeed(parameter) => {
                within(parameter.minimum, parameter.maximum, value).map(|value| {
                    parameter.set(value, &mut values.conduct);
                    Change::ClosedLoop
                })
            }
            Source::Kept(parameter, place) => {
                set_kept(parameter, place, value, &mut values.conduct).map(|()| Change::Conduct)
            }
            Source::SystemId => return Err(SetError::ReadOnly(name.to_owned())),
            Source::HoverThrust => return Err(SetError::Calculated(name.to_owned())),
            Source::Statistic(Statistic::Reset) => (value == 0.0).then(|| {
                values.statistics = Statistics::default();
                Change::Statistics
            }),
            Source::Statistic(Statistic::Boots) => {
                values.statistics.set_boots(value).then_some(Change::Boots)
            }
            Source::Statistic(_) => return Err(SetError::Counted(name.to_owned())),
            Source::Speed => Speed::from_parameter(value).map(|speed| {
                values.speed = speed;
                Change::Speed
            }),
        };
        if change.is_some() && !self.is_ardupilot {
            settle(values);
        }
        change.ok_or_else(|| SetError::NotAllowed {
            name: name.to_owned(),
            value: entry.describe().shown(value),
            allowed: entry.allowed(),
        })
    }

    /// As [`set`](Self::set), for a vehicle that is still to be made: the closed loop must be able to fly the values.
    ///
    /// # Errors
    /// [`SetError`]; nothing has changed then.
    pub fn set_checked(
        &self,
        name: &str,
        value: f64,
        values: &mut ParameterValues,
    ) -> Result<Change, SetError> {
        let mut changed = *values;
        let change = self.set(name, value, &mut changed)?;
        if change == Change::ClosedLoop {
            changed.check().map_err(|source| SetError::refused(name, source))?;
        }
        *values = changed;
        Ok(change)
    }

    /// Sets several parameters, name and value each, for a vehicle that is still to be made. They are judged as a whole, so that
    /// values which only fit together may come in any order.
    ///
    /// # Errors
    /// The place of the first setting that cannot be kept, and why; some of the others may be set then.
    pub fn set_together(
        &self,
        settings: &[(&str, f64)],
        values: &mut ParameterValues,
    ) -> Result<(), (usize, SetError)> {
        let mut together = *values;
        for (place, (name, value)) in settings.iter().enumerate() {
            self.set(name, *value, &mut together).map_err(|error| (place, error))?;
        }
        if together.configuration == values.configuration || together.check().is_ok() {
            *values = together;
            return Ok(());
        }
        // Not all of them: in turn, until none is accepted any more, to find out which one does not fit.
        let mut waiting: Vec<usize> = (0..settings.len()).collect();
        loop {
            let before = waiting.len();
            let mut first = None;
            waiting.retain(|place| {
                let set = settings.get(*place).map(|(name, value)| self.set_checked(name, *value, values));
                match set {
                    Some(Err(error)) => {
                        first.get_or_insert((*place, error));
                        true
                    }
                    _ => false,
                }
            });
            match first {
                None => return Ok(()),
                Some(error) if waiting.len() == before => return Err(error),
                Some(_) => {}
            }
        }
    }
}

/// Those of the vehicle's behaviour.
fn of_conduct(identity: Identity) -> impl Iterator<Item = Entry> {
    let ardupilot = identity.is_ardupilot();
    let simulated = if ardupilot { SIMULATION_PARAMETERS } else { &[] };
    let sources = if ardupilot { SOURCE_PARAMETERS } else { &[] };
    let rates = if ardupilot { STREAM_RATE_PARAMETERS } else { &[] };
    let own_wind = if ardupilot { &[] } else { PX4_WIND_PARAMETERS };
    let (own, of_modes, around) = if ardupilot {
        (ARDUPILOT_PARAMETERS, ARDUPILOT_MODE_PARAMETERS, ARDUPILOT_SURROUNDINGS)
    } else {
        (PX4_PARAMETERS, PX4_MODE_PARAMETERS, PX4_SURROUNDINGS)
    };
    CONDUCT_PARAMETERS
        .iter()
        .chain(own)
        .chain(of_modes)
        .chain(radio_parameters(ardupilot))
        .chain(around)
        .chain(simulated)
        .chain(sources)
        .chain(equipment_parameters().filter(move |_| ardupilot))
        .chain(rates.iter().flatten())
        .map(|parameter| (parameter, false))
        // PX4 keeps no wind in its files: each run has its own.
        .chain(WIND_PARAMETERS.iter().chain(own_wind).map(move |parameter| (parameter, !ardupilot)))
        .flat_map(move |(parameter, is_of_run)| {
            let names = parameter.names_in(identity);
            names.map(move |(id, scale, is_other)| Entry {
                is_other,
                is_of_run,
                ..Entry::new(id, Source::Conduct(parameter, scale))
            })
        })
}

/// PX4's speeds that are bound to one another.
fn of_speeds(ardupilot: bool) -> impl Iterator<Item = Entry> {
    let speeds = if ardupilot { &[] } else { SPEED_PARAMETERS };
    speeds.iter().map(|parameter| Entry::new(parameter.id, Source::BoundSpeed(parameter)))
}

/// The autopilots' names of limits that the closed loop has.
fn of_limits(ardupilot: bool) -> impl Iterator<Item = Entry> {
    let entries = move |name: &'static LimitName| {
        let parameter = PARAMETERS.iter().find(|parameter| parameter.name == name.dotted)?;
        let names = if ardupilot { name.ardupilot } else { name.px4 };
        Some(names.iter().map(move |(id, scale)| Entry {
            is_other: true,
            ..Entry::new(id, Source::Alias(name, parameter, *scale))
        }))
    };
    LIMIT_NAMES.iter().filter_map(entries).flatten()
}

/// `None` if the parameter cannot have the value; nothing has changed then.
fn set_conduct(
    parameter: &ConductParameter,
    value: f64,
    scale: f64,
    is_open: bool,
    into: &mut Conduct,
) -> Option<()> {
    let (minimum, maximum) = (parameter.minimum * scale, parameter.maximum * scale);
    let least = if minimum < 0.0 { -FARTHEST * scale } else { minimum };
    let beyond = || Some(value).filter(|value| is_open && (least..=FARTHEST * scale).contains(value));
    let value = within(minimum, maximum, value).or_else(beyond)?;
    let mut conduct = *into;
    (parameter.set)(&mut conduct, value / scale).then(|| *into = conduct)
}

/// Whether a value beyond the range means something, too: ArduPilot checks no ranges, and a longer way, time or a larger speed only asks for
/// more than the vehicle does.
fn is_open(parameter: &ConductParameter) -> bool {
    let is_measure = matches!(parameter.unit, "m" | "m/s" | "s");
    let is_flown = !parameter.id.starts_with("SIM_") && !parameter.id.starts_with("EK3_");
    is_measure && is_flown && !parameter.integer
}

/// `None` if the parameter cannot have the value; nothing has changed then. What rounds to a bound in the unit of the name is that bound.
fn set_alias(parameter: &Parameter, value: f64, scale: f64, into: &mut Configuration) -> Option<()> {
    let ends = match parameter.access {
        Access::Real { minimum, maximum, .. } => [minimum, maximum],
        _ => return None,
    };
    let bound = ends.into_iter().find(|end| (end * scale) as f32 == value as f32);
    write(parameter, bound.unwrap_or(value / scale), into)
}

/// `None` if the parameter cannot have the value; nothing has changed then.
fn set_kept(parameter: &KeptParameter, place: usize, value: f64, into: &mut Conduct) -> Option<()> {
    // ArduPilot checks no ranges, and rounds to whole numbers.
    if parameter.owner == Owner::ArduPilot && value.is_finite() {
        into.kept.set(place, if parameter.integer { value.round() } else { value } as f32);
        return Some(());
    }
    let value = within(parameter.minimum, parameter.maximum, value)?;
    if parameter.integer && value.fract() != 0.0 {
        return None;
    }
    into.kept.set(place, value as f32);
    Some(())
}

#[cfg(test)]
mod tests;
