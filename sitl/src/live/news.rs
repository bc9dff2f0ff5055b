//! Modes, faults and lines for the pilot as the page shows them.

use std::collections::VecDeque;

use autopilot::Autopilot;
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::{MavMessage, MavSeverity, STATUSTEXT_DATA};
use vehicle::Vehicle;
use vehicle::fault::{Fault, Rotors, Sensor};
use viewer::{News, Text, VehicleNews};

use crate::fleet::{Fleet, Overheard};

/// Lines that the page shows.
const MOST_LINES: usize = 50;
/// Characters of a line that goes on in the next message.
const CHUNK: usize = 50;
/// MAV_RESULT of what is done, and of what has begun.
const ACCEPTED: [u8; 2] = [0, 5];

/// Puts together what the page says in words.
#[derive(Debug)]
pub struct NewsDesk {
    /// Lines that it keeps.
    most: usize,
    lines: VecDeque<Text>,
    next: u64,
    /// The beginning of a line that goes on, by who says it.
    begun: Vec<(u8, u16, String)>,
}

impl Default for NewsDesk {
    fn default() -> Self {
        Self::with_lines(MOST_LINES)
    }
}

impl NewsDesk {
    /// Keeps so many lines.
    pub fn with_lines(most: usize) -> Self {
        Self { most, lines: VecDeque::new(), next: 0, begun: Vec::new() }
    }

    /// Takes in what vehicles have said.
    pub fn hear(&mut self, heard: Vec<Overheard>) {
        for Overheard { system, time_us, message } in heard {
            let Message::Typed(MavMessage::STATUSTEXT(text)) = message else { continue };
            let Some(line) = self.joined(system, &text) else { continue };
            self.next += 1;
            self.lines.push_back(Text {
                number: self.next,
                time_s: time_us as f64 / 1e6,
                vehicle: system,
                severity: level(text.severity),
                text: line,
            });
            if self.lines.len() > self.most {
                self.lines.pop_front();
            }
        }
    }

    /// Why one of these answers refuses a request, if one does.
    pub fn refusal(&self, heard: &[Overheard]) -> Option<String> {
        let is_refusal = |one: &Overheard| match &one.message {
            Message::CommandAck(ack) => !ACCEPTED.contains(&ack.result),
            Message::Typed(MavMessage::PARAM_ERROR(_)) => true,
            _ => false,
        };
        heard.iter().any(is_refusal).then(|| {
            // A copy of the desk joins the lines that came with the answer.
            let mut desk = Self::default();
            desk.hear(heard.to_vec());
            let said: Vec<String> = desk.lines.into_iter().map(|line| line.text).collect();
            if said.is_empty() { "the vehicle refused".to_owned() } else { said.join("; ") }
        })
    }

    /// Everything as it is now.
    pub fn news(&self, fleet: &Fleet) -> News {
        News {
            vehicles: fleet.members().iter().map(|member| news_of(member.autopilot())).collect(),
            texts: self.texts(),
        }
    }

    /// The lines that it has kept, the oldest first.
    pub fn texts(&self) -> Vec<Text> {
        self.lines.iter().cloned().collect()
    }

    /// A whole line, if this was its last piece.
    fn joined(&mut self, system: u8, text: &STATUSTEXT_DATA) -> Option<String> {
        let piece = text.text.to_str().unwrap_or_default();
        if text.id == 0 {
            return Some(piece.to_owned());
        }
        let known = |(from, id, _): &(u8, u16, String)| (*from, *id) == (system, text.id);
        let before = self.begun.iter().position(known).map(|index| self.begun.swap_remove(index).2);
        let line = before.unwrap_or_default() + piece;
        if piece.chars().count() < CHUNK {
            return Some(line);
        }
        self.begun.retain(|(from, _, _)| *from != system);
        self.begun.push((system, text.id, line));
        None
    }
}

/// Importance as syslog has it.
fn level(severity: MavSeverity) -> u8 {
    severity as u8
}

/// What is said of one vehicle.
pub fn news_of(autopilot: &Autopilot) -> VehicleNews {
    let vehicle = autopilot.vehicle();
    VehicleNews {
        id: autopilot.system_id(),
        mode: vehicle.identity().mode_name(vehicle.shown_mode()).to_owned(),
        faults: faults(vehicle),
    }
}

/// What is broken, as it is written.
fn faults(vehicle: &Vehicle) -> Vec<String> {
    let faults = vehicle.faults();
    let sensors = Sensor::ALL
        .into_iter()
        .map(|sensor| (faults.sensor(sensor).is_some(), Fault::Sensor(sensor, faults.sensor(sensor))));
    let battery = (faults.battery().is_some(), Fault::Battery(faults.battery()));
    let rotors = (1..).zip(faults.rotors()).filter_map(|(number, fault)| {
        Some((fault.is_some(), Fault::Rotors(Rotors::numbered(number)?, fault)))
    });
    let all = sensors.chain([battery]).chain(rotors);
    all.filter(|(broken, _)| *broken).map(|(_, fault)| fault.to_string()).collect()
}
