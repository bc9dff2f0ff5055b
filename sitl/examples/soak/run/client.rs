//! A client: it comes, beats, does one thing after the other, and goes.

use std::collections::VecDeque;

use autopilot::Autopilot;
use autopilot::codec::{Frame, Version};
use autopilot::envelope::{Destination, Origin, PeerId};
use mavlink::Message as _;
use mavlink::dialects::ardupilotmega::{HEARTBEAT_DATA, MISSION_ITEM_INT_DATA, MavMessage};
use vehicle::LandedState;

use super::chance::Chance;
use super::channel::Channel;
use super::figures::Figures;
use super::flight_plan;
use super::task::{Outcome, Step, Surroundings, Task};

const HEARTBEAT_US: u64 = 1_000_000;
const COMPONENT: u8 = 190;
/// So long without a heartbeat, and a client takes the vehicle for gone.
const DEAD_US: u64 = 6_000_000;

pub struct Client {
    pub leaves_us: u64,
    pilot: bool,
    peer: PeerId,
    system: u8,
    sequence: u8,
    beat_due_us: u64,
    heard_us: u64,
    up: Channel<Frame>,
    down: Channel<Frame>,
    task: Option<Task>,
    steps: VecDeque<Step>,
}

impl Client {
    pub fn new(pilot: bool, system: u8, number: u64, loss: f64, now_us: u64, chance: &mut Chance) -> Self {
        let stays_us = if pilot { chance.seconds_us(60.0, 600.0) } else { chance.seconds_us(10.0, 180.0) };
        Self {
            leaves_us: now_us + stays_us,
            pilot,
            peer: PeerId { link: 0, number },
            system,
            sequence: (chance.share() * 256.0) as u8,
            beat_due_us: now_us,
            heard_us: now_us,
            up: Channel::new(loss),
            down: Channel::new(loss),
            task: None,
            steps: VecDeque::new(),
        }
    }

    /// Whether a message goes to it.
    pub fn is_meant(&self, to: Destination) -> bool {
        match to {
            Destination::Everyone => true,
            Destination::Link(link) => link == self.peer.link,
            Destination::Peer(peer) => peer == self.peer,
        }
    }

    /// A frame is on its way to it.
    pub fn tell(&mut self, frame: Frame, now_us: u64, chance: &mut Chance) {
        self.down.send(frame, now_us, chance);
    }

    /// What reaches the vehicle from it now.
    pub fn arrived(&mut self, now_us: u64) -> Vec<(Origin, Frame)> {
        let origin = Origin { peer: self.peer, system: self.system, component: COMPONENT };
        self.up.arrived(now_us).into_iter().map(|frame| (origin, frame)).collect()
    }

    /// A moment of it.
    pub fn go_on(
        &mut self,
        now_us: u64,
        autopilot: &Autopilot,
        mission: &mut Option<Vec<MISSION_ITEM_INT_DATA>>,
        chance: &mut Chance,
        figures: &mut Figures,
    ) {
        let heard: Vec<MavMessage> = self.down.arrived(now_us).iter().filter_map(read).collect();
        self.listen(now_us, &heard, autopilot, figures);
        let mut out = Vec::new();
        if now_us >= self.beat_due_us {
            self.beat_due_us = now_us + HEARTBEAT_US;
            out.push(MavMessage::HEARTBEAT(HEARTBEAT_DATA {
                mavlink_version: 3,
                ..HEARTBEAT_DATA::default()
            }));
        }
        if self.task.is_none() {
            if self.steps.is_empty() {
                let plan = if self.pilot { flight_plan::pilot } else { flight_plan::observer };
                self.steps = plan(autopilot, chance);
            }
            self.task = self.steps.pop_front().map(|step| Task::new(step, now_us));
        }
        let mut with = Surroundings { now_us, autopilot, heard: &heard, mission, out: &mut out, figures };
        match self.task.as_mut().and_then(|task| task.go_on(&mut with)) {
            None => {}
            Some(Outcome::Done) => self.task = None,
            // A new plan, from how things are.
            Some(Outcome::Dropped) => (self.task, self.steps) = (None, VecDeque::new()),
            Some(Outcome::Failed(what)) => {
                figures.violation(autopilot.system_id(), now_us, what);
                (self.task, self.steps) = (None, VecDeque::new());
            }
        }
        for message in out {
            self.sequence = self.sequence.wrapping_add(1);
            let frame = Frame::encode(&message.into(), Version::Two, self.sequence, (self.system, COMPONENT));
            self.up.send(frame.expect("a message of MAVLink 2"), now_us, chance);
        }
    }

    /// What it hears must be the vehicle's state, and often enough.
    fn listen(&mut self, now_us: u64, heard: &[MavMessage], autopilot: &Autopilot, figures: &mut Figures) {
        let system = autopilot.system_id();
        for message in heard {
            let MavMessage::HEARTBEAT(beat) = message else { continue };
            self.heard_us = now_us;
            if autopilot.identity().mode(beat.custom_mode).is_none() {
                figures.violation(system, now_us, format!("there is no mode {:#x}", beat.custom_mode));
            }
        }
        if now_us - self.heard_us > DEAD_US {
            figures.violation(system, now_us, "no heartbeat for six seconds");
            self.heard_us = now_us;
        }
    }

    /// It goes, in the middle of whatever it does.
    pub fn leave(
        self,
        autopilot: &Autopilot,
        mission: &mut Option<Vec<MISSION_ITEM_INT_DATA>>,
        figures: &mut Figures,
    ) {
        figures.sent += self.up.sent;
        figures.received += self.down.sent;
        figures.lost += self.up.lost + self.down.lost;
        if self.pilot {
            figures.abandoned += u64::from(autopilot.vehicle().landed_state() != LandedState::OnGround);
            // Whether its last upload came to its end it did not wait to hear.
            if self.task.as_ref().is_some_and(|task| matches!(*task.step, Step::Upload(_))) {
                *mission = None;
            }
        }
    }
}

/// A message that it has an ear for.
fn read(frame: &Frame) -> Option<MavMessage> {
    // HEARTBEAT, PARAM_VALUE, the mission protocol's, COMMAND_ACK
    let meant = matches!(frame.message_id(), 0 | 22 | 39..=51 | 73 | 77);
    let parse = || MavMessage::parse(frame.version().into(), frame.message_id(), frame.payload_bytes()).ok();
    meant.then(parse).flatten()
}
