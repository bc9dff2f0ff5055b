//! One MAVLink frame, version 1 or 2.

use mavlink::dialects::ardupilotmega::MavMessage;
use mavlink::{MAV_STX, MAV_STX_V2, MavlinkVersion, Message as _};

use super::Payload;
use super::frame_check::frame_check;

/// Version of the protocol on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// MAVLink 1.
    One,
    /// MAVLink 2.
    Two,
}

/// Flag of incompatibility: the frame ends in a signature of 13 bytes.
pub(super) const SIGNED: u8 = 1;
pub(super) const SIGNATURE_LENGTH: usize = 13;
const TAG_LENGTH: usize = 6;
pub(super) const CHECKSUM_LENGTH: usize = 2;

impl Version {
    /// Bytes before the payload.
    pub(super) fn header_length(self) -> usize {
        match self {
            Self::One => 6,
            Self::Two => 10,
        }
    }

    pub(super) fn marker(self) -> u8 {
        match self {
            Self::One => MAV_STX,
            Self::Two => MAV_STX_V2,
        }
    }

    pub(super) fn of_marker(marker: u8) -> Option<Self> {
        match marker {
            MAV_STX => Some(Self::One),
            MAV_STX_V2 => Some(Self::Two),
            _ => None,
        }
    }
}

impl From<Version> for MavlinkVersion {
    fn from(version: Version) -> Self {
        match version {
            Version::One => Self::V1,
            Version::Two => Self::V2,
        }
    }
}

/// A whole frame of a message of the common dialect, with a right checksum.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    bytes: Vec<u8>,
    version: Version,
    /// End of the payload.
    end: usize,
}

impl Frame {
    /// The frame that `bytes` are exactly, if they are one.
    pub fn parse(bytes: &[u8]) -> Option<Self> {
        let version = Version::of_marker(*bytes.first()?)?;
        let header = version.header_length();
        let end = header + usize::from(*bytes.get(1)?);
        let signature = match version {
            Version::One => 0,
            Version::Two => match *bytes.get(2)? {
                0 => 0,
                SIGNED => SIGNATURE_LENGTH,
                // Whoever does not know a flag of incompatibility drops the frame.
                _ => return None,
            },
        };
        if bytes.len() != end + CHECKSUM_LENGTH + signature {
            return None;
        }
        let frame = Self { bytes: bytes.to_vec(), version, end };
        let extra = extra_crc(frame.message_id())?;
        let told = u16::from_le_bytes(Payload::new(bytes).bytes(end));
        (frame_check(bytes.get(1..end)?, extra) == told).then_some(frame)
    }

    /// Puts the checksum, which begins with a seed, behind header and payload.
    pub(super) fn finish(mut bytes: Vec<u8>, version: Version, extra: u8) -> Self {
        let end = bytes.len();
        let checksum = frame_check(bytes.get(1..).unwrap_or_default(), extra);
        bytes.extend(checksum.to_le_bytes());
        Self { bytes, version, end }
    }

    /// The frame as it is on the wire.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The buffer of a frame that is not needed any more.
    pub fn into_buffer(self) -> Vec<u8> {
        self.bytes
    }

    /// Version of the protocol.
    pub fn version(&self) -> Version {
        self.version
    }

    /// Number of the frame among those of its sender on a link.
    pub fn sequence(&self) -> u8 {
        self.byte(match self.version {
            Version::One => 2,
            Version::Two => 4,
        })
    }

    /// Identifier of the sending system.
    pub fn system(&self) -> u8 {
        self.byte(match self.version {
            Version::One => 3,
            Version::Two => 5,
        })
    }

    /// Identifier of the sending component.
    pub fn component(&self) -> u8 {
        self.byte(match self.version {
            Version::One => 4,
            Version::Two => 6,
        })
    }

    /// Identifier of the message.
    pub fn message_id(&self) -> u32 {
        message_id(&self.bytes, self.version)
    }

    /// The payload.
    pub fn payload(&self) -> Payload<'_> {
        Payload::new(self.payload_bytes())
    }

    /// Bytes of the payload, trailing zeros perhaps cut off.
    pub fn payload_bytes(&self) -> &[u8] {
        self.bytes.get(self.version.header_length()..self.end).unwrap_or_default()
    }

    fn byte(&self, offset: usize) -> u8 {
        Payload::new(&self.bytes).u8(offset)
    }
}

/// What a signed frame ends in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signature {
    /// Number that its sender gave the link.
    pub link: u8,
    /// Units of 10 µs since 2015-01-01, 48 bits.
    pub timestamp: u64,
    /// Beginning of the hash over key and frame.
    pub tag: [u8; TAG_LENGTH],
}

impl Frame {
    /// The signature, if there is one.
    pub fn signature(&self) -> Option<Signature> {
        let bytes = Payload::new(&self.bytes);
        let at = self.end + CHECKSUM_LENGTH;
        (self.bytes.len() == at + SIGNATURE_LENGTH).then(|| {
            let [a, b, c, d, e, f] = bytes.bytes(at + 1);
            let timestamp = u64::from_le_bytes([a, b, c, d, e, f, 0, 0]);
            Signature { link: bytes.u8(at), timestamp, tag: bytes.bytes(at + 7) }
        })
    }

    /// What a signature covers beside the key: everything before its tag.
    pub fn covered_bytes(&self) -> &[u8] {
        self.bytes.get(..self.end + CHECKSUM_LENGTH + SIGNATURE_LENGTH - TAG_LENGTH).unwrap_or_default()
    }

    /// The frame with a signature, whose tag is made of what it covers. MAVLink 1 has no signatures: such a frame, and
    /// one that is signed already, stays as it is.
    pub fn sign(mut self, link: u8, timestamp: u64, tag: impl FnOnce(&[u8]) -> [u8; TAG_LENGTH]) -> Self {
        if self.version == Version::One || self.signature().is_some() {
            return self;
        }
        if let Some(flags) = self.bytes.get_mut(2) {
            *flags |= SIGNED;
        }
        self.bytes.truncate(self.end);
        let Some(extra) = extra_crc(self.message_id()) else { return self };
        let checksum = frame_check(self.bytes.get(1..).unwrap_or_default(), extra);
        self.bytes.extend(checksum.to_le_bytes());
        self.bytes.push(link);
        self.bytes.extend(timestamp.to_le_bytes().iter().take(6));
        let tag = tag(&self.bytes);
        self.bytes.extend(tag);
        self
    }
}

/// Identifier of the message of a frame of which at least the header is there.
pub(super) fn message_id(bytes: &[u8], version: Version) -> u32 {
    let bytes = Payload::new(bytes);
    match version {
        Version::One => u32::from(bytes.u8(5)),
        Version::Two => bytes.u32(7) & 0x00ff_ffff,
    }
}

/// The seed of the checksum, which identifies the layout of a message; `None` for an unknown one.
pub(super) fn extra_crc(message_id: u32) -> Option<u8> {
    // The dialect answers zero for an unknown message, and one known message has a zero.
    let extra = MavMessage::extra_crc(message_id);
    (extra != 0 || MavMessage::default_message_from_id(message_id).is_some()).then_some(extra)
}
