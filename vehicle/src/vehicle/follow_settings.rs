//! How a target is followed.

use serde::{Deserialize, Serialize};

/// What the height is measured from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum FollowHeight {
    /// Home.
    Home,
    /// The ground below.
    Ground,
    /// The target.
    Target,
}

/// Where the nose points in ArduPilot's follow mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum FollowHeading {
    /// It is not turned.
    Hold,
    /// To the target.
    Target,
    /// As that of the target.
    SameAsTarget,
    /// Along the flight.
    Travel,
}

/// Parameters of following: the first part PX4's, the second ArduPilot's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FollowSettings {
    /// Height, m.
    pub height_m: f64,
    /// Horizontal distance, m.
    pub distance_m: f64,
    /// Where it follows, rad, clockwise from where the target goes: π is behind it.
    pub angle_rad: f64,
    /// What the height is measured from.
    pub height: FollowHeight,
    /// How much of a surprise is ignored, 0 to 1.
    pub smoothing: f64,
    /// Share of that trust which the velocity has, 0 to 1.
    pub velocity_gain: f64,
    /// Fastest on the way around the target, m/s.
    pub around_m_s: f64,
    /// Whether ArduPilot's mode can be entered.
    pub enabled: bool,
    /// System id of the target; 0: the first one that is heard.
    pub system_id: u8,
    /// A target that is farther away, m, is not followed; 0: any is.
    pub farthest_m: f64,
    /// Whether the offset turns with the target.
    pub offset_turns: bool,
    /// From the target to the vehicle, m: to the north, or ahead of the target. All three zero: as it is when the mode begins.
    pub offset_x_m: f64,
    /// To the east, or to the right of the target, m.
    pub offset_y_m: f64,
    /// Down, m.
    pub offset_z_m: f64,
    /// Where the nose points.
    pub heading: FollowHeading,
    /// Whether heights of targets count from home, not from sea level.
    pub relative_height: bool,
}

/// Those of both autopilots.
impl Default for FollowSettings {
    fn default() -> Self {
        Self {
            height_m: 8.0,
            distance_m: 8.0,
            angle_rad: core::f64::consts::PI,
            height: FollowHeight::Home,
            smoothing: 0.1,
            velocity_gain: 0.9,
            around_m_s: 5.0,
            enabled: false,
            system_id: 0,
            farthest_m: 100.0,
            offset_turns: false,
            offset_x_m: 0.0,
            offset_y_m: 0.0,
            offset_z_m: 0.0,
            heading: FollowHeading::Target,
            relative_height: true,
        }
    }
}
