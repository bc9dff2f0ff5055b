//! The parameters by their names: those of the FMU and of the MAVLink vehicle.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use quadrotor::{Access, Configuration, PARAMETERS, Parameter};

use super::suggestion;
use crate::arguments::shown;
use crate::errors::ParameterError;

/// The parameter of a name.
pub fn of(name: &str) -> PyResult<&'static Parameter> {
    PARAMETERS.iter().find(|parameter| parameter.name == name).ok_or_else(|| {
        suggestion::unknown("parameter", name, PARAMETERS.iter().map(|parameter| parameter.name))
    })
}

/// Sets a parameter to a number, a truth value or the name of an item, within its range.
pub fn set(
    configuration: &mut Configuration,
    parameter: &'static Parameter,
    value: &Bound<'_, PyAny>,
) -> PyResult<()> {
    let wrong = |expected: &str| {
        ParameterError::new_err(format!("{} = {}; expected {expected}", parameter.name, shown(value)))
    };
    match &parameter.access {
        Access::Real { set, .. } => {
            set(configuration, value.extract().map_err(|_| wrong("a number"))?);
        }
        Access::Integer { set, minimum, maximum, .. } => {
            // A whole number of NumPy's or a float's.
            let whole = value.extract::<i32>().ok().or_else(|| {
                let number = value.extract::<f64>().ok()?;
                (number.fract() == 0.0 && f64::from(number as i32) == number).then_some(number as i32)
            });
            let whole = whole.filter(|whole| (*minimum..=*maximum).contains(whole));
            let expected = || wrong(&format!("a whole number from {minimum} to {maximum}"));
            set(configuration, whole.ok_or_else(expected)?);
        }
        Access::Enumeration { choice, set, .. } => {
            let names = || choice.items.iter().map(|item| item.0).collect::<Vec<_>>().join(", ");
            let number = match value.extract::<String>() {
                Ok(name) => {
                    (1..).zip(choice.items).find(|(_, item)| item.0 == name).map(|(number, _)| number)
                }
                Err(_) => value.extract::<i32>().ok().filter(|number| {
                    usize::try_from(*number).is_ok_and(|n| (1..=choice.items.len()).contains(&n))
                }),
            };
            set(configuration, number.ok_or_else(|| wrong(&format!("one of {}", names())))?);
        }
        Access::Boolean { set, .. } => {
            // Not whatever Python takes for true: "no" and "False" would be.
            let truth = value.extract::<bool>().ok().or_else(|| match value.extract::<f64>().ok()? {
                0.0 => Some(false),
                1.0 => Some(true),
                _ => None,
            });
            set(configuration, truth.ok_or_else(|| wrong("True or False"))?);
        }
    }
    parameter.check(configuration).map_err(|refusal| ParameterError::new_err(refusal.to_string()))
}

/// All parameters with their values as they fly.
pub fn read<'py>(python: Python<'py>, configuration: &Configuration) -> PyResult<Bound<'py, PyDict>> {
    let values = PyDict::new(python);
    let configuration = configuration.as_read();
    for parameter in PARAMETERS {
        let name = parameter.name;
        match &parameter.access {
            Access::Real { get, .. } => values.set_item(name, get(&configuration))?,
            Access::Integer { get, .. } => values.set_item(name, get(&configuration))?,
            Access::Boolean { get, .. } => values.set_item(name, get(&configuration))?,
            Access::Enumeration { choice, get, .. } => {
                let item = usize::try_from(get(&configuration))
                    .ok()
                    .and_then(|n| choice.items.get(n.checked_sub(1)?));
                values.set_item(name, item.map(|item| item.0))?;
            }
        }
    }
    Ok(values)
}

/// All parameters by name, each with description, unit, type, start, tunable, and minimum and maximum or items.
#[pyfunction]
pub fn parameters<'py>(python: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(python);
    let start = read(python, &Configuration::default())?;
    for parameter in PARAMETERS {
        let facts = PyDict::new(python);
        facts.set_item("description", parameter.description)?;
        facts.set_item("unit", parameter.unit.symbol())?;
        facts.set_item("start", start.get_item(parameter.name)?)?;
        facts.set_item("tunable", matches!(parameter.mutability, quadrotor::Mutability::Tunable))?;
        match &parameter.access {
            Access::Real { minimum, maximum, .. } => {
                facts.set_item("type", "real")?;
                facts.set_item("minimum", minimum)?;
                facts.set_item("maximum", maximum)?;
            }
            Access::Integer { minimum, maximum, .. } => {
                facts.set_item("type", "integer")?;
                facts.set_item("minimum", minimum)?;
                facts.set_item("maximum", maximum)?;
            }
            Access::Enumeration { choice, .. } => {
                facts.set_item("type", "enumeration")?;
                facts.set_item("items", choice.items.iter().map(|item| item.0).collect::<Vec<_>>())?;
            }
            Access::Boolean { .. } => facts.set_item("type", "boolean")?,
        }
        table.set_item(parameter.name, facts)?;
    }
    Ok(table)
}
