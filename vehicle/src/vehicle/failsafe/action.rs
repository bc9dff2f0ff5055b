//! What a failsafe does.

use serde::{Deserialize, Serialize};

use crate::mode::Mode;
use crate::radio::RadioLossAction;

/// Actions, the mildest first: a worse one goes before a milder one, never the other way round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Action {
    /// Nothing.
    None,
    /// Tells the pilot.
    Warn,
    /// Hands over to the sticks.
    Position,
    /// Holds its place.
    Hold,
    /// Flies home, or to a nearer rally point, and lands.
    Return,
    /// Lands where it is; without an estimate of its place level, by its sink rate.
    Land,
    /// Stops the rotors.
    Terminate,
}

impl Action {
    /// All actions.
    pub const ALL: [Self; 7] =
        [Self::None, Self::Warn, Self::Position, Self::Hold, Self::Return, Self::Land, Self::Terminate];

    /// The mode that carries it out; `None` for what is no mode.
    pub fn mode(self) -> Option<Mode> {
        match self {
            Self::None | Self::Warn | Self::Terminate => None,
            Self::Position => Some(Mode::Position),
            Self::Hold => Some(Mode::Hold),
            Self::Return => Some(Mode::Return),
            Self::Land => Some(Mode::Land),
        }
    }

    /// What is done without the pilot.
    pub fn without_pilot(action: RadioLossAction) -> Self {
        match action {
            RadioLossAction::None => Self::None,
            RadioLossAction::Hold | RadioLossAction::BrakeOrLand => Self::Hold,
            RadioLossAction::Return
            | RadioLossAction::TraceOrReturn
            | RadioLossAction::TraceOrLand
            | RadioLossAction::MissionLandingOrReturn => Self::Return,
            RadioLossAction::Land => Self::Land,
            RadioLossAction::Terminate | RadioLossAction::Disarm => Self::Terminate,
        }
    }

    /// The action that a mode is already: a return is not called off to hold, a landing not to return.
    pub fn of_mode(mode: Mode) -> Self {
        match mode {
            Mode::Return | Mode::SmartReturn => Self::Return,
            Mode::Land => Self::Land,
            _ => Self::None,
        }
    }

    /// What the vehicle is doing, for the pilot.
    pub fn doing(self) -> &'static str {
        match self {
            Self::None => "no action",
            Self::Warn => "warning only",
            Self::Position => "switching to position mode",
            Self::Hold => "holding",
            Self::Return => "returning",
            Self::Land => "landing",
            Self::Terminate => "stopping the rotors",
        }
    }
}
