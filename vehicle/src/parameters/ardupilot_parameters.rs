//! Failsafes and fence by ArduPilot's names and numbers.

use core::convert::identity;

use super::ConductParameter;
use super::conduct_parameter::{bitmask, choice, real, switch, whole};
use crate::radio::RadioLossAction;
use crate::vehicle::{Action, Conduct, FenceDatum, FenceOptions, FenceParts, FenceStart};

/// Parameters that ArduPilot has in place of those of PX4 with other numbers.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static ARDUPILOT_PARAMETERS: &[ConductParameter] = &[
    whole!("MAV_GCS_SYSID", 1..=255, ground_stations.first, u8, "System id of the ground station whose heartbeats, overrides and MANUAL_CONTROL count").also(&[("SYSID_MYGCS", 1.0)]),
    whole!("MAV_GCS_SYSID_HI", 0..=255, ground_stations.last, u8, "Last system id of such ground stations; less than MAV_GCS_SYSID: only that one"),
    switch!("FENCE_ENABLE", failsafe.fence_enabled, "Enable the fence"),
    bitmask!("FENCE_TYPE", FENCE_PARTS, failsafe.fence_parts, bits, parts, "Enabled parts of the fence"),
    bitmask!("FENCE_OPTIONS", FENCE_OPTIONS, failsafe.fence_options, option_bits, options, "Options of the fence"),
    real!("FENCE_ALT_MAX", None, -1.0..=10_000.0, failsafe.fence_height_m, "m", "Height of the fence above FENCE_ALT_MAX_TP; 0 disables it, a negative one forbids arming"),
    choice!("FENCE_ALT_MAX_TP", FENCE_DATUMS, failsafe.fence_height_from, "What FENCE_ALT_MAX is above"),
    real!("FENCE_ALT_MIN", None, -1000.0..=10_000.0, failsafe.fence_floor_m, "m", "Lowest height above FENCE_ALT_MIN_TP, once the vehicle has been above it, except for landings"),
    choice!("FENCE_ALT_MIN_TP", FENCE_DATUMS, failsafe.fence_floor_from, "What FENCE_ALT_MIN is above"),
    real!("FENCE_RADIUS", None, -1.0..=100_000.0, failsafe.fence_radius_m, "m", "Radius of the fence around home; 0 disables it, a negative one forbids arming"),
    real!("FENCE_MARGIN", None, 0.0..=1000.0, failsafe.fence_margin_m, "m", "How far inside of the fence sticks stop, and how far above its floor the vehicle must have been for that to count"),
    real!("FENCE_NTF_FREQ", None, 0.0..=10.0, failsafe.fence_tells_hz, "Hz", "How often the way to the fence is told within its margin, if FENCE_OPTIONS asks for that; 0: once"),
    choice!("FENCE_AUTOENABLE", FENCE_STARTS, failsafe.fence_starts, "When the fence switches itself on"),
    choice!("FENCE_ACTION", FENCE_ACTIONS, failsafe.fence, "Action at the fence"),
    switch!("FS_VIBE_ENABLE", simulated.errors.switches.starts_again, "Trust the GPS receiver when the accelerometers keep contradicting it"),
    switch!("FS_CRASH_CHECK", crash.check, "Disarm a vehicle that has crashed"),
    bitmask!("LOG_BITMASK", LOGGED, log.bits, identity, identity, "What is logged"),
    whole!("LOG_DISARMED", 0..=3, log.disarmed, u8, "Log while disarmed, too: 0 off, 1 to 3 on"),
    switch!("LOG_FILE_DSRMROT", log.rotates, "Begin a new log with each flight instead of each boot"),
    ConductParameter {
        get: |conduct| shown(conduct, 0, GROUND_STATION_ACTIONS, conduct.failsafe.ground_station_lost),
        set: |conduct, value| {
            let Some((action, unknown)) = asked(GROUND_STATION_ACTIONS, value, Action::Return) else { return false };
            (conduct.failsafe.ground_station_lost, conduct.failsafe.unknown_numbers[0]) = (action, unknown);
            true
        },
        ..choice!("FS_GCS_ENABLE", GROUND_STATION_ACTIONS, failsafe.ground_station_lost, "Action when the ground station is lost; any other number returns")
    },
    ConductParameter {
        get: |conduct| shown(conduct, 1, ARDUPILOT_LOSS, conduct.failsafe.pilot_lost),
        set: |conduct, value| {
            let Some((action, unknown)) = asked(ARDUPILOT_LOSS, value, RadioLossAction::Land) else { return false };
            (conduct.failsafe.pilot_lost, conduct.failsafe.unknown_numbers[1]) = (action, unknown);
            true
        },
        ..choice!("FS_THR_ENABLE", ARDUPILOT_LOSS, failsafe.pilot_lost, "Action when the radio is lost; any other number lands")
    },
    ConductParameter {
        get: |conduct| {
            let everywhere = conduct.failsafe.position_lost_everywhere;
            let known = EKF_ACTIONS.iter().find(|(action, number, _)| {
                *action == conduct.failsafe.position_lost && (*number == LAND_EVERYWHERE) == everywhere
            });
            known.map_or(0.0, |(_, number, _)| f64::from(*number))
        },
        set: |conduct, value| {
            let known = EKF_ACTIONS.iter().find(|(_, number, _)| f64::from(*number) == value);
            if let Some((action, number, _)) = known {
                conduct.failsafe.position_lost = *action;
                conduct.failsafe.position_lost_everywhere = *number == LAND_EVERYWHERE;
            }
            known.is_some()
        },
        ..choice!("FS_EKF_ACTION", EKF_ACTIONS, failsafe.position_lost, "Action when the position estimate is lost")
    },
    real!("BATT_ARM_VOLT", None, 0.0..=100.0, failsafe.battery_limits.to_arm_v, "V", "Least voltage to arm with; 0: any"),
    real!("BATT_ARM_MAH", None, 0.0..=100_000.0, failsafe.battery_limits.to_arm_mah, "mAh", "Least remaining charge to arm with; 0: any"),
    whole!("ARMING_CHECK", 0..=1_048_575, arming.checks, i32, "Checks before arming, added up: 1 all, 2 barometer, 4 compass, 8 GPS, 16 inertial unit, 256 battery; 0 skips all of them"),
    whole!("ARMING_SKIPCHK", -1..=1_048_575, arming.skipped, i32, "Checks before arming that are skipped, added up: 2 barometer, 4 compass, 8 GPS, 16 inertial unit, 256 battery; -1 skips all of them"),
    switch!("ARMING_NEED_LOC", arming.needs_place, "Whether the place must be known to arm in any mode; modes that fly by it need it in any case"),
    switch!("BRD_SAFETY_DEFLT", arming.is_safe_at_the_start, "Whether the safety switch is on after the next start"),
    bitmask!("ARMING_MIS_ITEMS", REQUIRED_ITEMS, arming.required_items, identity, identity, "Mission items without which the vehicle does not arm"),
    real!("LAND_SPEED_HIGH", None, 0.0..=2000.0, land_fast_m_s, 100.0, "cm/s", "Descent rate of the first part of a landing; 0: WP_SPD_DN"),
    real!("LAND_SPD_HIGH_MS", None, 0.0..=20.0, land_fast_m_s, "m/s", "Descent rate of the first part of a landing; 0: WP_SPD_DN").other(),
    real!("BATT_LOW_VOLT", None, 0.0..=120.0, failsafe.battery_limits.low_v, "V", "Voltage below which the battery is low, after BATT_LOW_TIMER; 0: any"),
    real!("BATT_CRT_VOLT", None, 0.0..=120.0, failsafe.battery_limits.critical_v, "V", "Voltage below which the battery is critical, after BATT_LOW_TIMER; 0: any"),
    real!("BATT_LOW_MAH", None, 0.0..=1e6, failsafe.battery_limits.low_mah, "mAh", "Remaining charge below which the battery is low; 0: any"),
    real!("BATT_CRT_MAH", None, 0.0..=1e6, failsafe.battery_limits.critical_mah, "mAh", "Remaining charge below which the battery is critical; 0: any"),
    real!("BATT_LOW_TIMER", None, 0.0..=120.0, failsafe.battery_limits.low_s, "s", "Time of a low voltage after which it counts"),
    whole!("BATT_VOLT_PIN", -1..=115, failsafe.battery_limits.pin, i16, "Voltage pin: -1 removes the battery, any other number measures the voltage"),
    switch!("BATT_FS_VOLTSRC", failsafe.battery_limits.at_rest, "Voltage that is looked at", ["As measured", "At rest: without the drop that the current makes"]),
    choice!("BATT_FS_LOW_ACT", BATTERY_ACTIONS, failsafe.battery.low, "Action when the battery is low"),
    ConductParameter {
        set: |conduct, value| {
            let action = BATTERY_ACTIONS.iter().find(|(_, number, _)| f64::from(*number) == value);
            if let Some((action, ..)) = action {
                let battery = &mut conduct.failsafe.battery;
                battery.critical = *action;
                // ArduPilot knows no third level.
                battery.empty = *action;
            }
            action.is_some()
        },
        ..choice!("BATT_FS_CRT_ACT", BATTERY_ACTIONS, failsafe.battery.critical, "Action when the battery is critical, or almost empty")
    },
];

