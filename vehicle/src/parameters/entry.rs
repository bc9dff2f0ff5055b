//! One line of the table.

use quadrotor::Parameter;

use super::loop_access::read;
use super::{ConductParameter, ParameterValues, Value};

/// Where a parameter lives.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    /// In the closed loop.
    Loop(&'static Parameter),
    /// In the vehicle's behaviour; the factor is from our unit to that of the identifier.
    Conduct(&'static ConductParameter, f64),
    /// System id: fixed at the start.
    SystemId,
    /// Pace of simulation time.
    Speed,
    /// Thrust in hover as a share of the largest, calculated from the airframe.
    HoverThrust,
}

/// A parameter with its identifier.
#[derive(Clone, Debug)]
pub struct Entry {
    /// At most 16 characters.
    pub id: String,
    pub(super) source: Source,
}

impl Entry {
    /// Whether a parameter file keeps it.
    pub fn is_kept(&self) -> bool {
        matches!(self.source, Source::Loop(_) | Source::Conduct(..))
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
            Source::SystemId => Value::Integer(i32::from(values.system_id)),
            Source::Speed => Value::Real(values.speed.to_parameter() as f32),
            Source::HoverThrust => Value::Real(values.configuration.airframe.hover_thrust_share() as f32),
        }
    }
}
