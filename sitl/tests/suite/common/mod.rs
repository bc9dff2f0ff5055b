//! A client and a vehicle without a socket between them.

pub mod channel;
pub mod failsafe_bench;
pub mod fence_bench;
pub mod ftp_client;
pub mod mission_flight;
pub mod plan_client;
pub mod recording;
pub mod requests;
pub mod seal;

use autopilot::Autopilot;
use autopilot::codec::{CommandAck, Frame, Message, Version};
use autopilot::envelope::{LinkProfile, Origin, PeerId};
use mavlink::dialects::ardupilotmega::{COMMAND_LONG_DATA, MavCmd, MavMessage, PARAM_VALUE_DATA};
use vehicle::identity::Identity;
use vehicle::parameters::Speed;
use vehicle::{Mode, VehicleSettings};

pub const GROUND_STATION: (u8, u8) = (255, 190);

/// Settings of a vehicle in Zurich whose units may be broken, and which ArduPilot's Auto may arm and take off.
pub fn settings(identity: Identity) -> VehicleSettings {
    let mut settings = VehicleSettings::new(identity);
    settings.conduct.auto_options = 3;
    settings.conduct.failure_injection = true;
    settings
}

/// A vehicle and what it has said.
pub struct Bench {
    pub autopilot: Autopilot,
    pub heard: Vec<Message>,
    /// Turns of long answers at each look: more than any of them needs, if the test does not say otherwise.
    pub turns: usize,
    sequence: u8,
}

impl Bench {
    pub fn new(identity: Identity) -> Self {
        Self::of(&settings(identity))
    }

    pub fn of(settings: &VehicleSettings) -> Self {
        Self::started_at(settings, 0)
    }

    /// Started when the wall clock showed a time, µs since 1970.
    pub fn started_at(settings: &VehicleSettings, unix_us: u64) -> Self {
        let links = [LinkProfile::Ground];
        let autopilot =
            Autopilot::new(settings, 1, Speed::Factor(1.0), &links, unix_us).expect("valid settings");
        let mut bench = Self { autopilot, heard: Vec::new(), turns: 10_000, sequence: 0 };
        bench.listen();
        bench
    }

    pub fn origin() -> Origin {
        let peer = PeerId { link: 0, number: 1 };
        Origin { peer, system: GROUND_STATION.0, component: GROUND_STATION.1 }
    }

    /// The next frame of the ground station.
    pub fn frame(&mut self, message: impl Into<Message>) -> Frame {
        self.sequence = self.sequence.wrapping_add(1);
        Frame::encode(&message.into(), Version::Two, self.sequence, GROUND_STATION)
            .expect("a message of MAVLink 2")
    }

    pub fn send(&mut self, message: MavMessage) {
        let frame = self.frame(message);
        self.receive(&frame);
    }

    pub fn receive(&mut self, frame: &Frame) {
        self.autopilot.receive(&Self::origin(), frame);
        self.listen();
    }

    pub fn listen(&mut self) {
        self.autopilot.transfer(self.turns, |_| Some(true));
        self.heard.extend(self.autopilot.take_outgoing().map(|outgoing| outgoing.message));
    }

    pub fn fly(&mut self, seconds: f64) {
        for _ in 0..(seconds * 1000.0).round() as usize {
            self.autopilot.tick().expect("the flight goes on");
            self.listen();
        }
    }

    /// Flies, calling `send` twenty times per second.
    pub fn stream(&mut self, seconds: f64, mut send: impl FnMut(&mut Self)) {
        for _ in 0..(seconds * 20.0).round() as usize {
            send(self);
            self.fly(0.05);
        }
    }

    /// Flies until a condition holds.
    pub fn fly_until(&mut self, what: &str, seconds: f64, condition: impl Fn(&Self) -> bool) {
        for _ in 0..(seconds * 100.0) as usize {
            if condition(self) {
                return;
            }
            self.fly(0.01);
        }
        panic!("not within {seconds} s: {what}; {:?}", self.autopilot.vehicle().outputs());
    }

