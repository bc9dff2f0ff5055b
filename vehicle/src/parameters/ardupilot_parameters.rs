//! Failsafes and fence by ArduPilot's names and numbers.

use super::ConductParameter;
use super::conduct_parameters::{choice, switch, whole};
use crate::vehicle::{Action, FenceParts};

/// Parameters that ArduPilot has in place of those of PX4 with other numbers.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static ARDUPILOT_PARAMETERS: &[ConductParameter] = &[
    switch!("FENCE_ENABLE", failsafe.fence_enabled),
    ConductParameter {
        id: "FENCE_TYPE",
        ardupilot: None,
        integer: true,
        minimum: 0.0,
        maximum: 7.0,
        get: |conduct| f64::from(bits(conduct.failsafe.fence_parts)),
        set: |conduct, value| {
            let parts = (0..=7).find(|bits| f64::from(*bits) == value).map(parts);
            conduct.failsafe.fence_parts = parts.unwrap_or(conduct.failsafe.fence_parts);
            parts.is_some()
        },
    },
    choice!("FENCE_ACTION", FENCE_ACTIONS, failsafe.fence),
    switch!("FS_CRASH_CHECK", crash.check),
    whole!("LOG_BITMASK", 0..=16_777_215, log.bits, u32),
    whole!("LOG_DISARMED", 0..=3, log.disarmed, u8),
    switch!("LOG_FILE_DSRMROT", log.rotates),
    choice!("FS_GCS_ENABLE", GROUND_STATION_ACTIONS, failsafe.ground_station_lost),
    choice!("BATT_FS_LOW_ACT", BATTERY_ACTIONS, failsafe.battery.low),
    ConductParameter {
        set: |conduct, value| {
            let action = BATTERY_ACTIONS.iter().find(|(_, number)| f64::from(*number) == value);
            if let Some((action, _)) = action {
                let battery = &mut conduct.failsafe.battery;
                battery.critical = *action;
                // ArduPilot knows no third level: what acts at the second one lands at the latest when it is empty.
                battery.empty = if *action > Action::Warn { (*action).max(Action::Land) } else { *action };
            }
            action.is_some()
        },
        ..choice!("BATT_FS_CRT_ACT", BATTERY_ACTIONS, failsafe.battery.critical)
    },
];

/// PX4's identifiers whose meaning the ones above have.
pub const REPLACED: [&str; 9] = [
    "GF_ACTION",
    "NAV_DLL_ACT",
    "COM_LOW_BAT_ACT",
    "FD_FAIL_R",
    "FD_FAIL_P",
    "FD_FAIL_R_TTRI",
    "FD_FAIL_P_TTRI",
    "COM_LKDOWN_TKO",
    "CBRK_FLIGHTTERM",
];

const FENCE_ACTIONS: &[(Action, i32)] =
    &[(Action::Warn, 0), (Action::Return, 1), (Action::Land, 2), (Action::Hold, 4)];
const GROUND_STATION_ACTIONS: &[(Action, i32)] =
    &[(Action::None, 0), (Action::Return, 1), (Action::Land, 5), (Action::Hold, 7)];
const BATTERY_ACTIONS: &[(Action, i32)] =
    &[(Action::Warn, 0), (Action::Land, 1), (Action::Return, 2), (Action::Terminate, 5), (Action::Hold, 7)];

const HEIGHT: u8 = 1;
const DISTANCE: u8 = 2;
const ZONES: u8 = 4;

fn bits(parts: FenceParts) -> u8 {
    let of = |part: bool, bit: u8| if part { bit } else { 0 };
    of(parts.height, HEIGHT) | of(parts.distance, DISTANCE) | of(parts.zones, ZONES)
}

fn parts(bits: u8) -> FenceParts {
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
