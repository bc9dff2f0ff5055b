//! The vehicle's own parameters that have one meaning in both identities, by their identifiers.

use super::ConductParameter;
use super::conduct_parameter::{choice, real, switch};
use crate::vehicle::Action;

/// The vehicle's own parameters.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static CONDUCT_PARAMETERS: &[ConductParameter] = &[
    real!("MIS_TAKEOFF_ALT", None, 0.5..=1000.0, takeoff_height_m, "m", "Height above home of a takeoff without an altitude of its own"),
    real!("COM_OF_LOSS_T", Some(("GUID_TIMEOUT", 1.0)), 0.1..=600.0, set_point_timeout_s, "s", "Time without set-points after which they count as lost"),
    choice!("COM_OBL_RC_ACT", SET_POINTS_ACTIONS, failsafe.set_points_lost, "Action when set-points are lost"),
    real!("COM_DL_LOSS_T", Some(("FS_GCS_TIMEOUT", 1.0)), 1.0..=300.0, failsafe.ground_station_timeout_s, "s", "Time without heartbeats after which the ground station counts as lost"),
    real!("BAT_LOW_THR", None, 0.0..=0.9, failsafe.battery_low, "norm", "Remaining charge at which the battery is low"),
    real!("BAT_CRIT_THR", None, 0.0..=0.9, failsafe.battery_critical, "norm", "Remaining charge at which the battery is critical"),
    real!("BAT_EMERGEN_THR", None, 0.0..=0.9, failsafe.battery_emergency, "norm", "Remaining charge at which the battery is almost empty"),
    switch!("GF_PREDICT", failsafe.fence_ahead, "Act as soon as the vehicle could no longer stop before the fence", ["Beyond the fence only", "Ahead of it"]),
    real!("COM_WIND_MAX", None, -1.0..=50.0, failsafe.wind_m_s, "m/s", "Wind speed that is too high to fly in; negative disables the check"),
    choice!("COM_WIND_MAX_ACT", FENCE_ACTIONS, failsafe.high_wind, "Action when the wind is too high"),
    choice!("COM_ACT_FAIL_ACT", ROTOR_ACTIONS, failsafe.rotor_failure, "Action when a rotor fails"),
    real!("RTL_RETURN_ALT", Some(("RTL_ALT", 100.0)), 1.0..=1000.0, return_height_m, "m", "Height above home at which the vehicle returns").also(&[("RTL_ALT_M", 1.0)]),
    real!("NAV_ACC_RAD", Some(("WPNAV_RADIUS", 100.0)), 0.1..=1000.0, acceptance_radius_m, "m", "Acceptance radius of waypoints without one of their own").also(&[("WP_RADIUS_M", 1.0)]),
    real!("RTL_MIN_DIST", None, 0.5..=1000.0, return_near_m, "m", "Distance from home within which a return climbs within its cone only"),
    real!("MPC_LAND_ALT2", Some(("LAND_ALT_LOW", 100.0)), 0.5..=100.0, land_slow_below_m, "m", "Height below which a landing has its slow speed").also(&[("LAND_ALT_LOW_M", 1.0)]),
    real!("MPC_LAND_SPEED", Some(("LAND_SPEED", 100.0)), 0.1..=3.0, land_speed_m_s, "m/s", "Descent rate near the ground").also(&[("LAND_SPD_MS", 1.0)]),
    real!("COM_DISARM_LAND", None, -1.0..=600.0, disarm_after_landing_s, "s", "Delay from touch-down to automatic disarming; 0 or less disables it"),
    real!("COM_DISARM_PRFLT", Some(("DISARM_DELAY", 1.0)), -1.0..=600.0, disarm_before_takeoff_s, "s", "Delay from arming without a takeoff to automatic disarming; 0 or less disables it"),
    real!("MPC_VEL_MANUAL", Some(("LOIT_SPEED", 100.0)), 0.1..=50.0, stick_speed_m_s, "m/s", "Horizontal speed at full stick deflection").also(&[("LOIT_SPEED_MS", 1.0)]),
    real!("MPC_Z_V_MAN_UP", Some(("PILOT_SPEED_UP", 100.0)), 0.1..=20.0, stick_climb_m_s, "m/s", "Climb rate at full stick deflection").also(&[("PILOT_SPD_UP", 1.0)]),
    real!("MPC_Z_V_MAN_DN", Some(("PILOT_SPEED_DN", 100.0)), 0.0..=20.0, stick_sink_m_s, "m/s", "Descent rate at full stick deflection; 0: as upwards").also(&[("PILOT_SPD_DN", 1.0)]),
    real!("COM_RC_LOSS_T", Some(("RC_FS_TIMEOUT", 1.0)), 0.1..=120.0, stick_timeout_s, "s", "Time without stick inputs after which they count as lost"),
    real!("BAT1_CAPACITY", Some(("BATT_CAPACITY", 1.0)), 10.0..=1e6, battery_capacity_ah, 1000.0, "mAh", "Capacity of the battery"),
    real!("COM_ARM_BAT_MIN", None, 0.0..=0.9, battery_to_arm, "norm", "Smallest remaining charge with which the vehicle arms"),
    switch!("SYS_FAILURE_EN", failure_injection, "Allow failure injection by command"),
];

/// PX4's numbers of the actions of each parameter.
const SET_POINTS_ACTIONS: &[(Action, i32, &str)] = &[
    (Action::Position, 0, "Position mode"),
    (Action::Altitude, 1, "Altitude mode"),
    (Action::Stabilize, 2, "Stabilized mode"),
    (Action::Return, 3, "Return"),
    (Action::Land, 4, "Land"),
    (Action::Hold, 5, "Hold"),
    (Action::Terminate, 6, "Terminate"),
    (Action::Disarm, 7, "Disarm"),
];
pub(super) const FENCE_ACTIONS: &[(Action, i32, &str)] = &[
    (Action::None, 0, "Nothing"),
    (Action::Warn, 1, "Warn"),
    (Action::Hold, 2, "Hold"),
    (Action::Return, 3, "Return"),
    (Action::Terminate, 4, "Terminate"),
    (Action::Land, 5, "Land"),
];
const ROTOR_ACTIONS: &[(Action, i32, &str)] = &[
    (Action::Warn, 0, "Warn"),
    (Action::Hold, 1, "Hold"),
    (Action::Land, 2, "Land"),
    (Action::Return, 3, "Return"),
    (Action::Terminate, 4, "Terminate"),
];
