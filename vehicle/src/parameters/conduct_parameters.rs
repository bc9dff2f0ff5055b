//! The vehicle's own parameters by their identifiers.

use crate::vehicle::{Action, BatteryActions, Conduct};

/// A parameter of the vehicle's behaviour.
#[derive(Clone, Copy, Debug)]
pub struct ConductParameter {
    /// Identifier by PX4's convention.
    pub id: &'static str,
    /// ArduPilot's name for the same thing, and how many of its units one of ours is.
    pub ardupilot: Option<(&'static str, f64)>,
    /// Whether only whole numbers are allowed.
    pub integer: bool,
    /// Smallest value, in our units.
    pub minimum: f64,
    /// Largest value, in our units.
    pub maximum: f64,
    /// Reads it.
    pub get: fn(&Conduct) -> f64,
    /// Writes it, unchecked; `false` when the value means nothing.
    pub set: fn(&mut Conduct, f64) -> bool,
}

macro_rules! real {
    ($id:literal, $ardupilot:expr, $minimum:literal..=$maximum:literal, $($field:ident).+) => {
        real!($id, $ardupilot, $minimum..=$maximum, $($field).+, 1.0)
    };
    ($id:literal, $ardupilot:expr, $minimum:literal..=$maximum:literal, $($field:ident).+, $scale:expr) => {
        ConductParameter {
            id: $id,
            ardupilot: $ardupilot,
            integer: false,
            minimum: $minimum,
            maximum: $maximum,
            get: |conduct| conduct.$($field).+ * $scale,
            set: |conduct, value| {
                conduct.$($field).+ = value / $scale;
                true
            },
        }
    };
}

/// One of a few meanings with numbers; the first one stands for what has none.
macro_rules! choice {
    ($id:literal, $meanings:ident, $($field:ident).+) => {
        ConductParameter {
            id: $id,
            ardupilot: None,
            integer: true,
            minimum: 0.0,
            maximum: 7.0,
            get: |conduct| {
                let meaning = $meanings.iter().find(|(known, _)| *known == conduct.$($field).+);
                meaning.map_or(0.0, |(_, number)| f64::from(*number))
            },
            set: |conduct, value| {
                let meaning = $meanings.iter().find(|(_, number)| f64::from(*number) == value);
                if let Some((meaning, _)) = meaning {
                    conduct.$($field).+ = *meaning;
                }
                meaning.is_some()
            },
        }
    };
}

/// Off (0) or on (1).
macro_rules! switch {
    ($id:literal, $($field:ident).+) => {
        ConductParameter {
            id: $id,
            ardupilot: None,
            integer: true,
            minimum: 0.0,
            maximum: 1.0,
            get: |conduct| f64::from(u8::from(conduct.$($field).+)),
            set: |conduct, value| {
                let means = value == 0.0 || value == 1.0;
                if means {
                    conduct.$($field).+ = value == 1.0;
                }
                means
            },
        }
    };
}

/// A whole number.
macro_rules! whole {
    ($id:literal, $minimum:literal..=$maximum:literal, $($field:ident).+, $kind:ty) => {
        ConductParameter {
            id: $id,
            ardupilot: None,
            integer: true,
            minimum: $minimum as f64,
            maximum: $maximum as f64,
            get: |conduct| f64::from(conduct.$($field).+),
            set: |conduct, value| {
                let whole = value.fract() == 0.0 && ($minimum as f64..=$maximum as f64).contains(&value);
                if whole {
                    conduct.$($field).+ = value as $kind;
                }
                whole
            },
        }
    };
}

pub(super) use {choice, switch, whole};

/// The vehicle's own parameters.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static CONDUCT_PARAMETERS: &[ConductParameter] = &[
    real!("MIS_TAKEOFF_ALT", Some(("PILOT_TKOFF_ALT", 100.0)), 0.5..=1000.0, takeoff_height_m),
    real!("COM_OF_LOSS_T", Some(("GUID_TIMEOUT", 1.0)), 0.1..=60.0, set_point_timeout_s),
    choice!("COM_OBL_RC_ACT", SET_POINTS_ACTIONS, failsafe.set_points_lost),
    real!("COM_DL_LOSS_T", Some(("FS_GCS_TIMEOUT", 1.0)), 1.0..=300.0, failsafe.ground_station_timeout_s),
    choice!("NAV_DLL_ACT", GROUND_STATION_ACTIONS, failsafe.ground_station_lost),
    real!("BAT_LOW_THR", None, 0.0..=0.9, failsafe.battery_low),
    real!("BAT_CRIT_THR", None, 0.0..=0.9, failsafe.battery_critical),
    real!("BAT_EMERGEN_THR", None, 0.0..=0.9, failsafe.battery_emergency),
    choice!("COM_LOW_BAT_ACT", BATTERY_POLICIES, failsafe.battery),
    choice!("GF_ACTION", FENCE_ACTIONS, failsafe.fence),
    switch!("GF_PREDICT", failsafe.fence_ahead),
    real!("GF_MAX_HOR_DIST", Some(("FENCE_RADIUS", 1.0)), 0.0..=100_000.0, failsafe.fence_radius_m),
    real!("GF_MAX_VER_DIST", Some(("FENCE_ALT_MAX", 1.0)), 0.0..=10_000.0, failsafe.fence_height_m),
    real!("COM_WIND_MAX", None, -1.0..=50.0, failsafe.wind_m_s),
    choice!("COM_WIND_MAX_ACT", FENCE_ACTIONS, failsafe.high_wind),
    choice!("COM_POSCTL_NAVL", POSITION_ACTIONS, failsafe.position_lost),
    choice!("COM_ACT_FAIL_ACT", ROTOR_ACTIONS, failsafe.rotor_failure),
    real!("RTL_RETURN_ALT", Some(("RTL_ALT", 100.0)), 1.0..=1000.0, return_height_m),
    real!("NAV_ACC_RAD", Some(("WPNAV_RADIUS", 100.0)), 0.1..=1000.0, acceptance_radius_m),
    real!("RTL_MIN_DIST", None, 0.5..=1000.0, return_near_m),
    real!("MPC_LAND_SPEED", Some(("LAND_SPEED", 100.0)), 0.1..=3.0, land_speed_m_s),
    real!("COM_DISARM_LAND", None, -1.0..=600.0, disarm_after_landing_s),
    real!("COM_DISARM_PRFLT", Some(("DISARM_DELAY", 1.0)), -1.0..=600.0, disarm_before_takeoff_s),
    real!("MPC_VEL_MANUAL", Some(("LOIT_SPEED", 100.0)), 0.1..=50.0, stick_speed_m_s),
    real!("MPC_Z_V_MAN_UP", Some(("PILOT_SPEED_UP", 100.0)), 0.1..=20.0, stick_climb_m_s),
    real!("MPC_Z_V_MAN_DN", Some(("PILOT_SPEED_DN", 100.0)), 0.1..=20.0, stick_sink_m_s),
    real!("COM_RC_LOSS_T", Some(("RC_FS_TIMEOUT", 1.0)), 0.1..=60.0, stick_timeout_s),
    real!("BAT1_CAPACITY", Some(("BATT_CAPACITY", 1.0)), 10.0..=1e6, battery_capacity_ah, 1000.0),
    real!("COM_ARM_BAT_MIN", None, 0.0..=0.9, battery_to_arm),
    switch!("SYS_FAILURE_EN", failure_injection),
    real!("FD_FAIL_R", None, 0.0..=180.0, crash.roll_rad, DEGREES),
    real!("FD_FAIL_P", None, 0.0..=180.0, crash.pitch_rad, DEGREES),
    real!("FD_FAIL_R_TTRI", None, 0.02..=5.0, crash.roll_s),
    real!("FD_FAIL_P_TTRI", None, 0.02..=5.0, crash.pitch_s),
    real!("COM_LKDOWN_TKO", None, -1.0..=5.0, crash.lockdown_s),
    whole!("CBRK_FLIGHTTERM", 0..=121_212, crash.circuit_breaker, u32),
];