const FENCE_ACTIONS: &[(Action, i32, &str)] = &[
    (Action::Warn, 0, "Report only"),
    (Action::Return, 1, "Return"),
    (Action::Land, 2, "Land"),
    (Action::TraceOrReturn, 3, "SmartRTL or return"),
    (Action::BrakeOrLand, 4, "Brake or land"),
    (Action::TraceOrLand, 5, "SmartRTL or land"),
];
const FENCE_DATUMS: &[(FenceDatum, i32, &str)] = &[
    (FenceDatum::Home, 1, "Home"),
    (FenceDatum::SeaLevel, 0, "Sea level"),
    (FenceDatum::Origin, 2, "The origin"),
    (FenceDatum::Ground, 3, "The ground below the vehicle"),
];
const FENCE_STARTS: &[(FenceStart, i32, &str)] = &[
    (FenceStart::Never, 0, "Never"),
    (FenceStart::Takeoff, 1, "After a takeoff"),
    (FenceStart::TakeoffExceptFloor, 2, "After a takeoff; the floor does not count on landings"),
    (FenceStart::Armed, 3, "When armed"),
];
const GROUND_STATION_ACTIONS: &[(Action, i32, &str)] = &[
    (Action::None, 0, "Nothing"),
    (Action::Return, 1, "Return"),
    (Action::Return, 2, "Return; the former value for continuing a mission"),
    (Action::TraceOrReturn, 3, "SmartRTL or return"),
    (Action::TraceOrLand, 4, "SmartRTL or land"),
    (Action::Land, 5, "Land"),
    (Action::MissionLandingOrReturn, 6, "Landing of the mission or return"),
    (Action::BrakeOrLand, 7, "Brake or land"),
];
const ARDUPILOT_LOSS: &[(RadioLossAction, i32, &str)] = &[
    (RadioLossAction::None, 0, "Nothing"),
    (RadioLossAction::Return, 1, "Return"),
    (RadioLossAction::Return, 2, "Return; the former value for continuing a mission"),
    (RadioLossAction::Land, 3, "Land"),
    (RadioLossAction::TraceOrReturn, 4, "SmartRTL or return"),
    (RadioLossAction::TraceOrLand, 5, "SmartRTL or land"),
    (RadioLossAction::MissionLandingOrReturn, 6, "Landing of the mission or return"),
    (RadioLossAction::BrakeOrLand, 7, "Brake or land"),
];
/// Of FS_EKF_ACTION: lands whatever the mode needs.
const LAND_EVERYWHERE: i32 = 3;
const EKF_ACTIONS: &[(Action, i32, &str)] = &[
    (Action::Warn, 0, "Report only"),
    (Action::Land, 1, "Land"),
    (Action::Altitude, 2, "AltHold"),
    (Action::Land, LAND_EVERYWHERE, "Land, in modes that need no position, too"),
];
const REQUIRED_ITEMS: &[&str] =
    &["Land", "VTOL land", "DO_LAND_START", "Takeoff", "VTOL takeoff", "Rally point", "Return to launch"];
