//! A channel that loses, duplicates and reorders, and a vehicle behind it.

use std::collections::VecDeque;

use autopilot::codec::{Frame, Message};
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage, PARAM_VALUE_DATA};
use vehicle::identity::Identity;

use super::{Bench, command_long};

/// A share of the messages suffers each of loss, duplication and delay behind later ones.
const SHARE: f64 = 0.05;
/// Longest delay of a message, ms.
const LATE_MS: u64 = 60;

/// A small generator: the same numbers on every machine.
pub struct Chance(u64);

impl Chance {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// One direction of the channel.
pub struct Channel<T> {
    pub waiting: VecDeque<(u64, T)>,
    pub lost: usize,
}

impl<T: Clone> Channel<T> {
    pub fn new() -> Self {
        Self { waiting: VecDeque::new(), lost: 0 }
    }

    pub fn send(&mut self, item: T, now_ms: u64, chance: &mut Chance) {
        if chance.next() < SHARE {
            self.lost += 1;
            return;
        }
        let copies = if chance.next() < SHARE { 2 } else { 1 };
        for _ in 0..copies {
            let delay_ms = if chance.next() < SHARE { (chance.next() * LATE_MS as f64) as u64 } else { 1 };
            self.waiting.push_back((now_ms + delay_ms, item.clone()));
        }
    }

    pub fn arrived(&mut self, now_ms: u64) -> Vec<T> {
        let (ready, waiting) = self.waiting.drain(..).partition(|(when_ms, _)| *when_ms <= now_ms);
        self.waiting = waiting;
        let ready: VecDeque<(u64, T)> = ready;
        ready.into_iter().map(|(_, item)| item).collect()
    }
}

/// A vehicle behind the channel.
pub struct Lossy {
    pub bench: Bench,
    pub up: Channel<Frame>,
    pub down: Channel<Message>,
    pub chance: Chance,
    pub now_ms: u64,
}

impl Lossy {
    pub fn new(seed: u64) -> Self {
        let bench = Bench::new(Identity::Px4);
        Self { bench, up: Channel::new(), down: Channel::new(), chance: Chance(seed), now_ms: 0 }
    }

    pub fn send(&mut self, message: impl Into<Message>) {
        let frame = self.bench.frame(message);
        self.up.send(frame, self.now_ms, &mut self.chance);
    }

    /// One millisecond; what arrives at the client.
    pub fn step(&mut self) -> Vec<Message> {
        self.now_ms += 1;
        for frame in self.up.arrived(self.now_ms) {
            self.bench.receive(&frame);
        }
        self.bench.fly(0.001);
        for message in std::mem::take(&mut self.bench.heard) {
            self.down.send(message, self.now_ms, &mut self.chance);
        }
        self.down.arrived(self.now_ms)
    }

    /// Sends a command until it is answered, as the protocol says: up to ten times.
    pub fn command(&mut self, command: MavCmd, parameters: [f32; 7]) -> u8 {
        for confirmation in 0..10 {
            self.send(command_long(command, parameters, confirmation));
            for _ in 0..500 {
                let answer = self.step().into_iter().find_map(|message| match message {
                    Message::CommandAck(ack) if u32::from(ack.command) == command as u32 => Some(ack.result),
                    _ => None,
                });
                if let Some(result) = answer {
                    return result;
                }
            }
        }
        panic!("{command:?} was never answered");
    }

    pub fn parameters_of(messages: Vec<Message>) -> Vec<PARAM_VALUE_DATA> {
        let value = |message| match message {
            Message::Typed(MavMessage::PARAM_VALUE(value)) => Some(value),
            _ => None,
        };
        messages.into_iter().filter_map(value).collect()
    }
}
