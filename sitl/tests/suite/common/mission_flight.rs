//! Missions that are flown, and what is seen of the flight.

use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::MavMessage;
use nalgebra::Vector3;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, PlanKind, command, frame};
use vehicle::{MissionState, Mode};

use super::Bench;
use super::plan_client::{result, upload};

/// What is not given.
pub const NAN: f64 = f64::NAN;

/// Corners of a square, NED, m.
pub const SQUARE: [[f64; 3]; 4] =
    [[40.0, 0.0, -10.0], [40.0, 40.0, -10.0], [0.0, 40.0, -10.0], [0.0, 0.0, -10.0]];

/// An item at a place of the local frame.
pub fn at(command: u16, parameters: [f64; 4], position: [f64; 3]) -> MissionItem {
    MissionItem { frame: frame::LOCAL_NED, command, parameters, position, autocontinue: true }
}

/// An item without a place.
pub fn simple(command: u16, parameters: [f64; 4]) -> MissionItem {
    MissionItem { frame: frame::MISSION, command, parameters, position: [0.0; 3], autocontinue: true }
}

pub fn waypoint(position: [f64; 3]) -> MissionItem {
    at(command::NAV_WAYPOINT, [0.0, 2.0, 0.0, NAN], position)
}

pub fn takeoff() -> MissionItem {
    at(command::NAV_TAKEOFF, [0.0, 0.0, 0.0, NAN], [0.0, 0.0, -10.0])
}

/// A flight of a mission and what was seen of it.
pub struct Flight {
    pub bench: Bench,
    /// Items in the order in which they were reached, with the time, s.
    pub reached: Vec<(u16, f64)>,
    /// Positions and times, s, and headings, every 10 ms.
    pub track: Vec<(f64, Vector3<f64>, f64)>,
}

impl Flight {
    pub fn of(identity: Identity, items: &[MissionItem]) -> Self {
        let mut bench = Bench::new(identity);
        let heard = upload(&mut bench, PlanKind::Mission, items);
        assert_eq!(result(&heard), Some(0), "{heard:?}");
        Self { bench, reached: Vec::new(), track: Vec::new() }
    }

    pub fn new(items: &[MissionItem]) -> Self {
        let mut flight = Self::of(Identity::Px4, items);
        flight.bench.arm();
        assert_eq!(flight.bench.set_mode(Mode::Mission), 0);
        flight
    }

    pub fn now_s(&self) -> f64 {
        self.bench.autopilot.vehicle().time_us() as f64 / 1e6
    }

    pub fn state(&self) -> MissionState {
        self.bench.autopilot.vehicle().mission_status().state
    }

    pub fn current(&self) -> usize {
        self.bench.autopilot.vehicle().mission_status().current
    }

    pub fn step(&mut self) {
        self.bench.heard.clear();
        self.bench.fly(0.01);
        let outputs = *self.bench.autopilot.vehicle().outputs();
        let now_s = self.now_s();
        self.track.push((now_s, outputs.position_m, outputs.attitude_rad.z));
        for message in &self.bench.heard {
            if let Message::Typed(MavMessage::MISSION_ITEM_REACHED(item)) = message {
                self.reached.push((item.seq, now_s));
            }
        }
    }

    pub fn fly_until(&mut self, what: &str, seconds: f64, condition: impl Fn(&Self) -> bool) {
        for _ in 0..(seconds * 100.0) as usize {
            if condition(self) {
                return;
            }
            self.step();
        }
        panic!("not within {seconds} s: {what}; reached {:?}, at {:?}", self.reached, self.bench.position());
    }

    pub fn complete(mut self, seconds: f64) -> Self {
        self.fly_until("complete", seconds, |flight| flight.state() == MissionState::Complete);
        self
    }

    pub fn order(&self) -> Vec<u16> {
        self.reached.iter().map(|(item, _)| *item).collect()
    }

    pub fn time_of(&self, item: u16) -> f64 {
        self.reached.iter().find(|(reached, _)| *reached == item).expect("reached").1
    }

    /// The nearest that the vehicle came to a place, m.
    pub fn nearest(&self, place: [f64; 3]) -> f64 {
        self.track.iter().map(|(_, at, _)| (at - Vector3::from(place)).norm()).fold(f64::INFINITY, f64::min)
    }

    /// Samples between two times, s.
    pub fn between(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = &(f64, Vector3<f64>, f64)> {
        self.track.iter().filter(move |(time_s, ..)| (from_s..=to_s).contains(time_s))
    }

    pub fn heading_deg(&self) -> f64 {
        self.bench.autopilot.vehicle().outputs().attitude_rad.z.to_degrees()
    }
}