    /// Sends a command and returns the result of its answer.
    pub fn command(&mut self, command: MavCmd, parameters: [f32; 7]) -> u8 {
        let message = command_long(command, parameters, 0);
        self.heard.clear();
        self.send(message);
        self.acks().last().expect("every command is answered").result
    }

    pub fn acks(&self) -> Vec<CommandAck> {
        let ack = |message: &Message| match message {
            Message::CommandAck(ack) => Some(*ack),
            _ => None,
        };
        self.heard.iter().filter_map(ack).collect()
    }

    /// Lines for the pilot, their pieces joined.
    pub fn texts(&self) -> Vec<String> {
        let mut texts: Vec<(u16, String)> = Vec::new();
        for message in &self.heard {
            let Message::Typed(MavMessage::STATUSTEXT(text)) = message else { continue };
            let piece = text.text.to_str().unwrap_or_default();
            match texts.last_mut() {
                Some((id, whole)) if text.chunk_seq > 0 && *id == text.id => whole.push_str(piece),
                _ => texts.push((text.id, piece.to_owned())),
            }
        }
        texts.into_iter().map(|(_, text)| text).collect()
    }

    pub fn parameters(&self) -> Vec<PARAM_VALUE_DATA> {
        let value = |message: &Message| match message {
            Message::Typed(MavMessage::PARAM_VALUE(value)) => Some(value.clone()),
            _ => None,
        };
        self.heard.iter().filter_map(value).collect()
    }

    pub fn arm(&mut self) {
        assert_eq!(
            self.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            0
        );
    }

    /// Hovering, in the mode that follows a takeoff.
    pub fn hovering(identity: Identity) -> Self {
        Self::hovering_with(&settings(identity))
    }

    pub fn hovering_with(settings: &VehicleSettings) -> Self {
        let (identity, mut bench) = (settings.identity, Self::of(settings));
        if identity.is_ardupilot() {
            bench.set_mode(Mode::Offboard);
        }
        bench.arm();
        let altitude = if identity.is_ardupilot() { 10.0 } else { 498.0 };
        assert_eq!(
            bench.command(
                MavCmd::MAV_CMD_NAV_TAKEOFF,
                [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, altitude]
            ),
            0
        );
        bench.fly_until("takeoff", 20.0, |bench| bench.mode() != Mode::Takeoff);
        bench.fly(2.0);
        bench
    }

    pub fn set_mode(&mut self, mode: Mode) -> u8 {
        let identity = self.autopilot.identity();
        let custom = identity.custom_mode(mode);
        let [main, sub] =
            if identity.is_ardupilot() { [custom, 0] } else { [custom >> 16 & 0xff, custom >> 24] };
        let parameters = [1.0, main as f32, sub as f32, 0.0, 0.0, 0.0, 0.0];
        self.command(MavCmd::MAV_CMD_DO_SET_MODE, parameters)
    }

    pub fn mode(&self) -> Mode {
        self.autopilot.vehicle().mode()
    }

    pub fn position(&self) -> [f64; 3] {
        self.autopilot.vehicle().outputs().position_m.into()
    }

    pub fn velocity(&self) -> [f64; 3] {
        self.autopilot.vehicle().outputs().velocity_m_s.into()
    }

    pub fn is_near(&self, goal: [f64; 3]) -> bool {
        let outputs = self.autopilot.vehicle().outputs();
        (outputs.position_m - nalgebra::Vector3::from(goal)).norm() < 0.1 && outputs.velocity_m_s.norm() < 0.1
    }
}

pub fn command_long(command: MavCmd, parameters: [f32; 7], confirmation: u8) -> MavMessage {
    let data = autopilot::codec::command_long((1, 1), command, parameters);
    MavMessage::COMMAND_LONG(COMMAND_LONG_DATA { confirmation, ..data })
}
