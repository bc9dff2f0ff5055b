//! How the vehicle conducts itself: its own parameters, beside those of the closed loop.

use serde::{Deserialize, Serialize};

use super::battery_pack::BatteryPack;
use super::crash_settings::CrashSettings;
use super::failsafe::FailsafeSettings;
use super::log_conduct::LogConduct;
use super::simulated::Simulated;
use crate::kept::KeptValues;

/// Parameters of the vehicle's behaviour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conduct {
    /// Height of a takeoff that names none, m.
    pub takeoff_height_m: f64,
    /// Set-points are lost when none has come for this long, s.
    pub set_point_timeout_s: f64,
    /// Height above home of the way home, m.
    pub return_height_m: f64,
    /// Waypoints that name no acceptance radius are passed within this one, m.
    pub acceptance_radius_m: f64,
    /// Nearer to home than this, m, a return lands without climbing.
    pub return_near_m: f64,
    /// Sink rate near the ground, m/s.
    pub land_speed_m_s: f64,
    /// Below this height, m, it sinks with that speed.
    #[serde(default = "two")]
    pub land_slow_below_m: f64,
    /// Sink rate farther up, m/s; 0: the limit.
    #[serde(default)]
    pub land_fast_m_s: f64,
    /// Disarms this long after touch-down, s; not positive: never.
    pub disarm_after_landing_s: f64,
    /// Disarms when not taken off this long after arming, s; not positive: never.
    pub disarm_before_takeoff_s: f64,
    /// Horizontal speed of a full stick, m/s.
    pub stick_speed_m_s: f64,
    /// Climb rate of a full stick, m/s.
    pub stick_climb_m_s: f64,
    /// Sink rate of a full stick, m/s.
    pub stick_sink_m_s: f64,
    /// Sticks are lost when none has come for this long, s.
    pub stick_timeout_s: f64,
    /// Charge of the full battery, A·h.
    pub battery_capacity_ah: f64,
    /// Least remaining share of the battery to arm with.
    pub battery_to_arm: f64,
    /// Whether clients may break units.
    #[serde(default = "yes")]
    pub failure_injection: bool,
    /// When a failsafe begins, and what it does.
    #[serde(default)]
    pub failsafe: FailsafeSettings,
    /// What is simulated around the vehicle.
    #[serde(default)]
    pub simulated: Simulated,
    /// What is kept for scripts and changes nothing.
    #[serde(default)]
    pub kept: KeptValues,
    /// When it counts as crashed.
    #[serde(default)]
    pub crash: CrashSettings,
    /// What is logged, in ArduPilot's convention.
    #[serde(default)]
    pub log: LogConduct,
}

/// Records of before it could be chosen have this one.
fn two() -> f64 {
    2.0
}

/// Records of before there were faults have none.
fn yes() -> bool {
    true
}

/// | parameter | default | reason |
/// | --- | --- | --- |
/// | takeoff height | 2.5 m | PX4's |
/// | set-point timeout | 1 s; ArduPilot 3 s | theirs |
/// | return height | 30 m (ArduPilot 15 m), near 5 m | theirs |
/// | acceptance radius | 2 m | theirs, for copters |
/// | land speed | 0.7 m/s | PX4's |
/// | disarm | 2 s after landing, 10 s before takeoff | PX4's |
/// | sticks | 5 m/s, up 2, down 1.5 m/s, 0.5 s (ArduPilot 3 s) | PX4's, within our limits of speed; the times are theirs |
/// | battery | 2.2 A·h of three cells | half an hour for 0.7 kg |
/// | failure injection | allowed; PX4: not | PX4's parameter protects aircraft, and this is none |
impl Conduct {
    /// The defaults, which differ by convention.
    pub fn new(ardupilot: bool) -> Self {
        Self {
            takeoff_height_m: 2.5,
            set_point_timeout_s: if ardupilot { 3.0 } else { 1.0 },
            return_height_m: if ardupilot { 15.0 } else { 30.0 },
            acceptance_radius_m: 2.0,
            return_near_m: 5.0,
            land_speed_m_s: 0.7,
            land_slow_below_m: two(),
            land_fast_m_s: 0.0,
            disarm_after_landing_s: 2.0,
            disarm_before_takeoff_s: 10.0,
            stick_speed_m_s: 5.0,
            stick_climb_m_s: 2.0,
            stick_sink_m_s: 1.5,
            stick_timeout_s: if ardupilot { 3.0 } else { 0.5 },
            battery_capacity_ah: BatteryPack::default().capacity_ah,
            battery_to_arm: 0.15,
            failure_injection: true,
            failsafe: FailsafeSettings::new(ardupilot),
            simulated: Simulated::default(),
            kept: KeptValues::default(),
            crash: CrashSettings::default(),
            log: LogConduct::default(),
        }
    }
}