const BATTERY_ACTIONS: &[(Action, i32, &str)] = &[
    (Action::Warn, 0, "Warn"),
    (Action::Land, 1, "Land"),
    (Action::Return, 2, "Return"),
    (Action::TraceOrReturn, 3, "SmartRTL or return"),
    (Action::TraceOrLand, 4, "SmartRTL or land"),
    (Action::Terminate, 5, "Terminate"),
    (Action::MissionLandingOrReturn, 6, "Landing of the mission or return"),
    (Action::BrakeOrLand, 7, "Brake or land"),
];

/// The number of an action, or the one that was set and means nothing.
fn shown<A: PartialEq>(conduct: &Conduct, place: usize, choices: &[(A, i32, &str)], action: A) -> f64 {
    let unknown = conduct.failsafe.unknown_numbers.get(place).copied().flatten();
    let known = choices.iter().find(|(choice, ..)| *choice == action).map_or(0, |(_, number, _)| *number);
    unknown.map_or(f64::from(known), f64::from)
}

/// The action of a number. One that means nothing leads to the given action, and is to be shown again, as is a second number of one.
fn asked<A: Copy + PartialEq>(
    choices: &[(A, i32, &str)],
    value: f64,
    otherwise: A,
) -> Option<(A, Option<u8>)> {
    if value.fract() != 0.0 || !(0.0..=100.0).contains(&value) {
        return None;
    }
    let known = choices.iter().find(|(_, number, _)| f64::from(*number) == value);
    let action = known.map_or(otherwise, |(action, ..)| *action);
    let first = choices.iter().find(|(choice, ..)| *choice == action);
    let shows_itself = first.is_some_and(|(_, number, _)| f64::from(*number) == value);
    Some((action, (!shows_itself).then_some(value as u8)))
}

