//! Many flights at once.

use std::collections::HashMap;
use std::num::NonZeroUsize;

use nalgebra::DMatrix;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString};
use quadrotor::{ClosedLoopVehicle, Configuration, FleetError, Kinds, Simulation};

use super::actuation::Actuation;
use super::commands::Commands;
use super::inputs::Input;
use super::outputs::{self, Output};
use super::parameters;
use super::saved::Saved;
use super::simulation::{instants, room};
use super::vehicle::{MOTION, Vehicle};
use crate::arguments::{shown, whole};
use crate::arrays::{matrix, vector};
use crate::errors::{ArgumentError, ParameterError};
use crate::interruption::Interruption;

/// Most vehicles: each takes about 20 kB.
const MOST_VEHICLES: usize = 1_000_000;
/// Most threads; systems allow hardly more.
const MOST_THREADS: usize = 1024;

/// A vehicle of a fleet.
#[derive(Clone)]
struct Member {
    vehicle: Vehicle,
    /// Where its flights begin.
    start: Saved,
}

impl Member {
    /// At the start, under its present inputs, maybe in another motion.
    fn restarted(&self, motion: Option<&[f64; MOTION]>) -> Result<Self, String> {
        let mut restarted = self.clone();
        restarted.start.commands = self.vehicle.commands;
        restarted.vehicle.restore(&restarted.start)?;
        motion.map_or(Ok(()), |motion| restarted.vehicle.place(motion))?;
        Ok(restarted)
    }

    /// As it was saved.
    fn restored(&self, saved: &Saved) -> Result<Self, String> {
        let mut restored = self.clone();
        restored.vehicle.restore(saved)?;
        Ok(restored)
    }
}

impl ClosedLoopVehicle for Member {
    fn closed_loop(&self) -> Option<&Simulation> {
        self.vehicle.closed_loop()
    }

    fn closed_loop_mut(&mut self) -> Option<&mut Simulation> {
        self.vehicle.closed_loop_mut()
    }
}

/// Many flights in whole µs: `lmpc_quadrotor.Fleet` is beside it.
// Each flight is that of a `Simulation`, whatever the others do.
#[pyclass(module = "lmpc_quadrotor._native")]
pub struct Fleet {
    fleet: quadrotor::Fleet<Member>,
    actuation: Actuation,
}

/// One value for all vehicles, or one for each.
enum Each<'py> {
    Same(Bound<'py, PyAny>),
    Own(Bound<'py, PyAny>),
}

impl<'py> Each<'py> {
    fn new(name: &str, value: &Bound<'py, PyAny>, count: usize) -> PyResult<Self> {
        // A text is one value, and so is whatever has no length.
        let length = if value.is_instance_of::<PyString>() { None } else { value.len().ok() };
        match length {
            None => Ok(Self::Same(value.clone())),
            Some(length) if length == count => Ok(Self::Own(value.clone())),
            Some(length) => Err(ArgumentError::new_err(format!(
                "{name} has {length} values; expected one, or {count}: one for each vehicle"
            ))),
        }
    }

    /// A refused value, with the vehicle that it is for where each has its own.
    fn refused(&self, python: Python<'_>, vehicle: usize, refusal: PyErr) -> PyErr {
        match self {
            Self::Same(_) => refusal,
            Self::Own(_) => refusal_of(python, vehicle, &refusal),
        }
    }

    fn of(&self, vehicle: usize) -> PyResult<Bound<'py, PyAny>> {
        match self {
            Self::Same(value) => Ok(value.clone()),
            Self::Own(values) => values.get_item(vehicle),
        }
    }
}

