//! Whether a mission waits for the heading that a waypoint asks for: PX4's MIS_YAW_ERR and MIS_YAW_TMT.

use serde::{Deserialize, Serialize};

use super::motion::wrapped;

/// How exactly the nose must point, and whether that is waited for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MissionHeading {
    /// So near to its heading, rad, the nose is there.
    pub error_rad: f64,
    /// Positive: nothing is waited for. That is what PX4 does about headings that nothing enforces.
    pub timeout_s: f64,
}

impl Default for MissionHeading {
    fn default() -> Self {
        Self { error_rad: 12_f64.to_radians(), timeout_s: -1.0 }
    }
}

/// After a turn the nose swings in for about this long, s.
const SETTLING_S: f64 = 1.0;

impl MissionHeading {
    /// Whether waypoints are left only with the heading that they ask for.
    pub fn waits(&self) -> bool {
        self.timeout_s <= 0.0
    }

    /// Whether the nose is where it is to be.
    pub fn is_met(&self, wanted_rad: f64, yaw_rad: f64) -> bool {
        wrapped(wanted_rad - yaw_rad).abs() < self.error_rad
    }

    /// Whether a turn, rad, at a rate, rad/s, takes longer than a way of so many seconds.
    pub fn outlasts(&self, turn_rad: f64, rate_rad_s: f64, way_s: f64) -> bool {
        let left_rad = wrapped(turn_rad).abs() - self.error_rad;
        left_rad > 0.0 && left_rad / rate_rad_s + SETTLING_S > way_s
    }
}

#[cfg(test)]
mod tests {
    use super::MissionHeading;

    #[test]
    fn a_turn_outlasts_a_short_way_and_the_allowed_error_is_no_turn() {
        let heading = MissionHeading::default();
        let degrees = f64::to_radians;
        // 180° less 12° at 42°/s: 4 s, and one to settle.
        assert!(heading.outlasts(degrees(180.0), degrees(42.0), 4.9));
        assert!(!heading.outlasts(degrees(180.0), degrees(42.0), 5.1));
        assert!(!heading.outlasts(degrees(-11.0), degrees(42.0), 0.1));
        assert!(heading.is_met(degrees(179.0), degrees(-171.0)) && !heading.is_met(0.0, degrees(13.0)));
        assert!(!MissionHeading { timeout_s: 5.0, ..heading }.waits());
    }
}
