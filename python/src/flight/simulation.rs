//! One flight.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use quadrotor::Configuration;

use super::actuation::Actuation;
use super::commands::Commands;
use super::inputs::{self, Input};
use super::outputs::{self, Output};
use super::parameters;
use super::saved::Saved;
use super::vehicle::{MOTION, Vehicle};
use crate::arrays::{array1, vector_of};
use crate::errors::{ArgumentError, FlightError, ParameterError};
use crate::interruption::Interruption;

/// What is flown between looks whether the user has interrupted, µs: some milliseconds of the wall clock.
const PIECE_US: u64 = 10_000_000;

/// One flight in whole µs: `lmpc_quadrotor.Simulation` is beside it.
#[pyclass(module = "lmpc_quadrotor._native")]
pub struct Simulation(Vehicle);

/// A motion from an array.
pub fn motion(value: &Bound<'_, PyAny>) -> PyResult<[f64; MOTION]> {
    let values = vector_of("motion", Some(value), MOTION)?;
    let mut motion = [0.0; MOTION];
    motion.copy_from_slice(values.as_slice());
    Ok(motion)
}

/// The times at which a flight is recorded: now, every step, and the end.
pub fn instants(now_us: u64, end_us: u64, step_us: u64) -> PyResult<Vec<u64>> {
    if step_us == 0 {
        return Err(ArgumentError::new_err("step must be 1 µs or more"));
    }
    if end_us < now_us {
        return Err(ArgumentError::new_err(format!(
            "cannot fly to {} s: the flight is already at {} s",
            end_us as f64 / 1e6,
            now_us as f64 / 1e6
        )));
    }
    let count = usize::try_from((end_us - now_us).div_ceil(step_us)).unwrap_or(usize::MAX);
    let mut instants = room(count.saturating_add(1), 1)?;
    let steps = (1..).map(|count: u64| now_us.saturating_add(count.saturating_mul(step_us)));
    instants.push(now_us);
    instants.extend(steps.take_while(|time_us| *time_us < end_us));
    instants.extend((end_us > now_us).then_some(end_us));
    Ok(instants)
}

/// Room for rows of so many numbers.
pub fn room<T>(rows: usize, numbers: usize) -> PyResult<Vec<T>> {
    let mut room = Vec::new();
    let fits = rows.checked_mul(numbers).is_some_and(|count| room.try_reserve_exact(count).is_ok());
    if fits {
        return Ok(room);
    }
    Err(PyMemoryError::new_err(format!(
        "there is no memory for {rows} rows of {numbers} numbers; choose a longer step, a shorter duration or fewer outputs"
    )))
}

impl Simulation {
    fn set(commands: &mut Commands, values: &Bound<'_, PyDict>) -> PyResult<()> {
        let mut changed = *commands;
        for (name, value) in values {
            let name: String = name.extract()?;
            let input = Input::of(&name)?;
            let number = match value.extract::<f64>() {
                Ok(number) => number,
                Err(_) => {
                    let shown = value.repr()?.to_string();
                    return Err(ParameterError::new_err(format!(
                        "{name} = {shown}; expected a number or a truth value"
                    )));
                }
            };
            input.set(&mut changed, number)?;
        }
        *commands = changed;
        Ok(())
    }

    fn chosen(&self, names: Option<Vec<String>>) -> PyResult<Vec<Output>> {
        match names {
            Some(names) => outputs::named(&names, self.0.actuation()),
            None => Ok(outputs::of(self.0.actuation()).collect()),
        }
    }
}

/// Flies on to a time, unless the user interrupts: then the flight is somewhere before it.
fn fly(vehicle: &mut Vehicle, time_us: u64, interruption: &mut Interruption) -> PyResult<()> {
    let lost = |error: quadrotor::SimulationError| FlightError::new_err(error.to_string());
    // Commanded rates turn the attitude that the vehicle has where an advance begins, so that such a flight is not divided.
    if vehicle.actuation() != Actuation::Rates {
        while vehicle.time_us().saturating_add(PIECE_US) < time_us {
            vehicle.advance_to(vehicle.time_us() + PIECE_US).map_err(lost)?;
            interruption.check()?;
        }
    }
    vehicle.advance_to(time_us).map_err(lost)?;
    interruption.check()
}

