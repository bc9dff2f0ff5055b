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
    /// Hands over to the sticks, and holds its height.
    Altitude,
    /// Hands over to the sticks, which lean it.
    Stabilize,
    /// Holds its place.
    Hold,
    /// The same, or without a place lands.
    BrakeOrLand,
    /// Flies home, or to a nearer rally point, and lands.
    Return,
    /// Flies home the way that it came, or else straight.
    TraceOrReturn,
    /// Goes on with the landing of the mission, or else flies home.
    MissionLandingOrReturn,
    /// Flies home the way that it came, or else lands.
    TraceOrLand,
    /// Lands where it is; without an estimate of its place level, by its sink rate.
    Land,
    /// Stops the rotors.
    Disarm,
    /// Stops the rotors, for good.
    Terminate,
}

impl Action {
    /// All actions.
    pub const ALL: [Self; 14] = [
        Self::None,
        Self::Warn,
        Self::Position,
        Self::Altitude,
        Self::Stabilize,
        Self::Hold,
        Self::BrakeOrLand,
        Self::Return,
        Self::TraceOrReturn,
        Self::MissionLandingOrReturn,
        Self::TraceOrLand,
        Self::Land,
        Self::Disarm,
        Self::Terminate,
    ];

    /// The mode that carries it out, if nothing is missing for it; `None` for what is no mode.
    pub fn mode(self) -> Option<Mode> {
        match self {
            Self::None | Self::Warn | Self::Disarm | Self::Terminate => None,
            Self::Position => Some(Mode::Position),
            Self::Altitude => Some(Mode::Altitude),
            Self::Stabilize => Some(Mode::Stabilize),
            Self::Hold | Self::BrakeOrLand => Some(Mode::Hold),
            Self::Return => Some(Mode::Return),
            Self::TraceOrReturn | Self::TraceOrLand => Some(Mode::SmartReturn),
            Self::MissionLandingOrReturn => Some(Mode::Mission),
            Self::Land => Some(Mode::Land),
        }
    }

    /// Whether it flies a planned way home, or to a landing: the others brake where they are.
    pub fn plans_a_way(self) -> bool {
        matches!(self.mode(), Some(Mode::Return | Mode::SmartReturn | Mode::Mission))
    }

    /// What is done without the pilot.
    pub fn without_pilot(action: RadioLossAction) -> Self {
        match action {
            RadioLossAction::None => Self::None,
            RadioLossAction::Hold => Self::Hold,
            RadioLossAction::BrakeOrLand => Self::BrakeOrLand,
            RadioLossAction::Return => Self::Return,
            RadioLossAction::TraceOrReturn => Self::TraceOrReturn,
            RadioLossAction::TraceOrLand => Self::TraceOrLand,
            RadioLossAction::MissionLandingOrReturn => Self::MissionLandingOrReturn,
            RadioLossAction::Land => Self::Land,
            RadioLossAction::Disarm => Self::Disarm,
            RadioLossAction::Terminate => Self::Terminate,
        }
    }

    /// The action that a mode is already: a return is not called off to hold, a landing not to return.
    pub fn of_mode(mode: Mode) -> Self {
        match mode {
            Mode::Return => Self::Return,
            Mode::SmartReturn => Self::TraceOrReturn,
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
            Self::Altitude => "switching to altitude mode",
            Self::Stabilize => "switching to stabilized mode",
            Self::Hold | Self::BrakeOrLand => "holding",
            Self::Return => "returning",
            Self::TraceOrReturn | Self::TraceOrLand => "returning along its path",
            Self::MissionLandingOrReturn => "flying to the mission's landing",
            Self::Land => "landing",
            Self::Disarm => "disarming",
            Self::Terminate => "stopping the rotors",
        }
    }
}