impl Fleet {
    fn set(commands: &mut [Commands], values: &Bound<'_, PyDict>) -> PyResult<()> {
        let mut changed = commands.to_vec();
        for (name, value) in values {
            let name: String = name.extract()?;
            let input = Input::of(&name)?;
            let numbers = vector(&name, &value)?;
            if numbers.len() != 1 && numbers.len() != changed.len() {
                return Err(ArgumentError::new_err(format!(
                    "{name} has {} values; expected one, or {}: one for each vehicle",
                    numbers.len(),
                    changed.len()
                )));
            }
            for (vehicle, commands) in changed.iter_mut().enumerate() {
                match numbers.as_slice() {
                    [number] => input.set(commands, *number)?,
                    own => {
                        let set = input.set(commands, own[vehicle]);
                        set.map_err(|refusal| refusal_of(values.py(), vehicle, &refusal))?;
                    }
                }
            }
        }
        commands.copy_from_slice(&changed);
        Ok(())
    }

    fn chosen(&self, names: Option<Vec<String>>) -> PyResult<Vec<Output>> {
        match names {
            Some(names) => outputs::named(&names, self.actuation),
            None => Ok(outputs::of(self.actuation).collect()),
        }
    }

    /// All vehicles that can fly on to the times that are told by their indices, µs. The plants of closed loops step together.
    fn advance_to(&mut self, end_us: impl Fn(usize, &Vehicle) -> u64 + Sync) {
        if self.actuation == Actuation::Rotors {
            self.fleet.advance_each(|index, member| {
                let end_us = end_us(index, &member.vehicle);
                member.vehicle.advance_to(end_us)
            });
        } else {
            self.fleet.advance_side_by_side(|index, member| {
                (end_us(index, &member.vehicle), member.vehicle.inputs())
            });
        }
    }

    /// The outputs of all vehicles, a row for each.
    fn rows(&self, chosen: &[Output]) -> Vec<f64> {
        let row = |_, member: &Member| {
            let outputs = member.vehicle.outputs();
            chosen.iter().map(|output| output.get(&outputs)).collect::<Vec<_>>()
        };
        self.fleet.map(row).concat()
    }
}

/// Vehicles with these settings. Those that are alike are designed once.
fn members(
    settings: Vec<(Configuration, Commands)>,
    actuation: Actuation,
    threads: Option<NonZeroUsize>,
) -> PyResult<Vec<Member>> {
    let kinds = Kinds::of(&settings, |setting| setting.0.fingerprint(), PartialEq::eq);
    let designed = kinds.first.iter().map(|index| settings[*index]).collect();
    let designed = quadrotor::Fleet::of(designed, threads).map_err(no_threads)?;
    let vehicles = designed
        .map(|kind, (configuration, commands)| {
            Vehicle::new(configuration, commands, actuation).map_err(of_vehicle(kinds.first[kind]))
        })
        .into_iter()
        .collect::<Result<Vec<_>, _>>()
        .map_err(ParameterError::new_err)?;
    let member = |kind: usize| {
        let vehicle: Vehicle = vehicles[kind].clone();
        Member { start: vehicle.save(), vehicle }
    };
    Ok(kinds.of_each.into_iter().map(member).collect())
}

/// A parameter or an input that is refused, as that of a vehicle.
fn refusal_of(python: Python<'_>, vehicle: usize, refusal: &PyErr) -> PyErr {
    ParameterError::new_err(format!("vehicle {vehicle}: {}", refusal.value(python)))
}

/// A refusal, as one of a vehicle.
fn of_vehicle(vehicle: usize) -> impl Fn(String) -> String {
    move |refusal| format!("vehicle {vehicle}: {refusal}")
}

fn no_threads(error: FleetError) -> PyErr {
    ArgumentError::new_err(error.to_string())
}

