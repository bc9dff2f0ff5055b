//! STATUSTEXT: lines for the pilot.

use mavlink::dialects::common::{MavMessage, MavSeverity, STATUSTEXT_DATA};
use vehicle::Severity;

/// Characters of one message.
const CHUNK: usize = 50;
/// The same line is not sent again for this long, µs: refused set-points come many times a second.
const REPEAT_US: u64 = 1_000_000;
/// Lines that are remembered for that.
const REMEMBERED: usize = 8;
/// Lines that wait for a log.
const MOST_UNLOGGED: usize = 64;

/// A line for the log: simulation time, µs, importance and text.
pub type Line = (u64, Severity, String);

/// What was said lately.
#[derive(Clone, Debug)]
pub struct StatusTexts {
    system_id: u8,
    said: Vec<(String, u64)>,
    next_id: u16,
    unlogged: Vec<Line>,
}

impl StatusTexts {
    /// Nothing was said yet.
    pub fn new(system_id: u8) -> Self {
        Self { system_id, said: Vec::new(), next_id: 0, unlogged: Vec::new() }
    }

    /// A line in as many messages as it needs; none if the same was said a moment ago.
    pub fn say(&mut self, time_us: u64, severity: Severity, text: &str) -> Vec<MavMessage> {
        if self.said.iter().any(|(said, when_us)| said == text && time_us < when_us + REPEAT_US) {
            return Vec::new();
        }
        self.said.retain(|(said, when_us)| said != text && time_us < when_us + REPEAT_US);
        self.said.truncate(REMEMBERED - 1);
        self.said.push((text.to_owned(), time_us));
        if self.unlogged.len() >= MOST_UNLOGGED {
            self.unlogged.remove(0);
        }
        self.unlogged.push((time_us, severity, text.to_owned()));
        let system = self.system_id;
        match severity {
            Severity::Info => tracing::info!(system, "{text}"),
            Severity::Warning => tracing::warn!(system, "{text}"),
            Severity::Critical | Severity::Error => tracing::error!(system, "{text}"),
        }
        messages(severity, text, &mut self.next_id)
    }

    /// Lines since the last call, as many as are remembered.
    pub fn take_unlogged(&mut self) -> Vec<Line> {
        std::mem::take(&mut self.unlogged)
    }
}

/// A line in pieces; `next_id` numbers the lines that need several.
pub fn messages(severity: Severity, text: &str, next_id: &mut u16) -> Vec<MavMessage> {
    let severity = match severity {
        Severity::Critical => MavSeverity::MAV_SEVERITY_CRITICAL,
        Severity::Error => MavSeverity::MAV_SEVERITY_ERROR,
        Severity::Warning => MavSeverity::MAV_SEVERITY_WARNING,
        Severity::Info => MavSeverity::MAV_SEVERITY_INFO,
    };
    // The field is bytes; what is no ASCII would be cut in the middle of a character.
    let bytes: Vec<u8> =
        text.chars().map(|letter| if letter.is_ascii() { letter as u8 } else { b'?' }).collect();
    let long = bytes.len() > CHUNK;
    // Zero means that the text is whole.
    let id = if long {
        *next_id = next_id.wrapping_add(1).max(1);
        *next_id
    } else {
        0
    };
    let chunk = |(sequence, piece): (usize, &[u8])| {
        let mut text = [0; CHUNK];
        for (byte, letter) in text.iter_mut().zip(piece) {
            *byte = *letter;
        }
        MavMessage::STATUSTEXT(STATUSTEXT_DATA { severity, text: text.into(), id, chunk_seq: sequence as u8 })
    };
    let mut messages: Vec<_> = bytes.chunks(CHUNK).enumerate().map(chunk).collect();
    // A piece without a zero says that more follows.
    if long && bytes.len().is_multiple_of(CHUNK) {
        messages.push(chunk((messages.len(), &[])));
    }
    messages
}
