//! From a message to its frame.

use super::{Frame, Message, Version};

impl Frame {
    /// A message as a frame of a sender's system and component; `None` if the version has no place for it.
    pub fn encode(message: &Message, version: Version, sequence: u8, sender: (u8, u8)) -> Option<Self> {
        let mut payload = [0; 255];
        let length = message.serialize(version.into(), &mut payload);
        Self::of_payload(message.id(), payload.get(..length)?, version, sequence, sender)
    }
}
