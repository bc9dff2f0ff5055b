//! Reading and writing parameters of the closed loop as numbers: the one place that knows their kinds.

use quadrotor::{Access, Configuration, Parameter};

use super::Value;
use super::value::within;

/// Present value.
pub fn read(parameter: &Parameter, configuration: &Configuration) -> Value {
    match parameter.access {
        Access::Real { get, .. } => Value::Real(get(configuration) as f32),
        Access::Integer { get, .. } | Access::Enumeration { get, .. } => Value::Integer(get(configuration)),
        Access::Boolean { get, .. } => Value::Integer(i32::from(get(configuration))),
    }
}

/// Present value as a number, in full precision.
pub fn number(parameter: &Parameter, configuration: &Configuration) -> f64 {
    match parameter.access {
        Access::Real { get, .. } => get(configuration),
        _ => read(parameter, configuration).number(),
    }
}

/// Writes a number into a configuration as the parameter's type. `None` if the parameter cannot have it; nothing has changed
/// then.
pub fn write(parameter: &Parameter, value: f64, into: &mut Configuration) -> Option<()> {
    let whole =
        |minimum: f64, maximum: f64| within(minimum, maximum, value).filter(|value| value.fract() == 0.0);
    match parameter.access {
        Access::Real { minimum, maximum, set, .. } => set(into, within(minimum, maximum, value)?),
        Access::Integer { minimum, maximum, set, .. } => {
            set(into, whole(f64::from(minimum), f64::from(maximum))? as i32);
        }
        Access::Enumeration { choice, set, .. } => set(into, whole(1.0, choice.items.len() as f64)? as i32),
        Access::Boolean { set, .. } => set(into, whole(0.0, 1.0)? == 1.0),
    }
    Some(())
}
