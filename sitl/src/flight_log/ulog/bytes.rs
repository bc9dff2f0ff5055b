//! The bytes of ULog, as docs.px4.io describes them: a header, definitions, then data.

use vehicle::parameters::Value;

/// "ULog", three more bytes, and version 1.
const MAGIC: [u8; 8] = [0x55, 0x4c, 0x6f, 0x67, 0x01, 0x12, 0x35, 1];
/// Where readers find their way again behind damage.
const SYNC: [u8; 8] = [0x2f, 0x73, 0x13, 0x20, 0x25, 0x0c, 0xbb, 0x12];

/// Appends a message of a kind, in pieces. What is longer than a message can be is cut.
fn message(into: &mut Vec<u8>, kind: u8, pieces: &[&[u8]]) {
    let length: usize = pieces.iter().map(|piece| piece.len()).sum();
    let length = length.min(usize::from(u16::MAX));
    into.extend((length as u16).to_le_bytes());
    into.push(kind);
    into.extend(pieces.iter().flat_map(|piece| piece.iter()).take(length));
}

/// Bytes of the message that some bytes begin with.
pub fn entry_length(bytes: &[u8]) -> Option<usize> {
    let [low, high, _kind, ..] = bytes else { return None };
    Some(3 + usize::from(u16::from_le_bytes([*low, *high])))
}

/// Appends a message of a key with its type, and a value.
fn keyed(into: &mut Vec<u8>, kind: u8, key: &str, value: &[u8]) {
    message(into, kind, &[&[key.len() as u8], key.as_bytes(), value]);
}

/// What stands before the data.
#[derive(Clone, Debug, Default)]
pub struct Definitions {
    bytes: Vec<u8>,
    subscriptions: Vec<u8>,
    topics: u16,
}

impl Definitions {
    /// Of a log that begins at a time, µs.
    pub fn new(time_us: u64) -> Self {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(time_us.to_le_bytes());
        // No flag is set, and nothing is appended.
        message(&mut bytes, b'B', &[&[0; 40]]);
        Self { bytes, subscriptions: Vec::new(), topics: 0 }
    }

    /// A text about the whole log.
    pub fn information(&mut self, key: &str, value: &str) {
        keyed(&mut self.bytes, b'I', &format!("char[{}] {key}", value.len()), value.as_bytes());
    }

    /// A number about the whole log.
    pub fn number(&mut self, key: &str, value: u32) {
        keyed(&mut self.bytes, b'I', &format!("uint32_t {key}"), &value.to_le_bytes());
    }

    /// A topic and its fields (`uint64_t timestamp;float x;`); its data come under the number that is returned.
    pub fn topic(&mut self, name: &str, fields: &str) -> u16 {
        let number = self.topics;
        self.topics += 1;
        message(&mut self.bytes, b'F', &[name.as_bytes(), b":", fields.as_bytes()]);
        message(&mut self.subscriptions, b'A', &[&[0], &number.to_le_bytes(), name.as_bytes()]);
        number
    }

    /// A parameter; it may come among the data, too.
    pub fn parameter(&mut self, id: &str, value: Value) {
        parameter(&mut self.bytes, id, value);
    }

    /// All of it: what follows are data.
    pub fn finish(mut self) -> Vec<u8> {
        self.bytes.append(&mut self.subscriptions);
        self.bytes
    }
}

/// A parameter with its value.
pub fn parameter(into: &mut Vec<u8>, id: &str, value: Value) {
    let kind = match value {
        Value::Real(_) => "float",
        Value::Integer(_) => "int32_t",
    };
    keyed(into, b'P', &format!("{kind} {id}"), &value.bytes());
}

/// A sample of a topic.
pub fn data(into: &mut Vec<u8>, topic: u16, row: &[u8]) {
    message(into, b'D', &[&topic.to_le_bytes(), row]);
}

/// A line of text; the level is that of syslog.
pub fn text(into: &mut Vec<u8>, level: u8, time_us: u64, line: &str) {
    message(into, b'L', &[&[b'0' + level], &time_us.to_le_bytes(), line.as_bytes()]);
}

/// Data of so many milliseconds are missing here.
pub fn dropout(into: &mut Vec<u8>, duration_ms: u64) {
    let duration = u16::try_from(duration_ms).unwrap_or(u16::MAX);
    message(into, b'O', &[&duration.to_le_bytes()]);
}

/// A mark to go on from.
pub fn sync(into: &mut Vec<u8>) {
    message(into, b'S', &[&SYNC]);
}
