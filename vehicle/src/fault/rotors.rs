//! Which rotors.

use serde::{Deserialize, Serialize};

/// One rotor, or all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Rotors {
    /// All four.
    All,
    /// The front one.
    Front,
    /// The right one.
    Right,
    /// The back one.
    Back,
    /// The left one.
    Left,
}

impl Rotors {
    /// One by its number, 1 to 4 in the order of SERVO_OUTPUT_RAW; all by 0.
    pub fn numbered(number: u32) -> Option<Self> {
        [Self::All, Self::Front, Self::Right, Self::Back, Self::Left]
            .into_iter()
            .find(|rotors| rotors.number() == number)
    }

    /// Its number.
    pub fn number(self) -> u32 {
        match self {
            Self::All => 0,
            Self::Front => 1,
            Self::Right => 2,
            Self::Back => 3,
            Self::Left => 4,
        }
    }

    /// Whether the rotor with an index of 0 to 3 is one of them.
    pub fn contains(self, index: usize) -> bool {
        self == Self::All || self.number() as usize == index + 1
    }
}
