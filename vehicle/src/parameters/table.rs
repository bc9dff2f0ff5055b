//! All parameters in their order, and changing one.

use quadrotor::{ConfigurationError, PARAMETERS, Parameter};

use super::ardupilot_parameters::{ARDUPILOT_PARAMETERS, REPLACED};
use super::entry::{Entry, Source};
use super::identifier::identifier;
use super::loop_access::write;
use super::{CONDUCT_PARAMETERS, ConductParameter, Encoding, Speed, Value};
use crate::identity::Identity;
use crate::vehicle::Vehicle;

/// Dotted names that describe the start of a flight, not the vehicle: they are set by the command line.
const NOT_THE_VEHICLE: [&str; 3] = ["initial.", "environment.", "reference."];

/// Identifier of the pace of simulation time.
pub const SPEED_PARAMETER: &str = "SIM_SPEEDUP";

/// What the parameters are parameters of.
#[derive(Debug)]
pub struct Host<'a> {
    /// The vehicle.
    pub vehicle: &'a mut Vehicle,
    /// Its system id.
    pub system_id: u8,
    /// The pace of its time.
    pub speed: &'a mut Speed,
}

impl Host<'_> {
    /// Only to be read.
    pub fn view(&self) -> View<'_> {
        View { vehicle: self.vehicle, system_id: self.system_id, speed: *self.speed }
    }
}

/// What the parameters are read from.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The vehicle.
    pub vehicle: &'a Vehicle,
    /// Its system id.
    pub system_id: u8,
    /// The pace of its time.
    pub speed: Speed,
}

/// Why a parameter was not changed. Nothing has changed then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SetError {
    /// There is none of this name.
    #[error("there is no parameter {0}")]
    Unknown(String),
    /// The value is no number that it can have.
    #[error("{id} = {value} is outside [{minimum}, {maximum}]")]
    OutOfRange {
        /// Identifier.
        id: String,
        /// Given value.
        value: f64,
        /// Smallest allowed value.
        minimum: f64,
        /// Largest allowed value.
        maximum: f64,
    },
    /// The value is none of those that mean something.
    #[error("{id} = {value} has no meaning here: {meanings}")]
    Meaningless {
        /// Identifier.
        id: String,
        /// Given value.
        value: f64,
        /// Those that mean something, in words.
        meanings: String,
    },
    /// It is fixed since the start.
    #[error("{0} is set by the command line")]
    ReadOnly(String),
    /// It can only change while the vehicle is disarmed on the ground.
    #[error("{0} is fixed while armed")]
    Armed(String),
    /// The closed loop refuses it.
    #[error("{id}: {source}")]
    Refused {
        /// Identifier.
        id: String,
        /// Why.
        source: Box<ConfigurationError>,
    },
}

/// All parameters, in alphabetical order: the order of their indices.
#[derive(Clone, Debug)]
pub struct ParameterTable {
    entries: Vec<Entry>,
    encoding: Encoding,
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
        let others = [
            Entry { id: system.to_owned(), source: Source::SystemId },
            Entry { id: SPEED_PARAMETER.to_owned(), source: Source::Speed },
        ];
        let mut entries: Vec<Entry> = of_loop.chain(of_conduct).chain(others).collect();
        entries.sort_by(|one, other| one.id.cmp(&other.id));
        Self { entries, encoding: if ardupilot { Encoding::Cast } else { Encoding::Bytewise } }
    }

    /// How integers travel.
    pub fn encoding(&self) -> Encoding {
        self.encoding
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
    pub fn value(&self, index: usize, view: &View<'_>) -> Option<Value> {
        Some(self.entries.get(index)?.value(view))
    }

    /// PX4's hash over names and values: CRC-32 (IEEE, reflected) that begins with zero and is not inverted.
    pub fn hash(&self, view: &View<'_>) -> u32 {
        let mut hasher = crc32fast::Hasher::new_with_initial(u32::MAX);
        for entry in &self.entries {
            hasher.update(entry.id.as_bytes());
            hasher.update(&entry.value(view).bytes());
        }
        !hasher.finalize()
    }

    /// Changes a parameter. A value that is the present one, in the precision of the protocol, changes nothing.
    ///
    /// # Errors
    /// [`SetError`]; nothing has changed then.
    pub fn set(&self, id: &str, value: f64, host: &mut Host<'_>) -> Result<(), SetError> {
        let index = self.index_of(id).ok_or_else(|| SetError::Unknown(id.to_owned()))?;
        let Some(entry) = self.entries.get(index) else { return Err(SetError::Unknown(id.to_owned())) };
        let present = entry.value(&host.view());
        let same = match present {
            Value::Real(present) => present == value as f32,
            Value::Integer(present) => f64::from(present) == value,
        };
        if same {
            return Ok(());
        }
        match entry.source {
            Source::Loop(parameter) => set_loop(id, parameter, value, host.vehicle),
            Source::Conduct(parameter, scale) => set_conduct(entry, parameter, value, scale, host.vehicle),
            Source::SystemId => Err(SetError::ReadOnly(id.to_owned())),
            Source::Speed => {
                *host.speed = Speed::from_parameter(value).ok_or_else(|| SetError::OutOfRange {
                    id: id.to_owned(),
                    value,
                    minimum: -1.0,
                    maximum: 1000.0,
                })?;
                Ok(())
            }
        }
    }
}

fn set_loop(id: &str, parameter: &Parameter, value: f64, vehicle: &mut Vehicle) -> Result<(), SetError> {
    let mut configuration = vehicle.kept_configuration();
    write(id, parameter, value, &mut configuration)?;
    vehicle.reconfigure(&configuration).map_err(|source| match source {
        ConfigurationError::Fixed { .. } => SetError::Armed(id.to_owned()),
        source => SetError::Refused { id: id.to_owned(), source: Box::new(source) },
    })
}

fn set_conduct(
    entry: &Entry,
    parameter: &ConductParameter,
    value: f64,
    scale: f64,
    vehicle: &mut Vehicle,
) -> Result<(), SetError> {
    let (minimum, maximum) = (parameter.minimum * scale, parameter.maximum * scale);
    let mut conduct = *vehicle.conduct();
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
    vehicle.set_conduct(conduct);
    Ok(())
}
