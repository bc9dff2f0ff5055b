//! Frames out of a stream of bytes.

use super::Frame;
use super::frame::{CHECKSUM_LENGTH, SIGNATURE_LENGTH, SIGNED, Version, extra_crc, message_id};

/// Finds frames in bytes that come in pieces of any size. What is no frame is dropped from its second byte on,
/// so that a frame behind noise is not lost. Never holds more than one incomplete frame.
#[derive(Clone, Debug, Default)]
pub struct FrameDecoder {
    bytes: Vec<u8>,
    rejected_bytes: u64,
}

/// What the bytes begin with.
enum Start {
    Frame(Box<Frame>, usize),
    Incomplete,
    Noise,
}

impl FrameDecoder {
    /// Takes bytes in and returns the frames that are complete now.
    pub fn push(&mut self, bytes: &[u8]) -> Vec<Frame> {
        self.bytes.extend_from_slice(bytes);
        let mut frames = Vec::new();
        let mut position = 0;
        loop {
            match start(self.bytes.get(position..).unwrap_or_default()) {
                Start::Frame(frame, length) => {
                    frames.push(*frame);
                    position += length;
                }
                Start::Noise => {
                    self.rejected_bytes += 1;
                    position += 1;
                }
                Start::Incomplete => break,
            }
        }
        self.bytes.drain(..position.min(self.bytes.len()));
        frames
    }

    /// Frames of one datagram; none crosses from one into the next.
    pub fn datagram(&mut self, bytes: &[u8]) -> Vec<Frame> {
        let mut frames = self.push(bytes);
        frames.extend(self.give_up());
        frames
    }

    /// Nothing more comes: an incomplete frame is none, and may hide a whole one behind its marker.
    pub fn give_up(&mut self) -> Vec<Frame> {
        let mut frames = Vec::new();
        while !self.bytes.is_empty() {
            self.rejected_bytes += 1;
            let rest = self.bytes.split_off(1);
            self.bytes.clear();
            frames.extend(self.push(&rest));
        }
        frames
    }

    /// Bytes of a frame that is not complete yet.
    pub fn waiting_bytes(&self) -> usize {
        self.bytes.len()
    }

    /// Bytes that belonged to no frame so far.
    pub fn rejected_bytes(&self) -> u64 {
        self.rejected_bytes
    }
}

fn start(bytes: &[u8]) -> Start {
    let Some(marker) = bytes.first() else { return Start::Incomplete };
    let Some(version) = Version::of_marker(*marker) else { return Start::Noise };
    let header = version.header_length();
    let (Some(length), true) = (bytes.get(1), bytes.len() >= header) else { return Start::Incomplete };
    let signature = match (version, bytes.get(2)) {
        (Version::One, _) | (Version::Two, Some(0)) => 0,
        (Version::Two, Some(&SIGNED)) => SIGNATURE_LENGTH,
        _ => return Start::Noise,
    };
    // An unknown message cannot be checked: most markers of noise end here, without waiting for its length.
    if extra_crc(message_id(bytes, version)).is_none() {
        return Start::Noise;
    }
    let whole = header + usize::from(*length) + CHECKSUM_LENGTH + signature;
    match bytes.get(..whole) {
        None => Start::Incomplete,
        Some(candidate) => match Frame::parse(candidate) {
            Some(frame) => Start::Frame(Box::new(frame), whole),
            None => Start::Noise,
        },
    }
}
