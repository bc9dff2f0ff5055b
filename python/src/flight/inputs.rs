//! The inputs by their names: those of the FMUs `LmpcQuadrotor` and `QuadrotorPlant`, and what is asked of single loops.

use fmi::Model;
use fmi::variables::{Field, Role, Variable};
use fmu::ClosedLoop;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use quadrotor::ValueRange;

use super::commands::Commands;
use super::suggestion;
use crate::errors::ParameterError;

/// An input that the closed loop's FMU does not have.
pub struct Own {
    name: &'static str,
    description: &'static str,
    unit: &'static str,
    /// None for a switch.
    range: Option<(f64, f64)>,
    get: fn(&Commands) -> f64,
    set: fn(&mut Commands, f64),
}

/// A real input at a field of [`Commands`].
macro_rules! real {
    ($name:literal, $unit:literal, $minimum:literal..=$maximum:literal, $($field:ident).+ $([$index:literal])?, $description:literal) => {
        Own {
            name: $name,
            description: $description,
            unit: $unit,
            range: Some(($minimum, $maximum)),
            get: |commands| commands.$($field).+ $([$index])?,
            set: |commands, value| commands.$($field).+ $([$index])? = value,
        }
    };
}

macro_rules! failed {
    ($name:literal, $rotor:literal, $description:literal) => {
        Own {
            name: $name,
            description: $description,
            unit: "",
            range: None,
            get: |commands| f64::from(u8::from(commands.has_failed($rotor))),
            set: |commands, value| commands.set_failed($rotor, value != 0.0),
        }
    };
}

#[rustfmt::skip]
static OWN: [Own; 18] = [
    real!("reference.jerk.x", "m/s³", -1e4..=1e4, flight.reference.jerk_m_s3.x, "Jerk reference north, fed forward without shaping"),
    real!("reference.jerk.y", "m/s³", -1e4..=1e4, flight.reference.jerk_m_s3.y, "Jerk reference east, fed forward without shaping"),
    real!("reference.jerk.z", "m/s³", -1e4..=1e4, flight.reference.jerk_m_s3.z, "Jerk reference down, fed forward without shaping"),
    real!("reference.snap.x", "m/s⁴", -1e5..=1e5, flight.reference.snap_m_s4.x, "Snap reference north, fed forward without shaping"),
    real!("reference.snap.y", "m/s⁴", -1e5..=1e5, flight.reference.snap_m_s4.y, "Snap reference east, fed forward without shaping"),
    real!("reference.snap.z", "m/s⁴", -1e5..=1e5, flight.reference.snap_m_s4.z, "Snap reference down, fed forward without shaping"),
    real!("rotor.command[1]", "rad/s", 0.0..=10000.0, rotor_rad_s[0], "Commanded speed of the front rotor; matters with actuation = 'rotors'"),
    real!("rotor.command[2]", "rad/s", 0.0..=10000.0, rotor_rad_s[1], "Commanded speed of the right rotor; matters with actuation = 'rotors'"),
    real!("rotor.command[3]", "rad/s", 0.0..=10000.0, rotor_rad_s[2], "Commanded speed of the back rotor; matters with actuation = 'rotors'"),
    real!("rotor.command[4]", "rad/s", 0.0..=10000.0, rotor_rad_s[3], "Commanded speed of the left rotor; matters with actuation = 'rotors'"),
    failed!("rotor.failed[1]", 0, "Whether the motor of the front rotor has no power"),
    failed!("rotor.failed[2]", 1, "Whether the motor of the right rotor has no power"),
    failed!("rotor.failed[3]", 2, "Whether the motor of the back rotor has no power"),
    failed!("rotor.failed[4]", 3, "Whether the motor of the left rotor has no power"),
    real!("command.thrust", "N", 0.0..=1e4, thrust_n, "Thrust of the four rotors; matters with actuation = 'rates'"),
    real!("command.body_rate.p", "rad/s", -100.0..=100.0, rate_rad_s.x, "Roll rate; matters with actuation = 'rates'"),
    real!("command.body_rate.q", "rad/s", -100.0..=100.0, rate_rad_s.y, "Pitch rate; matters with actuation = 'rates'"),
    real!("command.body_rate.r", "rad/s", -100.0..=100.0, rate_rad_s.z, "Yaw rate; matters with actuation = 'rates'"),
];