/// Of a radian.
const DEGREES: f64 = 180.0 / core::f64::consts::PI;

/// PX4's numbers of the actions of each parameter.
const SET_POINTS_ACTIONS: &[(Action, i32)] = &[
    (Action::Position, 0),
    (Action::Return, 3),
    (Action::Land, 4),
    (Action::Hold, 5),
    (Action::Terminate, 6),
];
const GROUND_STATION_ACTIONS: &[(Action, i32)] =
    &[(Action::None, 0), (Action::Hold, 1), (Action::Return, 2), (Action::Land, 3), (Action::Terminate, 5)];
const FENCE_ACTIONS: &[(Action, i32)] = &[
    (Action::None, 0),
    (Action::Warn, 1),
    (Action::Hold, 2),
    (Action::Return, 3),
    (Action::Terminate, 4),
    (Action::Land, 5),
];
const POSITION_ACTIONS: &[(Action, i32)] = &[(Action::Warn, 0), (Action::Land, 1), (Action::Terminate, 2)];
const ROTOR_ACTIONS: &[(Action, i32)] = &[(Action::Land, 2), (Action::Terminate, 4)];
const BATTERY_POLICIES: &[(BatteryActions, i32)] =
    &[(BatteryActions::WARN, 0), (BatteryActions::LAND, 2), (BatteryActions::RETURN_THEN_LAND, 3)];