/// Sets parameters of a configuration.
pub fn configured(configuration: &mut Configuration, values: &Bound<'_, PyDict>) -> PyResult<()> {
    for (name, value) in values {
        let parameter = parameters::of(&name.extract::<String>()?)?;
        parameters::set(configuration, parameter, &value)?;
    }
    Ok(())
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (parameters, inputs, actuation = "reference"))]
    fn new(
        python: Python<'_>,
        parameters: &Bound<'_, PyDict>,
        inputs: &Bound<'_, PyDict>,
        actuation: &str,
    ) -> PyResult<Self> {
        let actuation = Actuation::from_name(actuation)?;
        let mut configuration = Configuration::default();
        configured(&mut configuration, parameters)?;
        let mut commands = Commands::new(&configuration.with_airframe());
        Self::set(&mut commands, inputs)?;
        let vehicle = python.detach(|| Vehicle::new(&configuration, &commands, actuation));
        vehicle.map(Self).map_err(ParameterError::new_err)
    }

    #[staticmethod]
    fn from_saved(python: Python<'_>, saved: &[u8]) -> PyResult<Self> {
        let saved = Saved::from_bytes(saved)?;
        python.detach(|| Vehicle::from_saved(&saved)).map(Self).map_err(ArgumentError::new_err)
    }

    fn copy(&self) -> Self {
        Self(self.0.clone())
    }

    #[getter]
    fn actuation(&self) -> &'static str {
        self.0.actuation().name()
    }

    #[getter]
    fn time_us(&self) -> u64 {
        self.0.time_us()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings()
    }

    fn parameters<'py>(&self, python: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        parameters::read(python, self.0.configuration())
    }

    fn set_parameters(&mut self, python: Python<'_>, values: &Bound<'_, PyDict>) -> PyResult<()> {
        let mut configuration = *self.0.configuration();
        configured(&mut configuration, values)?;
        let vehicle = &mut self.0;
        python.detach(|| vehicle.reconfigure(&configuration)).map_err(ParameterError::new_err)
    }

    fn inputs<'py>(&self, python: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let values = PyDict::new(python);
        for input in inputs::all() {
            values.set_item(input.name(), input.get(&self.0.commands))?;
        }
        Ok(values)
    }

    fn set_inputs(&mut self, values: &Bound<'_, PyDict>) -> PyResult<()> {
        Self::set(&mut self.0.commands, values)
    }

    fn output_names(&self) -> Vec<&'static str> {
        outputs::of(self.0.actuation()).map(Output::name).collect()
    }

    #[pyo3(signature = (names = None))]
    fn read<'py>(
        &self,
        python: Python<'py>,
        names: Option<Vec<String>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let outputs = self.0.outputs();
        let values: Vec<f64> = self.chosen(names)?.iter().map(|output| output.get(&outputs)).collect();
        Ok(array1(python, &values))
    }

    fn place(&mut self, value: &Bound<'_, PyAny>) -> PyResult<()> {
        self.0.place(&motion(value)?).map_err(ArgumentError::new_err)
    }

    fn advance_to(&mut self, python: Python<'_>, time_us: u64) -> PyResult<()> {
        let vehicle = &mut self.0;
        python.detach(|| fly(vehicle, time_us, &mut Interruption::new()))
    }

    /// Flies on and returns the times, µs, and the outputs there, a row for each.
    #[pyo3(signature = (end_us, step_us, names = None))]
    #[allow(clippy::type_complexity, reason = "two arrays, as Python takes them")]
    fn record<'py>(
        &mut self,
        python: Python<'py>,
        end_us: u64,
        step_us: u64,
        names: Option<Vec<String>>,
    ) -> PyResult<(Bound<'py, PyArray1<u64>>, Bound<'py, PyArray2<f64>>)> {
        let chosen = self.chosen(names)?;
        let instants = instants(self.0.time_us(), end_us, step_us)?;
        let vehicle = &mut self.0;
        let mut rows = room(instants.len(), chosen.len())?;
        let rows = python.detach(|| {
            let mut interruption = Interruption::new();
            for time_us in &instants {
                fly(vehicle, *time_us, &mut interruption)?;
                let outputs = vehicle.outputs();
                rows.extend(chosen.iter().map(|output| output.get(&outputs)));
            }
            Ok::<_, PyErr>(rows)
        });
        let rows = rows?;
        let table = PyArray1::from_vec(python, rows).reshape([instants.len(), chosen.len()])?;
        Ok((PyArray1::from_vec(python, instants), table))
    }

    fn save<'py>(&self, python: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(python, &self.0.save().bytes()?))
    }

    fn restore(&mut self, python: Python<'_>, saved: &[u8]) -> PyResult<()> {
        let saved = Saved::from_bytes(saved)?;
        let vehicle = &mut self.0;
        python.detach(|| vehicle.restore(&saved)).map_err(ArgumentError::new_err)
    }
}
