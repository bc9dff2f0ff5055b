//! Speeds that PX4's parameters set beside those of automatic flight.

use serde::{Deserialize, Serialize};

/// Bounds of speed in all modes, and the speeds near the ground.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SpeedSettings {
    /// Largest speeds in all modes, m/s: horizontally, up, down; `None`: those of automatic flight (MPC_XY_VEL_MAX, MPC_Z_VEL_MAX_UP,
    /// MPC_Z_VEL_MAX_DN).
    pub most_m_s: [Option<f64>; 3],
    /// What sets the horizontal speeds together, m/s; negative: nothing (MPC_XY_VEL_ALL).
    pub all_horizontal_m_s: f64,
    /// What sets the vertical ones together, m/s; negative: nothing (MPC_Z_VEL_ALL).
    pub all_vertical_m_s: f64,
    /// Climb rate of a takeoff near the ground, m/s (MPC_TKO_SPEED).
    pub takeoff_m_s: f64,
    /// Height above the ground from which a takeoff climbs, and a landing no longer sinks, as anywhere else, m (MPC_LAND_ALT1).
    pub slow_below_m: f64,
    /// Height that a rangefinder shows below which a landing crawls, m (MPC_LAND_ALT3).
    pub crawl_below_m: f64,
    /// Sink rate there, m/s (MPC_LAND_CRWL).
    pub crawl_m_s: f64,
}

impl Default for SpeedSettings {
    fn default() -> Self {
        Self {
            most_m_s: [None; 3],
            all_horizontal_m_s: -10.0,
            all_vertical_m_s: -3.0,
            takeoff_m_s: 1.5,
            slow_below_m: 10.0,
            crawl_below_m: 1.0,
            crawl_m_s: 0.3,
        }
    }
}