const FENCE_OPTIONS: &[&str] = &[
    "No other mode while the vehicle comes back from a breach",
    "One of several inclusion zones is enough",
    "Tell the way to the fence within its margin (FENCE_NTF_FREQ)",
];
const KEEPS_MODE: u32 = 1;
const UNION: u32 = 2;
const TELLS_MARGIN: u32 = 4;

/// Bits of LOG_BITMASK, as ArduCopter has them.
const LOGGED: &[&str] = &[
    "Fast attitude",
    "Medium attitude",
    "GPS",
    "System performance",
    "Control tuning",
    "Navigation tuning",
    "RC input",
    "IMU",
    "Mission commands",
    "Battery monitor",
    "RC output",
    "Optical flow",
    "PID",
    "Compass",
    "(unused)",
    "Camera",
    "(unused)",
    "Motors",
    "Fast IMU",
    "Raw IMU",
    "Video stabilization",
    "Fast harmonic notch",
];
const FENCE_PARTS: &[&str] = &["Maximum height", "Maximum distance", "Zones", "Minimum height"];

fn option_bits(options: FenceOptions) -> u32 {
    let margin = u32::from(options.tells_margin) * TELLS_MARGIN;
    u32::from(options.keeps_mode) * KEEPS_MODE + u32::from(options.union) * UNION + margin
}

fn options(bits: u32) -> FenceOptions {
    FenceOptions {
        keeps_mode: bits & KEEPS_MODE != 0,
        union: bits & UNION != 0,
        tells_margin: bits & TELLS_MARGIN != 0,
    }
}

fn bits(parts: FenceParts) -> u32 {
    u32::from(parts.bits())
}

fn parts(bits: u32) -> FenceParts {
    FenceParts::from_bits(bits as u8)
}

#[cfg(test)]
mod tests {
    use super::ARDUPILOT_PARAMETERS;
    use crate::vehicle::Conduct;

    #[test]
    fn what_is_written_is_read_again() {
        for parameter in ARDUPILOT_PARAMETERS {
            let mut taken = 0;
            for value in (-1..10).map(f64::from).chain([0.5, f64::NAN]) {
                // The range of a number is looked at before.
                if value.is_nan() && !parameter.integer {
                    continue;
                }
                let mut conduct = Conduct::new(true);
                let before = conduct;
                if (parameter.set)(&mut conduct, value) {
                    let read = (parameter.get)(&conduct);
                    assert_eq!(read as f32, value as f32, "{}", parameter.id);
                    taken += 1;
                } else {
                    assert_eq!(conduct, before, "{} = {value}", parameter.id);
                }
            }
            assert!(taken >= 2, "{}", parameter.id);
        }
    }
}
