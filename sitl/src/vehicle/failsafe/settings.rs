//! When a failsafe begins, and what it does.

use serde::{Deserialize, Serialize};

use super::{Action, Cause};

/// Thresholds and actions; the parameters are PX4's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailsafeSettings {
    /// A ground station is lost when none has been heard for this long by the wall clock, s (COM_DL_LOSS_T).
    pub ground_station_timeout_s: f64,
    /// What is done then (NAV_DLL_ACT).
    pub ground_station_lost: Action,
    /// What is done when set-points stop (COM_OBL_RC_ACT).
    pub set_points_lost: Action,
    /// Remaining shares of the battery below which it is low, critical and empty (BAT_LOW_THR, BAT_CRIT_THR, BAT_EMERGEN_THR).
    pub battery_low: f64,
    #[allow(missing_docs)] // With the one above.
    pub battery_critical: f64,
    #[allow(missing_docs)] // With the one above.
    pub battery_emergency: f64,
    /// What a weak battery does (COM_LOW_BAT_ACT).
    pub battery: BatteryPolicy,
    /// What the fence does (GF_ACTION).
    pub fence: Action,
    /// Whether it acts as soon as the vehicle could not stop before the fence, not only beyond it (GF_PREDICT).
    #[serde(default = "yes")]
    pub fence_ahead: bool,
    /// Farthest from home, m; 0: anywhere (GF_MAX_HOR_DIST).
    pub fence_radius_m: f64,
    /// Highest above home, m; 0: any height (GF_MAX_VER_DIST).
    pub fence_height_m: f64,
    /// Strongest wind, m/s; not positive: any (COM_WIND_MAX).
    pub wind_m_s: f64,
    /// What is done in a stronger one (COM_WIND_MAX_ACT).
    pub high_wind: Action,
    /// What is done without an estimate of the place (COM_POSCTL_NAVL).
    pub position_lost: Action,
    /// Whether it descends on the others when a rotor is lost, or stops them, too (COM_ACT_FAIL_ACT).
    pub rotor_failure: Action,
}

/// Records of before it could be chosen have none.
fn yes() -> bool {
    true
}

/// What a weak battery does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum BatteryPolicy {
    /// Nothing but warnings.
    Warn,
    /// Lands when critical.
    Land,
    /// Returns when critical, lands when empty.
    ReturnThenLand,
}

/// PX4's values, but for three: a critical battery returns, an empty one lands, and a failed rotor lands (PX4 warns of all), and the fence
/// is seen ahead (PX4 acts beyond it). A vehicle that is there to be tested shows what it can do.
impl Default for FailsafeSettings {
    fn default() -> Self {
        Self {
            ground_station_timeout_s: 10.0,
            ground_station_lost: Action::None,
            set_points_lost: Action::Hold,
            battery_low: 0.15,
            battery_critical: 0.07,
            battery_emergency: 0.05,
            battery: BatteryPolicy::ReturnThenLand,
            fence: Action::Hold,
            fence_ahead: true,
            fence_radius_m: 0.0,
            fence_height_m: 0.0,
            wind_m_s: -1.0,
            high_wind: Action::Warn,
            position_lost: Action::Land,
            rotor_failure: Action::Land,
        }
    }
}

impl FailsafeSettings {
    /// What is done for a cause.
    pub fn action(&self, cause: Cause) -> Action {
        match cause {
            Cause::RotorFailure => self.rotor_failure,
            Cause::PositionLost => self.position_lost,
            Cause::BatteryEmergency => match self.battery {
                BatteryPolicy::Warn => Action::Warn,
                BatteryPolicy::Land | BatteryPolicy::ReturnThenLand => Action::Land,
            },
            Cause::BatteryCritical => match self.battery {
                BatteryPolicy::Warn => Action::Warn,
                BatteryPolicy::Land => Action::Land,
                BatteryPolicy::ReturnThenLand => Action::Return,
            },
            Cause::BatteryLow => Action::Warn,
            Cause::Fence => self.fence,
            Cause::HighWind => self.high_wind,
            Cause::GroundStationLost => self.ground_station_lost,
            Cause::SetPointsLost => self.set_points_lost,
        }
    }
}