#[pymethods]
impl Fleet {
    #[new]
    #[pyo3(signature = (count, parameters, inputs, actuation = "reference", threads = None))]
    fn new(
        python: Python<'_>,
        count: &Bound<'_, PyAny>,
        parameters: &Bound<'_, PyDict>,
        inputs: &Bound<'_, PyDict>,
        actuation: &str,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let count = whole("count", count, 1..=MOST_VEHICLES)?;
        let threads = threads.map(|threads| whole("threads", threads, 1..=MOST_THREADS)).transpose()?;
        let actuation = Actuation::from_name(actuation)?;
        let mut configurations = vec![Configuration::default(); count];
        for (name, value) in parameters {
            let name: String = name.extract()?;
            let parameter = parameters::of(&name)?;
            let values = Each::new(&name, &value, count)?;
            for (vehicle, configuration) in configurations.iter_mut().enumerate() {
                let set = parameters::set(configuration, parameter, &values.of(vehicle)?);
                set.map_err(|refusal| values.refused(python, vehicle, refusal))?;
            }
        }
        let mut commands: Vec<Commands> = configurations
            .iter()
            .map(|configuration| Commands::new(&configuration.with_airframe()))
            .collect();
        Self::set(&mut commands, inputs)?;
        let settings = configurations.into_iter().zip(commands).collect();
        let threads = threads.and_then(NonZeroUsize::new);
        let members = python.detach(|| members(settings, actuation, threads))?;
        Ok(Self { fleet: quadrotor::Fleet::of(members, threads).map_err(no_threads)?, actuation })
    }

    fn __len__(&self) -> usize {
        self.fleet.len()
    }

