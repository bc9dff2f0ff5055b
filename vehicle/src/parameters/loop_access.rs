//! Reading and writing parameters of the closed loop as numbers: the one place that knows their kinds.

use quadrotor::{Access, Configuration, Parameter};

use super::{SetError, Value};

/// Present value.
pub fn read(parameter: &Parameter, configuration: &Configuration) -> Value {
    match parameter.access {
        Access::Real { get, .. } => Value::Real(get(configuration) as f32),
        Access::Integer { get, .. } | Access::Enumeration { get, .. } => Value::Integer(get(configuration)),
        Access::Boolean { get, .. } => Value::Integer(i32::from(get(configuration))),
    }
}

/// Writes a number into a configuration as the parameter's type.
pub fn write(id: &str, parameter: &Parameter, value: f64, into: &mut Configuration) -> Result<(), SetError> {
    let range = |minimum: f64, maximum: f64| {
        if (minimum..=maximum).contains(&value) {
            Ok(())
        } else {
            Err(SetError::OutOfRange { id: id.to_owned(), value, minimum, maximum })
        }
    };
    let whole = || {
        if value.fract() == 0.0 {
            Ok(())
        } else {
            Err(SetError::Meaningless { id: id.to_owned(), value, meanings: "whole numbers".to_owned() })
        }
    };
    match parameter.access {
        Access::Real { minimum, maximum, set, .. } => {
            range(minimum, maximum)?;
            set(into, value);
        }
        Access::Integer { minimum, maximum, set, .. } => {
            range(f64::from(minimum), f64::from(maximum))?;
            whole()?;
            set(into, value as i32);
        }
        Access::Enumeration { choice, set, .. } => {
            range(1.0, choice.items.len() as f64)?;
            whole()?;
            set(into, value as i32);
        }
        Access::Boolean { set, .. } => {
            range(0.0, 1.0)?;
            whole()?;
            set(into, value == 1.0);
        }
    }
    Ok(())
}