/// An input.
#[derive(Clone, Copy)]
pub enum Input {
    /// Of the closed loop's FMU.
    Shared(&'static Variable<ClosedLoop>, &'static Field<quadrotor::Inputs>),
    /// Of its own.
    Own(&'static Own),
}

/// All of them.
pub fn all() -> impl Iterator<Item = Input> {
    let shared =
        ClosedLoop::VARIABLES.iter().copied().flatten().filter_map(|variable| match &variable.role {
            Role::Input(field) => Some(Input::Shared(variable, field)),
            _ => None,
        });
    shared.chain(OWN.iter().map(Input::Own))
}

impl Input {
    /// The input of a name.
    pub fn of(name: &str) -> PyResult<Self> {
        all()
            .find(|input| input.name() == name)
            .ok_or_else(|| suggestion::unknown("input", name, all().map(Self::name)))
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shared(variable, _) => variable.name,
            Self::Own(own) => own.name,
        }
    }

    fn description(self) -> &'static str {
        match self {
            Self::Shared(variable, _) => variable.description,
            Self::Own(own) => own.description,
        }
    }

    fn unit(self) -> &'static str {
        match self {
            Self::Shared(variable, _) => {
                variable.quantity().and_then(|quantity| quantity.unit).map_or("", |unit| unit.name)
            }
            Self::Own(own) => own.unit,
        }
    }

    /// Its range; none for a switch.
    fn range(self) -> Option<(f64, f64)> {
        match self {
            Self::Shared(_, Field::Real { minimum, maximum, .. }) => Some((*minimum, *maximum)),
            Self::Shared(_, Field::Integer { minimum, maximum, .. }) => {
                Some((f64::from(*minimum), f64::from(*maximum)))
            }
            Self::Shared(..) => None,
            Self::Own(own) => own.range,
        }
    }

    /// Whether it is on or off.
    fn is_switch(self) -> bool {
        match self {
            Self::Shared(_, field) => matches!(field, Field::Boolean { .. }),
            Self::Own(own) => own.range.is_none(),
        }
    }

    /// Its value as a number; 1 is true.
    pub fn get(self, commands: &Commands) -> f64 {
        match self {
            Self::Shared(_, field) => match field {
                Field::Real { get, .. } => get(&commands.flight),
                Field::Integer { get, .. } | Field::Enumeration { get, .. } => {
                    f64::from(get(&commands.flight))
                }
                Field::Boolean { get, .. } => f64::from(u8::from(get(&commands.flight))),
            },
            Self::Own(own) => (own.get)(commands),
        }
    }

    /// Sets it to a number within its range.
    pub fn set(self, commands: &mut Commands, value: f64) -> PyResult<()> {
        if let Some((minimum, maximum)) = self.range()
            && !(minimum..=maximum).contains(&value)
        {
            let range = ValueRange { minimum, maximum, unit: self.unit() };
            let (name, value) = (self.name(), range.quantity(value));
            return Err(ParameterError::new_err(format!("{name} = {value}; allowed {range}")));
        }
        if self.is_switch() && value != 0.0 && value != 1.0 {
            let name = self.name();
            return Err(ParameterError::new_err(format!("{name} = {value}; expected True or False")));
        }
        match self {
            Self::Shared(_, field) => match field {
                Field::Real { set, .. } => set(&mut commands.flight, value),
                // In range, and whole where an input is an integer.
                Field::Integer { set, .. } | Field::Enumeration { set, .. } => {
                    set(&mut commands.flight, value as i32);
                }
                Field::Boolean { set, .. } => set(&mut commands.flight, value != 0.0),
            },
            Self::Own(own) => (own.set)(commands, value),
        }
        Ok(())
    }
}

/// All inputs by name, each with description, unit, minimum and maximum; a switch has no range.
#[pyfunction]
pub fn inputs<'py>(python: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(python);
    for input in all() {
        let facts = PyDict::new(python);
        facts.set_item("description", input.description())?;
        facts.set_item("unit", input.unit())?;
        facts.set_item("minimum", input.range().map(|range| range.0))?;
        facts.set_item("maximum", input.range().map(|range| range.1))?;
        table.set_item(input.name(), facts)?;
    }
    Ok(table)
}