    #[getter]
    fn actuation(&self) -> &'static str {
        self.actuation.name()
    }

    #[getter]
    fn times_us<'py>(&self, python: Python<'py>) -> Bound<'py, PyArray1<u64>> {
        PyArray1::from_vec(python, self.fleet.vehicles().map(|member| member.vehicle.time_us()).collect())
    }

    /// Why each vehicle could not go on, if it could not.
    #[getter]
    fn failures(&self) -> Vec<Option<String>> {
        self.fleet.failures().map(|failure| failure.map(ToString::to_string)).collect()
    }

    #[getter]
    fn failed<'py>(&self, python: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        PyArray1::from_vec(python, self.fleet.failures().map(|failure| failure.is_some()).collect())
    }

    fn output_names(&self) -> Vec<&'static str> {
        outputs::of(self.actuation).map(Output::name).collect()
    }

    fn set_inputs(&mut self, values: &Bound<'_, PyDict>) -> PyResult<()> {
        let mut commands: Vec<Commands> =
            self.fleet.vehicles().map(|member| member.vehicle.commands).collect();
        Self::set(&mut commands, values)?;
        for (member, commands) in self.fleet.vehicles_mut().zip(commands) {
            member.vehicle.commands = commands;
        }
        Ok(())
    }

    /// All vehicles that can fly on by a duration.
    fn advance(&mut self, python: Python<'_>, duration_us: u64) {
        python.detach(|| self.advance_to(|_, vehicle| vehicle.time_us().saturating_add(duration_us)));
    }

    #[pyo3(signature = (names = None))]
    fn read<'py>(
        &self,
        python: Python<'py>,
        names: Option<Vec<String>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let chosen = self.chosen(names)?;
        let rows = python.detach(|| self.rows(&chosen));
        PyArray1::from_vec(python, rows).reshape([self.fleet.len(), chosen.len()])
    }

    /// Flies on by a duration and returns the times since then, µs, and the outputs: by time, vehicle and name.
    #[pyo3(signature = (duration_us, step_us, names = None))]
    #[allow(clippy::type_complexity, reason = "two arrays, as Python takes them")]
    fn record<'py>(
        &mut self,
        python: Python<'py>,
        duration_us: u64,
        step_us: u64,
        names: Option<Vec<String>>,
    ) -> PyResult<(Bound<'py, PyArray1<u64>>, Bound<'py, PyArray3<f64>>)> {
        let chosen = self.chosen(names)?;
        let instants = instants(0, duration_us, step_us)?;
        let begun: Vec<u64> = self.fleet.vehicles().map(|member| member.vehicle.time_us()).collect();
        let mut table = room(instants.len(), self.fleet.len() * chosen.len())?;
        python.detach(|| {
            let mut interruption = Interruption::new();
            for instant in &instants {
                self.advance_to(|vehicle, _| begun[vehicle].saturating_add(*instant));
                table.extend(self.rows(&chosen));
                interruption.check()?;
            }
            Ok::<_, PyErr>(())
        })?;
        let shape = [instants.len(), self.fleet.len(), chosen.len()];
        let table = PyArray1::from_vec(python, table).reshape(shape)?;
        Ok((PyArray1::from_vec(python, instants), table))
    }

    /// Begins the flights of some vehicles anew, under their present inputs, each in its own motion if there is one.
    #[pyo3(signature = (vehicles, motions = None))]
    fn restart(
        &mut self,
        python: Python<'_>,
        vehicles: &Bound<'_, PyAny>,
        motions: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let vehicles = self.indices(vehicles)?;
        let motions = motions.map(|motions| matrix("motions", motions)).transpose()?;
        if let Some(motions) = &motions
            && motions.shape() != (vehicles.len(), MOTION)
        {
            return Err(ArgumentError::new_err(format!(
                "motions has the shape {:?}, expected ({}, {MOTION})",
                motions.shape(),
                vehicles.len()
            )));
        }
        let motion_of = |row: usize| {
            motions
                .as_ref()
                .map(|motions: &DMatrix<f64>| std::array::from_fn(|column| motions[(row, column)]))
        };
        let restarted: HashMap<usize, Option<[f64; MOTION]>> =
            vehicles.iter().enumerate().map(|(row, vehicle)| (*vehicle, motion_of(row))).collect();
        let restarted = |vehicle: usize, member: &Member| {
            let motion = restarted.get(&vehicle)?;
            Some(member.restarted(motion.as_ref()).map_err(of_vehicle(vehicle)))
        };
        let fleet = &mut self.fleet;
        python
            .detach(|| fleet.replace_each(|vehicle, member| restarted(vehicle, member).transpose()))
            .map_err(ArgumentError::new_err)
    }

    fn save<'py>(&self, python: Python<'py>) -> PyResult<Vec<Bound<'py, PyBytes>>> {
        let bytes = |member: &Member| Ok(PyBytes::new(python, &member.vehicle.save().bytes()?));
        self.fleet.vehicles().map(bytes).collect()
    }

    fn restore(&mut self, python: Python<'_>, saved: Vec<Vec<u8>>) -> PyResult<()> {
        if saved.len() != self.fleet.len() {
            return Err(ArgumentError::new_err(format!(
                "saved has {} flights, expected {}",
                saved.len(),
                self.fleet.len()
            )));
        }
        let saved = saved.iter().map(|bytes| Saved::from_bytes(bytes)).collect::<PyResult<Vec<_>>>()?;
        if saved.iter().any(|saved| saved.actuation != self.actuation) {
            return Err(ArgumentError::new_err("saved has flights with another actuation than this fleet's"));
        }
        let fleet = &mut self.fleet;
        let restored = |vehicle: usize, member: &Member| {
            member.restored(&saved[vehicle]).map(Some).map_err(of_vehicle(vehicle))
        };
        python.detach(|| fleet.replace_each(restored)).map_err(ArgumentError::new_err)
    }
}

impl Fleet {
    /// Vehicles by their indices.
    fn indices(&self, vehicles: &Bound<'_, PyAny>) -> PyResult<Vec<usize>> {
        let last = self.fleet.len().saturating_sub(1);
        let items = vehicles.try_iter().map_err(|_| {
            let shown = shown(vehicles);
            ArgumentError::new_err(format!(
                "vehicles = {shown}; expected a list of whole numbers from 0 to {last}"
            ))
        })?;
        let index = |item: PyResult<Bound<'_, PyAny>>| {
            let item = item?;
            item.extract::<usize>().ok().filter(|index| *index <= last).ok_or_else(|| {
                let shown = shown(&item);
                ArgumentError::new_err(format!("there is no vehicle {shown}; allowed are 0 to {last}"))
            })
        };
        items.map(index).collect()
    }
}
