//! The parameters of a running vehicle: their table, and what they are read from and written to.

use std::sync::OnceLock;

use vehicle::parameters::{
    Change, FileFormat, ParameterTable, ParameterValues, SetError, Speed, Statistics, Value,
};
use vehicle::plan::PlanKind;
use vehicle::{ChangeError, Refusal, Vehicle, VehicleSettings};

use crate::codec::parameter_hash;
use crate::parameter_metadata::ParameterMetadata;

/// All parameters, with those of their values that the vehicle does not keep.
#[derive(Debug)]
pub struct Parameters {
    table: ParameterTable,
    system_id: u8,
    speed: Speed,
    settings: VehicleSettings,
    initial: Vec<Value>,
    changed: bool,
    statistics: Statistics,
    /// Made when it is asked for first.
    metadata: OnceLock<ParameterMetadata>,
}

impl Parameters {
    /// The parameters of a vehicle that has just been made of `settings`.
    pub fn new(settings: &VehicleSettings, vehicle: &Vehicle, system_id: u8, speed: Speed) -> Self {
        let mut parameters = Self {
            table: ParameterTable::new(settings.identity),
            system_id,
            speed,
            settings: settings.clone(),
            initial: Vec::new(),
            changed: false,
            statistics: Statistics::default(),
            metadata: OnceLock::new(),
        };
        parameters.initial = parameters.all(vehicle).map(|(_, value)| value).collect();
        parameters
    }

    /// All of them in their order.
    pub fn table(&self) -> &ParameterTable {
        &self.table
    }

    /// System id of the vehicle.
    pub fn system_id(&self) -> u8 {
        self.system_id
    }

    /// What the vehicle was started with.
    pub fn settings(&self) -> &VehicleSettings {
        &self.settings
    }

    /// The pace that is asked for.
    pub fn speed(&self) -> Speed {
        self.speed
    }

    /// Asks for another pace.
    pub fn set_speed(&mut self, speed: Speed) {
        self.speed = speed;
    }

    /// Their values at the start, in the order of the table.
    pub fn initial(&self) -> &[Value] {
        &self.initial
    }

    /// Files that describe them.
    pub fn metadata(&self) -> &ParameterMetadata {
        self.metadata
            .get_or_init(|| ParameterMetadata::new(self.settings.identity, &self.table, &self.initial))
    }

    /// What the table reads.
    fn values(&self, vehicle: &Vehicle) -> ParameterValues {
        ParameterValues {
            configuration: vehicle.kept_configuration(),
            conduct: *vehicle.conduct(),
            system_id: self.system_id,
            speed: self.speed,
            statistics: Statistics {
                items: PlanKind::ALL
                    .map(|kind| vehicle.plans().get(kind).items().len().try_into().unwrap_or(u32::MAX)),
                ..self.statistics
            },
        }
    }

    /// What the vehicle counts.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// The same, to be counted on.
    pub fn statistics_mut(&mut self) -> &mut Statistics {
        &mut self.statistics
    }

    /// All names with their values, in the order of the table.
    pub fn all(&self, vehicle: &Vehicle) -> impl Iterator<Item = (&'static str, Value)> {
        self.table.values(self.values(vehicle))
    }

    /// Value at a position of the table.
    pub fn value(&self, index: usize, vehicle: &Vehicle) -> Option<Value> {
        self.table.value(index, &self.values(vehicle))
    }

    /// Hash over all names and values.
    pub fn hash(&self, vehicle: &Vehicle) -> u32 {
        parameter_hash(self.all(vehicle))
    }

    /// Changes a parameter, by any of its names.
    ///
    /// # Errors
    /// [`SetError`]; nothing has changed then.
    pub fn set(&mut self, name: &str, value: f64, vehicle: &mut Vehicle) -> Result<(), SetError> {
        let mut values = self.values(vehicle);
        let change = self.table.set(name, value, &mut values)?;
        match change {
            Change::Nothing => {}
            Change::Statistics => {
                self.statistics.reset((vehicle.unix_start_us() + vehicle.time_us()) / 1_000_000);
            }
            Change::Boots => self.statistics.boots = values.statistics.boots,
            Change::ClosedLoop | Change::Conduct | Change::Speed => {
                let adopted = vehicle.adopt(&values.configuration, &values.conduct);
                adopted.map_err(|source| SetError::refused(name, source))?;
                self.speed = values.speed;
            }
        }
        self.changed = true;
        Ok(())
    }

    /// Sets all parameters to what they were at the start.
    ///
    /// # Errors
    /// [`Refusal`] while armed, or when the closed loop refuses its settings.
    pub fn reset(&mut self, vehicle: &mut Vehicle) -> Result<(), Refusal> {
        if vehicle.is_armed() {
            return Err(Refusal::later("Parameter reset denied: disarm first"));
        }
        let mut configuration = self.settings.configuration;
        let now = vehicle.simulation().configuration();
        (configuration.initial, configuration.environment) = (now.initial, now.environment);
        configuration.reference = now.reference;
        let denied = |error: ChangeError| Refusal::denied(error.to_string());
        vehicle.adopt(&configuration, &self.settings.conduct).map_err(denied)?;
        self.changed = true;
        Ok(())
    }

    /// The parameters as the text of a file, if one has changed since the last call.
    pub fn take_changed(&mut self, format: FileFormat, vehicle: &Vehicle) -> Option<String> {
        if !std::mem::take(&mut self.changed) {
            return None;
        }
        Some(vehicle::parameters::render(format, &self.table, &self.values(vehicle)))
    }
}
