//! Bytes as links bring them: real frames, changed, cut, spliced, in conversations, mixed with noise.

use std::sync::LazyLock;

use autopilot::codec::{Frame, FrameDecoder};
use mavlink::dialects::ardupilotmega::MavMessage;
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

static CORPUS: LazyLock<Vec<Vec<u8>>> = LazyLock::new(|| {
    let bytes = |line: &str| {
        let hex = line.split(' ').nth(1).expect("a name and bytes");
        (0..hex.len()).step_by(2).map(|i| u8::from_str_radix(&hex[i..i + 2], 16).expect("hex")).collect()
    };
    include_str!("../corpus/frames.txt").lines().map(bytes).collect()
});

/// Longest row of frames of the corpus that is played in its order.
const LONGEST_ROW: usize = 16;
/// Numbers that break things.
const NUMBERS: [f32; 10] =
    [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e38, -1e38, 1e-42, -0.0, 0.0, 2_147_483_648.0, -1.0];

/// Bytes made of the corpus. The same seed makes the same.
pub struct Bytes {
    random: Pcg64Mcg,
}

impl Bytes {
    pub fn new(seed: u64) -> Self {
        Self { random: Pcg64Mcg::seed_from_u64(seed) }
    }

    /// A number below an end that is not zero.
    pub fn below(&mut self, end: usize) -> usize {
        (self.random.next_u64() % end.max(1) as u64) as usize
    }

    pub fn noise(&mut self) -> Vec<u8> {
        let length = self.below(400);
        (0..length).map(|_| self.random.next_u64() as u8).collect()
    }

    pub fn real(&mut self) -> Vec<u8> {
        CORPUS[self.below(CORPUS.len())].clone()
    }

    /// A frame that ends anywhere.
    fn cut(&mut self) -> Vec<u8> {
        let mut bytes = self.real();
        bytes.truncate(self.below(bytes.len()));
        bytes
    }

    /// Frames in the order of the corpus, which has conversations: all of them, or one changed, doubled or lost.
    fn row(&mut self) -> Vec<u8> {
        let (start, length) = (self.below(CORPUS.len()), 1 + self.below(LONGEST_ROW));
        let mut row: Vec<Vec<u8>> = CORPUS.iter().skip(start).take(length).cloned().collect();
        let at = self.below(row.len());
        match self.below(5) {
            0 => row[at] = self.changed_from(&row[at].clone()),
            1 => row.insert(at, row[at].clone()),
            2 => drop(row.remove(at)),
            _ => {}
        }
        row.concat()
    }

    /// A whole frame with another content.
    fn changed(&mut self) -> Vec<u8> {
        let real = self.real();
        self.changed_from(&real)
    }

    fn changed_from(&mut self, frame: &[u8]) -> Vec<u8> {
        let frame = Frame::parse(frame).expect("the corpus has frames");
        let mut payload = frame.payload_bytes().to_vec();
        let mut id = frame.message_id();
        for _ in 0..=self.below(4) {
            let at = self.below(payload.len());
            match self.below(6) {
                0 => {
                    if let Some(byte) = payload.get_mut(at) {
                        *byte ^= 1 << (self.random.next_u64() % 8);
                    }
                }
                1 => {
                    let number = NUMBERS[self.below(NUMBERS.len())].to_le_bytes();
                    if let Some(place) = payload.get_mut(at / 4 * 4..at / 4 * 4 + 4) {
                        place.copy_from_slice(&number);
                    }
                }
                2 => {
                    let value = [0, 1, 127, 128, 254, 255][self.below(6)];
                    if let Some(byte) = payload.get_mut(at) {
                        *byte = value;
                    }
                }
                3 => payload.truncate(at),
                4 => {
                    let longer = self.below(256);
                    payload.resize(longer, self.random.next_u64() as u8);
                }
                _ => {
                    let other = Frame::parse(&self.real()).expect("the corpus has frames");
                    id = other.message_id();
                }
            }
        }
        let version = if id < 256 && self.below(4) == 0 { 1 } else { 2 };
        let sender = [self.random.next_u64() as u8, 250 + self.below(6) as u8, 190];
        framed(version, sender, id, &payload)
    }

    /// Anything.
    pub fn piece(&mut self) -> Vec<u8> {
        match self.below(12) {
            0 => self.noise(),
            1 => self.cut(),
            2 => {
                // Changed anywhere, the checksum left as it is.
                let mut bytes = self.real();
                let at = self.below(bytes.len());
                bytes[at] ^= 1 << self.below(8);
                bytes
            }
            3 => {
                // The head of one and the tail of another.
                let (mut bytes, other) = (self.real(), self.real());
                bytes.truncate(self.below(bytes.len()));
                bytes.extend(&other[self.below(other.len())..]);
                bytes
            }
            4 => [self.noise(), self.real(), self.changed()].concat(),
            5 | 6 => self.real(),
            7 | 8 => self.row(),
            _ => self.changed(),
        }
    }

    /// A datagram that means nothing to the vehicle: noise, a frame with a wrong checksum, one that is cut, one for
    /// another system.
    pub fn garbage(&mut self) -> Vec<u8> {
        let bytes = match self.below(4) {
            0 => self.noise(),
            1 => self.cut(),
            2 => {
                let mut bytes = self.changed();
                let last = bytes.len() - 1;
                bytes[last] ^= 1 + self.below(255) as u8;
                bytes
            }
            _ => {
                // COMMAND_LONG that disarms by force, for system 99.
                let mut payload = command(400, [0.0, 21196.0, 0.0]);
                payload[30] = 99;
                return framed(2, [0, 255, 190], 76, &payload);
            }
        };
        // A frame hidden in noise would be one.
        if FrameDecoder::default().datagram(&bytes).is_empty() { bytes } else { Vec::new() }
    }
}

pub fn command(number: u16, [a, b, c]: [f32; 3]) -> Vec<u8> {
    let filler = if a.is_nan() { f32::NAN } else { 0.0 };
    let mut payload: Vec<u8> =
        [a, b, c, filler, filler, filler, filler].iter().flat_map(|value| value.to_le_bytes()).collect();
    payload.extend(number.to_le_bytes());
    payload.extend([1, 1, 0]);
    payload
}

pub fn position_target([x, y, z]: [f32; 3]) -> Vec<u8> {
    let mut payload = vec![0; 4];
    let numbers = [x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    payload.extend(numbers.iter().flat_map(|value| value.to_le_bytes()));
    payload.extend(0b1001_1111_1000_u16.to_le_bytes());
    payload.extend([1, 1, 1]);
    payload
}

/// A frame with its checksum; of an unknown message with a wrong one.
pub fn framed(version: u8, [sequence, system, component]: [u8; 3], id: u32, payload: &[u8]) -> Vec<u8> {
    let [low, middle, high, _] = id.to_le_bytes();
    let length = payload.len().min(255);
    let mut bytes = match version {
        1 => vec![0xfe, length as u8, sequence, system, component, low],
        _ => vec![0xfd, length as u8, 0, 0, sequence, system, component, low, middle, high],
    };
    bytes.extend(&payload[..length]);
    let extra = <MavMessage as mavlink::Message>::extra_crc(id);
    let checksum = mavlink::calculate_crc(&bytes[1..], extra);
    bytes.extend(checksum.to_le_bytes());
    bytes
}
