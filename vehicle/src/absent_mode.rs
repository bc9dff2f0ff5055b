//! Modes of both autopilots that this vehicle does not have, and what to use instead.

use crate::identity::Identity;

/// A mode that is known and not there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AbsentMode {
    /// Its number in HEARTBEAT.
    number: u32,
    /// Its name.
    pub name: &'static str,
    /// What to use instead.
    pub instead: &'static str,
}

const fn absent(number: u32, name: &'static str, instead: &'static str) -> AbsentMode {
    AbsentMode { number, name, instead }
}

/// PX4's automatic modes by their sub-modes.
const fn auto(sub: u32, name: &'static str, instead: &'static str) -> AbsentMode {
    absent(4 << 16 | sub << 24, name, instead)
}

const NO_TUNING: &str =
    "the controllers are designed from the airframe and need no tuning; set the airframe's parameters";
const NO_EXTERNAL: &str = "no external mode is registered; send set-points in Offboard";

const PX4: &[AbsentMode] = &[
    absent(3 << 16 | 2 << 24, "Position Slow", "use Position with a smaller MPC_VEL_MANUAL"),
    auto(9, "Precision Land", "there is no landing target; use Land"),
    auto(10, "VTOL Takeoff", "this is a quadrotor; use Takeoff"),
    auto(11, "External 1", NO_EXTERNAL),
    auto(12, "External 2", NO_EXTERNAL),
    auto(13, "External 3", NO_EXTERNAL),
    auto(14, "External 4", NO_EXTERNAL),
    auto(15, "External 5", NO_EXTERNAL),
    auto(16, "External 6", NO_EXTERNAL),
    auto(17, "External 7", NO_EXTERNAL),
    auto(18, "External 8", NO_EXTERNAL),
];

const ARDUPILOT: &[AbsentMode] = &[
    absent(11, "Drift", "use Loiter"),
    absent(15, "AutoTune", NO_TUNING),
    absent(19, "Avoid_ADSB", "use Guided"),
    absent(22, "FlowHold", "there is no optical flow; use Loiter"),
    absent(25, "SystemID", "send the signals by SET_ATTITUDE_TARGET in Guided"),
    absent(26, "Autorotate", "this is a quadrotor; use Land"),
    absent(28, "Turtle", "the vehicle cannot lie upside down; restart it"),
];

impl Identity {
    /// The mode of a custom mode that such an autopilot has and this vehicle has not.
    pub fn absent_mode(self, custom_mode: u32) -> Option<AbsentMode> {
        let modes = if self.is_ardupilot() { ARDUPILOT } else { PX4 };
        modes.iter().find(|mode| mode.number == custom_mode && self.mode(custom_mode).is_none()).copied()
    }
}
