//! SETUP_SIGNING: who may change the key, and when.

use autopilot::codec::Frame;

use crate::signing::{SecretKey, Signing};

/// First byte of the key in the message.
const KEY: usize = 10;

/// What the program lets clients do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SetupRules {
    /// Whether anybody may set a key while there is none: `--accept-signing-setup`.
    pub without_key: bool,
    /// Whether a vehicle is armed.
    pub armed: bool,
}

/// Why the key stays as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SetupRefusal {
    /// It came over a network.
    #[error("not a local link; use loopback or serial")]
    NotLocal,
    /// There is no key, so that anybody could have sent it.
    #[error("restart with --accept-signing-setup to allow it")]
    NotAllowed,
    /// It would cut off pilots in flight.
    #[error("armed; disarm first")]
    Armed,
    /// Timestamps would begin more than a minute ahead of the clock.
    #[error("initial_timestamp is ahead of the clock; set the clocks")]
    Early,
}

/// An attempt to change the key, and the system and component that made it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SigningSetup {
    /// A key is set.
    Set(u8, u8),
    /// The key is removed: it was one of zeros.
    Removed(u8, u8),
    /// Nothing has changed.
    Refused(u8, u8, SetupRefusal),
}

impl SigningSetup {
    /// Carries out what a frame asks for, if it may. Where there is a key, the frame is signed with it: others do not get here.
    pub(super) fn carry_out(frame: &Frame, local: bool, rules: SetupRules, signing: &mut Signing) -> Self {
        let (system, component) = (frame.system(), frame.component());
        let key = SecretKey::new(frame.payload().bytes(KEY));
        match refusal(local, rules, signing) {
            Some(refusal) => Self::Refused(system, component, refusal),
            // What is said with a key of zeros about timestamps has no meaning.
            None if key.is_none() => {
                signing.set_key(None);
                Self::Removed(system, component)
            }
            None if signing.start_from(frame.payload().u64(0)) => {
                signing.set_key(key);
                Self::Set(system, component)
            }
            None => Self::Refused(system, component, SetupRefusal::Early),
        }
    }

    /// Whether the key is another one now.
    pub fn is_change(&self) -> bool {
        !matches!(self, Self::Refused(..))
    }
}

fn refusal(local: bool, rules: SetupRules, signing: &Signing) -> Option<SetupRefusal> {
    if !local {
        Some(SetupRefusal::NotLocal)
    } else if !signing.is_on() && !rules.without_key {
        Some(SetupRefusal::NotAllowed)
    } else {
        rules.armed.then_some(SetupRefusal::Armed)
    }
}

impl std::fmt::Display for SigningSetup {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Set(system, component) => write!(formatter, "Signing: key set by {system}/{component}"),
            Self::Removed(system, component) => {
                write!(formatter, "Signing: key removed by {system}/{component}")
            }
            Self::Refused(system, component, refusal) => {
                write!(formatter, "Signing: setup by {system}/{component} refused: {refusal}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use autopilot::codec::{Frame, Version};
    use mavlink::dialects::ardupilotmega::{MavMessage, SETUP_SIGNING_DATA};

    use super::{SetupRefusal, SetupRules, SigningSetup};
    use crate::signing::{Kept, MOST_AHEAD, SecretKey, Signing};

    /// Some day of the year 2026.
    const NOW: u64 = 37_000_000_000_000;

    fn setup(key: u8, initial_timestamp: u64) -> Frame {
        let setup = SETUP_SIGNING_DATA {
            initial_timestamp,
            target_system: 1,
            target_component: 1,
            secret_key: [key; 32],
        };
        let message = MavMessage::SETUP_SIGNING(setup).into();
        Frame::encode(&message, Version::Two, 0, (255, 190)).expect("a message of MAVLink 2")
    }

    /// Every combination of place, flag, state and key in use.
    #[test]
    fn a_key_is_set_locally_disarmed_and_only_where_it_was_asked_for() {
        for (local, without_key, armed, has_key) in
            (0..16).map(|bits: u8| (bits & 1 > 0, bits & 2 > 0, bits & 4 > 0, bits & 8 > 0))
        {
            let old = has_key.then(|| SecretKey::new([7; 32])).flatten();
            let mut signing = Signing::new(old.clone(), Kept::default());
            signing.set_clock(NOW);
            let rules = SetupRules { without_key, armed };
            let expected = match (local, has_key || without_key, armed) {
                (false, ..) => Err(SetupRefusal::NotLocal),
                (_, false, _) => Err(SetupRefusal::NotAllowed),
                (.., true) => Err(SetupRefusal::Armed),
                _ => Ok(()),
            };
            let done = SigningSetup::carry_out(&setup(8, NOW), local, rules, &mut signing);
            match expected {
                Ok(()) => {
                    assert_eq!(done, SigningSetup::Set(255, 190));
                    assert_eq!(signing.key(), SecretKey::new([8; 32]).as_ref());
                    let removal = SigningSetup::carry_out(&setup(0, u64::MAX), local, rules, &mut signing);
                    assert_eq!((removal, signing.is_on()), (SigningSetup::Removed(255, 190), false));
                }
                Err(refusal) => {
                    assert_eq!(done, SigningSetup::Refused(255, 190, refusal));
                    assert_eq!(signing.key(), old.as_ref(), "{done}");
                }
            }
        }
    }

    #[test]
    fn timestamps_begin_at_most_a_minute_ahead_however_often_they_are_set() {
        let mut signing = Signing::default();
        signing.set_clock(NOW);
        let rules = SetupRules { without_key: true, armed: false };
        let mut set = |timestamp| SigningSetup::carry_out(&setup(7, timestamp), true, rules, &mut signing);
        let refused = SigningSetup::Refused(255, 190, SetupRefusal::Early);
        assert_eq!(set(NOW + MOST_AHEAD + 1), refused);
        assert_eq!(set(u64::MAX), refused);
        assert!(set(NOW + MOST_AHEAD).is_change());
        assert_eq!(set(NOW + 2 * MOST_AHEAD), refused);
        assert!(set(0).is_change());
        let sent = signing.sign(setup(1, 0), 0).signature().expect("signed").timestamp;
        assert_eq!(sent, NOW + MOST_AHEAD + 1);
    }
}
