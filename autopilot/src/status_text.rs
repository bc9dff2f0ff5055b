//! STATUSTEXT: lines for the pilot.

use mavlink::dialects::ardupilotmega::{MavMessage, MavSeverity, STATUSTEXT_DATA};
use vehicle::Severity;

use crate::codec::ascii::ascii;

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

    /// Forgets what was said lately.
    pub fn forget(&mut self) {
        self.said.clear();
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
    let pieces = pieces(text);
    // Zero means that the text is whole.
    let id = if pieces.len() > 1 {
        *next_id = next_id.wrapping_add(1).max(1);
        *next_id
    } else {
        0
    };
    let chunk = |(sequence, text): (usize, [u8; CHUNK])| {
        MavMessage::STATUSTEXT(STATUSTEXT_DATA { severity, text: text.into(), id, chunk_seq: sequence as u8 })
    };
    pieces.into_iter().enumerate().map(chunk).collect()
}

/// A text in pieces that clients join as they are: words may be cut, since each blank that filled a piece up would be shown.
///
/// A piece that holds a zero is the last one.
fn pieces(text: &str) -> Vec<[u8; CHUNK]> {
    // The field is bytes; a character that is not ASCII would be cut in the middle.
    let text = ascii(text);
    let letters = text.as_bytes();
    let mut pieces: Vec<_> = letters.chunks(CHUNK).map(padded).collect();
    // An empty one ends what fills its pieces, unless it is whole in one.
    if pieces.is_empty() || pieces.len() > 1 && letters.len().is_multiple_of(CHUNK) {
        pieces.push([0; CHUNK]);
    }
    pieces
}

fn padded(piece: &[u8]) -> [u8; CHUNK] {
    let mut text = [0; CHUNK];
    for (byte, letter) in text.iter_mut().zip(piece) {
        *byte = *letter;
    }
    text
}

#[cfg(test)]
mod tests {
    use proptest::prelude::{prop_assert, prop_assert_eq, proptest};

    use super::{CHUNK, pieces};

    fn shown(text: &str) -> Vec<String> {
        let readable = |piece: [u8; CHUNK]| String::from_utf8_lossy(&piece).trim_end_matches('\0').to_owned();
        pieces(text).into_iter().map(readable).collect()
    }

    #[test]
    fn a_text_is_cut_where_a_piece_is_full() {
        assert_eq!(shown("Ready"), ["Ready"]);
        assert_eq!(shown(""), [""]);
        assert_eq!(shown(&"x".repeat(50)), ["x".repeat(50)]);
        assert_eq!(shown(&"x".repeat(100)), ["x".repeat(50), "x".repeat(50), String::new()]);
        let text = "Mission rejected: item 12: SET_CAMERA_MODE (530): not supported";
        assert_eq!(shown(text), ["Mission rejected: item 12: SET_CAMERA_MODE (530): ", "not supported"]);
    }

    proptest! {
        /// A client that joins the pieces reads the same, and sees where the text ends.
        #[test]
        fn nothing_is_lost_and_nothing_added(text in "[a-z ]{0,200}") {
            let pieces = pieces(&text);
            let joined: String = pieces.iter().flatten().filter(|byte| **byte != 0).map(|byte| *byte as char).collect();
            prop_assert_eq!(joined, text);
            let (last, before) = pieces.split_last().expect("a piece");
            prop_assert!(before.iter().all(|piece| !piece.contains(&0)));
            prop_assert!(last.contains(&0) || before.is_empty());
        }
    }
}
