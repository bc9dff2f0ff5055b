//! Failsafes and fence by ArduPilot's names and numbers.

use core::convert::identity;

use super::ConductParameter;
use super::conduct_parameter::{bitmask, choice, switch, whole};
use crate::vehicle::{Action, FenceOptions, FenceParts};

/// Parameters that ArduPilot has in place of those of PX4 with other numbers.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static ARDUPILOT_PARAMETERS: &[ConductParameter] = &[
    switch!("FENCE_ENABLE", failsafe.fence_enabled, "Enable the fence"),
    bitmask!("FENCE_TYPE", FENCE_PARTS, failsafe.fence_parts, bits, parts, "Enabled parts of the fence"),
    bitmask!("FENCE_OPTIONS", FENCE_OPTIONS, failsafe.fence_options, option_bits, options, "Options of the fence"),
    choice!("FENCE_ACTION", FENCE_ACTIONS, failsafe.fence, "Action at the fence"),
    switch!("FS_CRASH_CHECK", crash.check, "Disarm a vehicle that has crashed"),
    bitmask!("LOG_BITMASK", LOGGED, log.bits, identity, identity, "What is logged"),
    whole!("LOG_DISARMED", 0..=3, log.disarmed, u8, "Log while disarmed, too: 0 off, 1 to 3 on"),
    switch!("LOG_FILE_DSRMROT", log.rotates, "Begin a new log with each flight instead of each boot"),
    choice!("FS_GCS_ENABLE", GROUND_STATION_ACTIONS, failsafe.ground_station_lost, "Action when the ground station is lost"),
    choice!("BATT_FS_LOW_ACT", BATTERY_ACTIONS, failsafe.battery.low, "Action when the battery is low"),
    ConductParameter {
        set: |conduct, value| {
            let action = BATTERY_ACTIONS.iter().find(|(_, number, _)| f64::from(*number) == value);
            if let Some((action, ..)) = action {
                let battery = &mut conduct.failsafe.battery;
                battery.critical = *action;
                // ArduPilot knows no third level: what acts at the second one lands at the latest when it is empty.
                battery.empty = if *action > Action::Warn { (*action).max(Action::Land) } else { *action };
            }
            action.is_some()
        },
        ..choice!("BATT_FS_CRT_ACT", BATTERY_ACTIONS, failsafe.battery.critical, "Action when the battery is critical; when almost empty the vehicle lands at the latest, unless this is 0")
    },
];

const FENCE_ACTIONS: &[(Action, i32, &str)] = &[
    (Action::Warn, 0, "Report only"),
    (Action::Return, 1, "Return"),
    (Action::Land, 2, "Land"),
    (Action::Hold, 4, "Brake"),
];
const GROUND_STATION_ACTIONS: &[(Action, i32, &str)] = &[
    (Action::None, 0, "Nothing"),
    (Action::Return, 1, "Return"),
    (Action::Land, 5, "Land"),
    (Action::Hold, 7, "Brake"),
];
const BATTERY_ACTIONS: &[(Action, i32, &str)] = &[
    (Action::Warn, 0, "Warn"),
    (Action::Land, 1, "Land"),
    (Action::Return, 2, "Return"),
    (Action::Terminate, 5, "Terminate"),
    (Action::Hold, 7, "Brake"),
];

const FENCE_OPTIONS: &[&str] =
    &["No other mode while the vehicle comes back from a breach", "One of several inclusion zones is enough"];
const KEEPS_MODE: u32 = 1;
const UNION: u32 = 2;

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
const FENCE_PARTS: &[&str] = &["Maximum height", "Maximum distance", "Zones"];
const HEIGHT: u32 = 1;
const DISTANCE: u32 = 2;
const ZONES: u32 = 4;

fn option_bits(options: FenceOptions) -> u32 {
    u32::from(options.keeps_mode) * KEEPS_MODE + u32::from(options.union) * UNION
}

fn options(bits: u32) -> FenceOptions {
    FenceOptions { keeps_mode: bits & KEEPS_MODE != 0, union: bits & UNION != 0 }
}

fn bits(parts: FenceParts) -> u32 {
    let of = |part: bool, bit: u32| if part { bit } else { 0 };
    of(parts.height, HEIGHT) | of(parts.distance, DISTANCE) | of(parts.zones, ZONES)
}

fn parts(bits: u32) -> FenceParts {
    FenceParts { height: bits & HEIGHT != 0, distance: bits & DISTANCE != 0, zones: bits & ZONES != 0 }
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
                let mut conduct = Conduct::new(true);
                let before = conduct;
                if (parameter.set)(&mut conduct, value) {
                    assert_eq!((parameter.get)(&conduct), value, "{}", parameter.id);
                    taken += 1;
                } else {
                    assert_eq!(conduct, before, "{} = {value}", parameter.id);
                }
            }
            assert!(taken >= 2, "{}", parameter.id);
        }
    }
}
