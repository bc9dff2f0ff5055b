//! What a pilot asks for.

use serde::Deserialize;
use tokio::sync::mpsc::Sender;

/// What is asked of a vehicle.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "action", rename_all = "snake_case", deny_unknown_fields)]
pub enum Action {
    /// Let the rotors turn.
    Arm {},
    /// Stop the rotors; only on the ground.
    Disarm {},
    /// Arm if need be, climb, and hold.
    TakeOff {
        /// Above home, m.
        height_m: f64,
    },
    /// Land where it is.
    Land {},
    /// Fly home and land.
    Return {},
    /// Hold its place.
    Hold {},
    /// Fly the mission.
    StartMission {},
    /// Fly to a place and hold there.
    FlyTo {
        /// North and east, m.
        place_m: [f64; 2],
        /// Above the ground there, m.
        height_m: f64,
    },
    /// Break a unit, or repair it.
    Fault {
        /// `UNIT=KIND`; the kind `ok` repairs.
        fault: String,
    },
    /// Change the wind.
    Wind {
        /// m/s.
        speed_m_s: f64,
        /// Where it comes from, degrees from north through east.
        from_deg: f64,
    },
    /// Change the speed of simulation time.
    Speed {
        /// Simulated seconds per second; 0: paused, -1: as fast as possible.
        factor: f64,
    },
    /// While paused, fly on for a time.
    Step {
        /// s.
        time_s: f64,
    },
}

/// An action, who it is for, and where the answer goes.
#[derive(Debug)]
pub struct Order {
    /// System id.
    pub vehicle: u8,
    /// What is asked.
    pub action: Action,
    /// Where the answer goes.
    pub reply: Reply,
}

/// Answers one order.
#[derive(Debug)]
pub struct Reply {
    number: u64,
    to: Sender<String>,
}

/// An order as a browser sends it.
#[derive(Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SentOrder {
    /// Number that its answer repeats.
    pub order: u64,
    /// System id.
    pub vehicle: u8,
    /// What is asked.
    pub please: Action,
}

impl Reply {
    /// To an order of this number.
    pub(crate) fn new(number: u64, to: Sender<String>) -> Self {
        Self { number, to }
    }

    /// Tells the pilot how it went. Who reads nothing misses it.
    pub fn send(self, outcome: Result<(), String>) {
        let answer = serde_json::json!({ "answer": self.number, "refused": outcome.err() });
        let _gone = self.to.try_send(answer.to_string());
    }
}
