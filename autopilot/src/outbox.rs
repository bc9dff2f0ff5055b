//! What is on its way out: messages, and lines for the pilot.

use std::vec::Drain;

use vehicle::Severity;
use vehicle::equipment::EquipmentVoice;

use crate::codec::Message;
use crate::envelope::{Destination, Outgoing};
use crate::speaker::Speaker;
use crate::status_text::{Line, StatusTexts};

/// Messages in the order in which they are to be sent.
#[derive(Debug)]
pub struct Outbox {
    messages: Vec<Outgoing>,
    texts: StatusTexts,
    voice: EquipmentVoice,
    /// Who was asked, and answers.
    asked: Speaker,
}

impl Outbox {
    /// The empty outbox of a system.
    pub fn new(system_id: u8) -> Self {
        Self {
            messages: Vec::new(),
            texts: StatusTexts::new(system_id),
            voice: EquipmentVoice::default(),
            asked: Speaker::Autopilot,
        }
    }

    /// Lets camera and gimbal speak for themselves, or the autopilot for them.
    pub fn with_voice(self, voice: EquipmentVoice) -> Self {
        Self { voice, ..self }
    }

    /// Who speaks for camera and gimbal.
    pub fn voice(&self) -> EquipmentVoice {
        self.voice
    }

    /// Who was asked, and answers.
    pub fn asked(&self) -> Speaker {
        self.asked
    }

    /// From now on somebody answers who was asked.
    pub fn answer_as(&mut self, asked: Speaker) {
        self.asked = asked;
    }

    /// Puts a message behind all others: from the autopilot, or from who was asked.
    pub fn send(&mut self, to: Destination, message: impl Into<Message>) {
        let component = self.asked.id();
        self.messages.push(Outgoing { to, message: message.into(), component });
    }

    /// Puts a message of a component behind all others.
    pub fn send_as(&mut self, speaker: Speaker, to: Destination, message: impl Into<Message>) {
        let own = self.voice == EquipmentVoice::Own || self.asked == speaker;
        let component = if own { speaker.id() } else { Speaker::Autopilot.id() };
        self.messages.push(Outgoing { to, message: message.into(), component });
    }

    /// Puts a message behind all others in the name of a component that is not there.
    pub fn send_in_place_of(&mut self, component: u8, to: Destination, message: impl Into<Message>) {
        self.messages.push(Outgoing { to, message: message.into(), component });
    }

    /// Sends a line for the pilot to everyone, unless it was said a moment ago. `time_us` is the simulation time, µs.
    pub fn say(&mut self, time_us: u64, severity: Severity, text: &str) {
        for message in self.texts.say(time_us, severity, text) {
            self.send_as(Speaker::Autopilot, Destination::Everyone, message);
        }
    }

    /// A place in the order of what is to be sent: behind everything so far.
    pub fn mark(&self) -> usize {
        self.messages.len()
    }

    /// Moves the last message to a mark.
    pub fn last_to(&mut self, mark: usize) {
        if let Some(message) = self.messages.pop() {
            self.messages.insert(mark.min(self.messages.len()), message);
        }
    }

    /// Messages since the last call. Their room stays, for those of the next ticks.
    pub fn take(&mut self) -> Drain<'_, Outgoing> {
        self.messages.drain(..)
    }

    /// The clock begins anew: what was said before is not said a moment ago any more.
    pub fn restart(&mut self) {
        self.texts.forget();
    }

    /// Lines for the pilot since the last call, as many as are remembered.
    pub fn take_lines(&mut self) -> Vec<Line> {
        self.texts.take_unlogged()
    }
}

#[cfg(test)]
mod tests {
    use mavlink::dialects::ardupilotmega::{MavMessage, SYSTEM_TIME_DATA};
    use vehicle::Severity;

    use super::{Destination, Outbox};

    fn message(time_boot_ms: u32) -> MavMessage {
        MavMessage::SYSTEM_TIME(SYSTEM_TIME_DATA { time_boot_ms, ..SYSTEM_TIME_DATA::default() })
    }

    /// An answer is known last and goes first.
    #[test]
    fn the_last_message_moves_to_a_mark() {
        let mut outbox = Outbox::new(1);
        outbox.send(Destination::Everyone, message(0));
        let mark = outbox.mark();
        outbox.send(Destination::Everyone, message(2));
        outbox.send(Destination::Everyone, message(1));
        outbox.last_to(mark);
        let sent: Vec<_> = outbox.take().map(|outgoing| outgoing.message).collect();
        assert_eq!(sent, [message(0), message(1), message(2)].map(Into::into));
        assert_eq!(outbox.take().len(), 0);
    }

    #[test]
    fn a_line_is_said_once_a_second() {
        let mut outbox = Outbox::new(1);
        for time_us in [0, 999_999, 1_000_000] {
            outbox.say(time_us, Severity::Info, "Landed");
        }
        assert_eq!(outbox.take().len(), 2);
        let times: Vec<_> = outbox.take_lines().into_iter().map(|(time_us, ..)| time_us).collect();
        assert_eq!(times, [0, 1_000_000]);
    }
}
