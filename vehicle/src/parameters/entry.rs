//! One line of the table.

use quadrotor::Parameter;

use super::limit_names::LimitName;
use super::loop_access::{number, read};
use super::loop_names::LoopName;
use super::{ConductParameter, ParameterValues, SpeedParameter, Statistic, Value};
use crate::kept::KeptParameter;

/// Where a parameter lives.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    /// In the closed loop.
    Loop(&'static Parameter),
    /// In the vehicle's behaviour; the factor converts our unit to that of the name.
    Conduct(&'static ConductParameter, f64),
    /// In the closed loop, by another name than ours.
    Alias(&'static LimitName, &'static Parameter, f64),
    /// A speed of PX4's that is bound to others.
    BoundSpeed(&'static SpeedParameter),
    /// Kept, without effect, at a place.
    Kept(&'static KeptParameter, usize),
    /// System id: set at the start.
    SystemId,
    /// Pace of simulation time.
    Speed,
    /// Thrust in hover as a share of the largest, calculated from the airframe.
    HoverThrust,
    /// What the vehicle counts.
    Statistic(Statistic),
}

/// A parameter with its names.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// MAVLink name, at most 16 characters.
    pub id: &'static str,
    /// Earlier MAVLink name, accepted wherever a name is, and never listed.
    pub former: Option<&'static str>,
    pub(super) source: Source,
    /// Whether it is a further name of something that is listed before: files hold it once.
    pub(super) is_other: bool,
    /// Whether it describes the surroundings of this run rather than the vehicle: files do not hold it, so that the next run has its own.
    pub(super) is_of_run: bool,
}

impl Entry {
    /// A parameter of the closed loop.
    pub(super) fn of_loop(name: &LoopName, parameter: &'static Parameter) -> Self {
        Self {
            id: name.id,
            former: name.former,
            source: Source::Loop(parameter),
            is_other: false,
            is_of_run: false,
        }
    }

    /// A parameter that has always had its name.
    pub(super) fn new(id: &'static str, source: Source) -> Self {
        Self { id, former: None, source, is_other: false, is_of_run: false }
    }

    /// Public name in the closed loop, such as `airframe.mass`; `None` for the vehicle's own parameters.
    pub fn dotted(&self) -> Option<&'static str> {
        match self.source {
            Source::Loop(parameter) => Some(parameter.name),
            _ => None,
        }
    }

    /// Whether parameter files hold it.
    pub fn is_kept(&self) -> bool {
        !self.is_other && !self.is_of_run && self.is_of_vehicle()
    }

    /// Whether it belongs to the vehicle, not to the run, and may be in a file.
    pub(super) fn is_of_vehicle(&self) -> bool {
        matches!(
            self.source,
            Source::Loop(_)
                | Source::Conduct(..)
                | Source::Alias(..)
                | Source::BoundSpeed(_)
                | Source::Kept(..)
        )
    }

    /// The flag of the program that sets a parameter of the run, rather than of the vehicle.
    pub fn flag(&self) -> Option<&'static str> {
        match self.source {
            Source::SystemId => Some("--system-id"),
            Source::Speed => Some("--speed"),
            _ => None,
        }
    }

    /// Whether a name means this parameter: its MAVLink name, the former or the dotted one.
    pub(super) fn has_name(&self, name: &str) -> bool {
        self.id == name || self.former == Some(name) || self.dotted() == Some(name)
    }

    /// Present value.
    pub(super) fn value(&self, values: &ParameterValues) -> Value {
        match self.source {
            Source::Loop(parameter) => read(parameter, &values.configuration),
            Source::Conduct(parameter, scale) => {
                let value = (parameter.get)(&values.conduct);
                if parameter.integer {
                    Value::Integer(value as i32)
                } else {
                    Value::Real((value * scale) as f32)
                }
            }
            Source::Alias(_, parameter, scale) => {
                Value::Real((number(parameter, &values.configuration) * scale) as f32)
            }
            Source::Kept(parameter, place) => {
                let value = values.conduct.kept.get(place).unwrap_or(parameter.default);
                if parameter.integer { Value::Integer(value as i32) } else { Value::Real(value) }
            }
            Source::BoundSpeed(parameter) => Value::Real(parameter.get(values) as f32),
            Source::SystemId => Value::Integer(i32::from(values.system_id)),
            Source::Speed => Value::Real(values.speed.to_parameter() as f32),
            Source::Statistic(statistic) => {
                Value::Integer(i32::try_from(statistic.of(&values.statistics)).unwrap_or(i32::MAX))
            }
            Source::HoverThrust => Value::Real(values.configuration.airframe.hover_thrust_share() as f32),
        }
    }
}
