//! From a message to its frames.

use super::frame::{CHECKSUM_LENGTH, extra_crc};
use super::{Frame, Message, Version};

/// A message as a version of the protocol writes it, to be framed for one peer after the other: they differ in the number of the frame.
#[derive(Clone, Debug)]
pub struct Encoded {
    id: u32,
    version: Version,
    /// Seed of the checksum.
    extra: u8,
    payload: [u8; 255],
    length: u8,
}

impl Encoded {
    /// `None` if the version has no place for the message.
    pub fn new(message: &Message, version: Version) -> Option<Self> {
        let (id, mut payload) = (message.id(), [0; 255]);
        if version == Version::One && id > u32::from(u8::MAX) {
            return None;
        }
        let length = u8::try_from(message.serialize(version.into(), &mut payload)).ok()?;
        Some(Self { id, version, extra: extra_crc(id)?, payload, length })
    }

    /// Version of the protocol.
    pub fn version(&self) -> Version {
        self.version
    }

    /// Bytes of each of its frames, before they are signed.
    pub fn frame_length(&self) -> usize {
        self.version.header_length() + usize::from(self.length) + CHECKSUM_LENGTH
    }

    /// Its frame from a sender's system and component, in a buffer whose bytes are not needed any more.
    pub fn frame(&self, sequence: u8, (system, component): (u8, u8), mut buffer: Vec<u8>) -> Frame {
        let [low, middle, high, _] = self.id.to_le_bytes();
        let header = [self.length, 0, 0, sequence, system, component, low, middle, high];
        buffer.clear();
        buffer.push(self.version.marker());
        match self.version {
            Version::One => buffer.extend([self.length, sequence, system, component, low]),
            Version::Two => buffer.extend(header),
        }
        buffer.extend_from_slice(self.payload.get(..usize::from(self.length)).unwrap_or_default());
        Frame::finish(buffer, self.version, self.extra)
    }
}

impl Frame {
    /// A message as a frame of a sender's system and component; `None` if the version has no place for it.
    pub fn encode(message: &Message, version: Version, sequence: u8, sender: (u8, u8)) -> Option<Self> {
        let encoded = Encoded::new(message, version)?;
        let buffer = Vec::with_capacity(encoded.frame_length());
        Some(encoded.frame(sequence, sender, buffer))
    }
}
