//! The outputs by their names: those of the FMU `LmpcQuadrotor`.

use fmi::Model;
use fmi::variables::{Role, Signal, Variable};
use fmu::ClosedLoop;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use quadrotor::Outputs;

use super::actuation::Actuation;
use super::suggestion;
use crate::errors::ParameterError;

/// An output.
#[derive(Clone, Copy)]
pub struct Output {
    variable: &'static Variable<ClosedLoop>,
    signal: &'static Signal<Outputs>,
}

/// Outputs of the controllers begin with one of these: a plant alone has none of them.
const OF_CONTROLLERS: [&str; 5] =
    ["tilt_reference.", "setpoint.", "tracking_error.", "yaw_error", "controller."];

/// All of them.
pub fn all() -> impl Iterator<Item = Output> {
    ClosedLoop::VARIABLES.iter().copied().flatten().filter_map(|variable| match &variable.role {
        Role::Output { signal, .. } => Some(Output { variable, signal }),
        _ => None,
    })
}

/// The outputs of a vehicle by that it is asked for.
pub fn of(actuation: Actuation) -> impl Iterator<Item = Output> {
    all().filter(move |output| {
        let controllers = OF_CONTROLLERS.iter().any(|start| output.variable.name.starts_with(start));
        actuation != Actuation::Rotors || !controllers
    })
}

/// The outputs of some names.
pub fn named(names: &[String], actuation: Actuation) -> PyResult<Vec<Output>> {
    let find = |name: &String| {
        let Some(output) = all().find(|output| output.variable.name == name) else {
            return Err(suggestion::unknown("output", name, all().map(Output::name)));
        };
        match of(actuation).any(|known| known.variable.name == output.variable.name) {
            true => Ok(output),
            false => Err(ParameterError::new_err(format!(
                "{name} is an output of the controllers; a vehicle with actuation = 'rotors' has none"
            ))),
        }
    };
    names.iter().map(find).collect()
}

impl Output {
    /// Its name.
    pub fn name(self) -> &'static str {
        self.variable.name
    }

    /// Its value as a number; items of an enumeration count from 1.
    pub fn get(self, outputs: &Outputs) -> f64 {
        match self.signal {
            Signal::Real { get, .. } => get(outputs),
            Signal::Count { get } => f64::from(get(outputs)),
            Signal::Enumeration { get, .. } => f64::from(get(outputs)),
            Signal::Boolean { get } => f64::from(u8::from(get(outputs))),
        }
    }

    /// Whether it is a whole number.
    fn is_whole(self) -> bool {
        !matches!(self.signal, Signal::Real { .. })
    }
}

/// All outputs by name, each with description, unit, whether it is whole, and the items that it counts, if any.
#[pyfunction]
pub fn outputs<'py>(python: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(python);
    for output in all() {
        let facts = PyDict::new(python);
        let unit = output.variable.quantity().and_then(|quantity| quantity.unit).map_or("", |unit| unit.name);
        let items =
            output.variable.choice().map(|choice| choice.items.iter().map(|item| item.0).collect::<Vec<_>>());
        facts.set_item("description", output.variable.description)?;
        facts.set_item("unit", unit)?;
        facts.set_item("whole", output.is_whole())?;
        facts.set_item("items", items)?;
        table.set_item(output.name(), facts)?;
    }
    Ok(table)
}
