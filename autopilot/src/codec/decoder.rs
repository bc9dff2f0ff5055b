//! Frames out of a stream of bytes.

use super::Frame;
use super::frame::{CHECKSUM_LENGTH, SIGNATURE_LENGTH, SIGNED, Version, extra_crc, message_id};

/// Most places of one [`FrameDecoder::step`]: noise can be made so that each place costs the checksum of a whole frame.
const PLACES: usize = 64;

/// Finds frames in bytes that come in pieces of any size. What is no frame is dropped from its second byte on,
/// so that a frame behind noise is not lost. Once all is decoded, it holds no more than one incomplete frame.
#[derive(Clone, Debug, Default)]
pub struct FrameDecoder {
    bytes: Vec<u8>,
    /// Where the bytes begin that are not decoded yet.
    position: usize,
    rejected_bytes: u64,
}

/// What a bounded piece of decoding has found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Decoded {
    /// A frame.
    Frame(Frame),
    /// No frame so far; there are more bytes to decode.
    Noise,
    /// Nothing more until more bytes come.
    Starved,
}

/// What the bytes begin with.
enum Start {
    Frame(Box<Frame>, usize),
    Incomplete,
    Noise,
}

impl FrameDecoder {
    /// Takes bytes in, to be decoded by [`Self::step`].
    pub fn feed(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    /// Decodes up to the next frame, but only a bounded number of bytes. With `ended` no more bytes follow: an incomplete
    /// frame is none, and may hide a whole one behind its marker.
    pub fn step(&mut self, ended: bool) -> Decoded {
        for _ in 0..PLACES {
            match start(self.bytes.get(self.position..).unwrap_or_default()) {
                Start::Frame(frame, length) => {
                    self.position += length;
                    return Decoded::Frame(*frame);
                }
                Start::Incomplete if !ended || self.waiting_bytes() == 0 => {
                    self.bytes.drain(..self.position);
                    self.position = 0;
                    return Decoded::Starved;
                }
                Start::Incomplete | Start::Noise => {
                    self.rejected_bytes += 1;
                    self.position += 1;
                }
            }
        }
        Decoded::Noise
    }

    fn frames(&mut self, ended: bool) -> Vec<Frame> {
        let mut frames = Vec::new();
        loop {
            match self.step(ended) {
                Decoded::Frame(frame) => frames.push(frame),
                Decoded::Noise => {}
                Decoded::Starved => return frames,
            }
        }
    }

    /// Takes bytes in and returns the frames that are complete now.
    pub fn push(&mut self, bytes: &[u8]) -> Vec<Frame> {
        self.feed(bytes);
        self.frames(false)
    }

    /// Frames of one datagram; none crosses from one into the next.
    pub fn datagram(&mut self, bytes: &[u8]) -> Vec<Frame> {
        self.feed(bytes);
        self.frames(true)
    }

    /// Bytes that are not decoded yet, or belong to a frame that is not complete.
    pub fn waiting_bytes(&self) -> usize {
        self.bytes.len().saturating_sub(self.position)
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
