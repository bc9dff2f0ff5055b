//! What is done when the radio is lost.

use serde::{Deserialize, Serialize};

/// The actions of both autopilots (FS_THR_ENABLE, NAV_RCL_ACT).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum RadioLossAction {
    /// Nothing: the sticks count as centred.
    None,
    /// Holds its place.
    Hold,
    /// Flies home and lands.
    Return,
    /// Lands where it is.
    Land,
    /// Flies home the way that it came, or else straight.
    TraceOrReturn,
    /// Flies home the way that it came, or else lands.
    TraceOrLand,
    /// Goes on with the landing of the mission, or else flies home.
    MissionLandingOrReturn,
    /// Brakes, or else lands.
    BrakeOrLand,
    /// Stops the rotors.
    Terminate,
    /// Disarms.
    Disarm,
}
