//! Parameters of the way home.

use serde::{Deserialize, Serialize};

/// Which places a return may go to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ReturnGoal {
    /// The nearest of home and the rally points.
    #[default]
    Nearest,
    /// The nearest rally point; home if there is none.
    RallyPoint,
    /// The nearest of home, a landing of the mission and the rally points: as [`Self::Nearest`], since missions have no landings to
    /// be joined.
    NearestOfAll,
    /// The nearest rally point, whatever else there is; home if there is none.
    RallyPointOnly,
    /// Home while the battery lasts for it, else the nearest rally point: as [`Self::Nearest`], which is what PX4 does in a simulation,
    /// where it has no time that the battery lasts.
    WithinReach,
    /// On along the mission to its landing, else back along it to home.
    Mission,
    /// As [`Self::Mission`], or back along it also where it has a landing, whichever passes fewer items.
    MissionOrBack,
}

impl ReturnGoal {
    /// Whether rally points go before home.
    pub fn prefers_rally_points(self) -> bool {
        matches!(self, Self::RallyPoint | Self::RallyPointOnly)
    }
}

/// Parameters of the way home beside its height.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct ReturnSettings {
    /// Where it goes.
    pub goal: ReturnGoal,
    /// Height above the place at which it waits before it lands, m (PX4).
    pub wait_height_m: f64,
    /// Whether its height is above the ground instead, which its way follows then (ArduPilot).
    pub above_ground: bool,
    /// How long it waits above the place, s; negative: it stays there (PX4).
    pub wait_s: f64,
    /// Height above home at which it stays in the end, m; 0: it lands (ArduPilot).
    pub final_height_m: f64,
    /// Speed, m/s; 0: that of missions (ArduPilot).
    pub speed_m_s: f64,
    /// Least climb before it travels, m (ArduPilot).
    pub least_climb_m: f64,
    /// Height per distance above which it need not climb near home; below 0.5 there is no such cone (ArduPilot).
    pub cone_slope: f64,
    /// Options, as the parameter adds them up (ArduPilot).
    pub options: u8,
    /// Half of the angle of the cone above home within which it need not climb to its full height, rad; 0: there is none (PX4).
    pub cone_rad: f64,
}

impl ReturnSettings {
    /// The defaults, which differ by convention. Flights that were recorded before there were such parameters have zeros.
    pub fn new(ardupilot: bool) -> Self {
        let none = Self::default();
        if ardupilot {
            return Self { wait_s: 5.0, cone_slope: 3.0, ..none };
        }
        Self { wait_height_m: 10.0, cone_rad: 45_f64.to_radians(), ..none }
    }
}
