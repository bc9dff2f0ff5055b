//! The vehicle's own parameters by their identifiers.

use crate::vehicle::{Conduct, SetPointLossAction};

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
    ($id:literal, $ardupilot:expr, $minimum:literal..=$maximum:literal, $field:ident) => {
        real!($id, $ardupilot, $minimum..=$maximum, $field, 1.0)
    };
    ($id:literal, $ardupilot:expr, $minimum:literal..=$maximum:literal, $field:ident, $scale:literal) => {
        ConductParameter {
            id: $id,
            ardupilot: $ardupilot,
            integer: false,
            minimum: $minimum,
            maximum: $maximum,
            get: |conduct| conduct.$field * $scale,
            set: |conduct, value| {
                conduct.$field = value / $scale;
                true
            },
        }
    };
}

/// The vehicle's own parameters.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static CONDUCT_PARAMETERS: &[ConductParameter] = &[
    real!("MIS_TAKEOFF_ALT", Some(("PILOT_TKOFF_ALT", 100.0)), 0.5..=1000.0, takeoff_height_m),
    real!("COM_OF_LOSS_T", Some(("GUID_TIMEOUT", 1.0)), 0.1..=60.0, set_point_timeout_s),
    ConductParameter {
        id: "COM_OBL_RC_ACT",
        ardupilot: None,
        integer: true,
        minimum: 0.0,
        maximum: 5.0,
        get: |conduct| f64::from(action_number(conduct.set_point_loss)),
        set: |conduct, value| {
            let action = ACTIONS.iter().find(|(_, number)| f64::from(*number) == value);
            if let Some((action, _)) = action {
                conduct.set_point_loss = *action;
            }
            action.is_some()
        },
    },
    real!("RTL_RETURN_ALT", Some(("RTL_ALT", 100.0)), 1.0..=1000.0, return_height_m),
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
    ConductParameter {
        id: "SYS_FAILURE_EN",
        ardupilot: None,
        integer: true,
        minimum: 0.0,
        maximum: 1.0,
        get: |conduct| f64::from(u8::from(conduct.failure_injection)),
        set: |conduct, value| {
            conduct.failure_injection = value == 1.0;
            true
        },
    },
];

/// PX4's numbers of the actions.
const ACTIONS: [(SetPointLossAction, i32); 4] = [
    (SetPointLossAction::Position, 0),
    (SetPointLossAction::Return, 3),
    (SetPointLossAction::Land, 4),
    (SetPointLossAction::Hold, 5),
];

fn action_number(action: SetPointLossAction) -> i32 {
    ACTIONS.iter().find(|(known, _)| *known == action).map_or(5, |(_, number)| *number)
}
