//! SETUP_SIGNING: a new key, from a local link only.

use autopilot::codec::Frame;

use crate::signing::{SecretKey, Signing};

/// An attempt to change the key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SigningSetup {
    /// System and component that set a key.
    Set(u8, u8),
    /// System and component that removed it: a key of zeros.
    Removed(u8, u8),
    /// It came from afar.
    Refused(u8, u8),
}

/// First byte of the key in the message.
const KEY: usize = 10;

fn key(frame: &Frame) -> Option<SecretKey> {
    SecretKey::new(frame.payload().bytes(KEY))
}

impl SigningSetup {
    /// What a frame attempts.
    pub(super) fn of(frame: &Frame, local: bool) -> Self {
        let (system, component) = (frame.system(), frame.component());
        match key(frame) {
            _ if !local => Self::Refused(system, component),
            Some(_) => Self::Set(system, component),
            None => Self::Removed(system, component),
        }
    }

    /// Does it.
    pub(super) fn act(self, signing: &mut Signing, frame: &Frame) {
        if !matches!(self, Self::Refused(..)) {
            signing.set_key(key(frame), frame.payload().u64(0));
        }
    }
}

impl std::fmt::Display for SigningSetup {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Set(system, component) => write!(formatter, "Signing: key set by {system}/{component}"),
            Self::Removed(system, component) => {
                write!(formatter, "Signing: key removed by {system}/{component}")
            }
            Self::Refused(system, component) => {
                write!(formatter, "Signing: key from {system}/{component} refused: link is not local")
            }
        }
    }
}
