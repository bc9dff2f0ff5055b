//! How controllers and plant are connected.

use fmi::Model;
use fmi::variables::Terminal;
use fmu::{Controller, QuadrotorPlant};

use super::ports::{Port, Ports, Unit};
use super::{CONTROLLERS, VEHICLE};

/// What is measured or commanded in two ways, in the way that is not the default.
const OTHER_WAY: [&str; 3] = ["measured.attitude.q", "measured.rotor.", "command."];

/// What else can be seen of the plant.
const SHOWN: [&str; 2] = ["altitude", "thrust"];

/// An end of a connection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End<'a> {
    pub element: &'static str,
    pub port: &'a Port,
}

/// A connection from an output to an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Connection<'a> {
    pub start: End<'a>,
    pub end: End<'a>,
}

/// All connections, outputs beside them, and the units of all that. The system has no connectors of its own: libcosim knows none.
pub struct Wiring<'a> {
    pub connections: Vec<Connection<'a>>,
    pub shown: Vec<End<'a>>,
    pub units: Vec<&'a Unit>,
}

impl<'a> Wiring<'a> {
    /// Members of the same name of terminals of the same name.
    pub fn new(controller: &'a Ports, plant: &'a Ports) -> Self {
        let connections: Vec<Connection> = controller
            .ports
            .iter()
            .filter_map(|port| {
                let partner = plant.find(&partner(&port.name)?)?;
                let (ours, other) =
                    (End { element: CONTROLLERS, port }, End { element: VEHICLE, port: partner });
                Some(match port.causality.as_str() {
                    "output" => Connection { start: ours, end: other },
                    _ => Connection { start: other, end: ours },
                })
            })
            .collect();
        let shown: Vec<End> =
            SHOWN.iter().filter_map(|name| Some(End { element: VEHICLE, port: plant.find(name)? })).collect();
        let carried = |unit: &&Unit| {
            let starts = connections.iter().map(|connection| &connection.start);
            starts.chain(&shown).any(|end| end.port.unit.as_ref() == Some(&unit.symbol))
        };
        let units = plant.units.iter().filter(carried).collect();
        Self { connections, shown, units }
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
