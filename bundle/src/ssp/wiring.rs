//! How controllers and plant are connected.

use fmi::Model;
use fmi::variables::Terminal;
use fmu::{Controller, QuadrotorPlant};

use super::ports::{Port, Ports, Unit};
use super::{CONTROLLERS, VEHICLE};

/// What is measured or commanded in two ways. Importers that begin with zeros, as FMPy does, give a quaternion without direction, and rotors at rest
/// in flight: attitudes are Euler angles, and rotor speeds are predicted.
const OTHER_WAY: [&str; 3] = ["measured.attitude.q", "measured.rotor.", "command."];

/// What can be seen of the system from outside.
const SHOWN: [&str; 10] = [
    "position.x",
    "position.y",
    "position.z",
    "altitude",
    "velocity.x",
    "velocity.y",
    "velocity.z",
    "attitude.phi",
    "attitude.theta",
    "attitude.psi",
];

/// What acts from outside.
const ACTING: &str = "disturbance";

/// An end of a connection; without an element it is the system's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End<'a> {
    pub element: Option<&'static str>,
    pub port: &'a Port,
}

/// A connection from an output to an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Connection<'a> {
    pub start: End<'a>,
    pub end: End<'a>,
}

/// All connections, and the units of what they carry.
pub struct Wiring<'a> {
    pub connections: Vec<Connection<'a>>,
    pub units: Vec<&'a Unit>,
}

impl<'a> Wiring<'a> {
    /// Members of the same name of terminals of the same name; disturbances from outside, and the motion to there.
    pub fn new(controller: &'a Ports, plant: &'a Ports) -> Self {
        let mut connections = Vec::new();
        for port in &controller.ports {
            let partner = partner(&port.name).and_then(|name| plant.find(&name));
            let (ours, Some(other)) = (of(CONTROLLERS, port), partner.map(|port| of(VEHICLE, port))) else {
                continue;
            };
            connections.push(match port.causality.as_str() {
                "output" => Connection { start: ours, end: other },
                _ => Connection { start: other, end: ours },
            });
        }
        let acting = terminal(QuadrotorPlant::TERMINALS, ACTING);
        for port in &plant.ports {
            if port.causality == "input"
                && acting.is_some_and(|terminal| terminal.member(&port.name).is_some())
            {
                connections.push(Connection { start: outside(port), end: of(VEHICLE, port) });
            }
        }
        for port in SHOWN.iter().filter_map(|name| plant.find(name)) {
            connections.push(Connection { start: of(VEHICLE, port), end: outside(port) });
        }
        let carried = |unit: &&Unit| {
            connections.iter().any(|connection| connection.start.port.unit.as_ref() == Some(&unit.symbol))
        };
        let units = plant.units.iter().filter(carried).collect();
        Self { connections, units }
    }
}

/// The plant's variable that belongs to one of the controllers.
fn partner(variable: &str) -> Option<String> {
    if OTHER_WAY.iter().any(|beginning| variable.starts_with(beginning)) {
        return None;
    }
    Controller::TERMINALS.iter().find_map(|ours| {
        let other = terminal(QuadrotorPlant::TERMINALS, ours.name)?;
        Some(format!("{}{}", other.prefix, ours.member(variable)?))
    })
}

fn terminal(terminals: &'static [Terminal], name: &str) -> Option<&'static Terminal> {
    terminals.iter().find(|terminal| terminal.name == name)
}

fn of<'a>(element: &'static str, port: &'a Port) -> End<'a> {
    End { element: Some(element), port }
}

fn outside(port: &Port) -> End<'_> {
    End { element: None, port }
}
