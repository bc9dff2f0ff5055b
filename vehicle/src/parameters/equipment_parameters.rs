//! What the vehicle carries, by ArduPilot's names: outputs, gripper, gimbal and parachute.

use super::conduct_parameter::{bitmask, choice, real, switch, whole};
use super::radio_parameters::{number, same};
use super::{ConductParameter, NamedValue};
use crate::equipment::GimbalMode;

type Group = &'static [ConductParameter];

/// Function, ends, centre and direction of one output.
macro_rules! output {
    ($number:literal, $index:literal) => {
        &[
            number!(concat!("SERVO", $number, "_FUNCTION"), -1.0..=200.0, conduct, conduct.equipment.outputs[$index].function, "", "What the output follows: 0 commands, 1 and 51 to 66 pulses of the radio, 140 to 155 its scaled channels, 6 to 8 yaw, pitch and roll of the gimbal, 27 the parachute, 28 the gripper, 29 the landing gear, 134 to 136 its shortest, centred and longest pulse"),
            number!(concat!("SERVO", $number, "_MIN"), 500.0..=2500.0, conduct, conduct.equipment.outputs[$index].minimum_us, "us", "Shortest pulse of the output"),
            number!(concat!("SERVO", $number, "_MAX"), 500.0..=2500.0, conduct, conduct.equipment.outputs[$index].maximum_us, "us", "Longest pulse of the output"),
            number!(concat!("SERVO", $number, "_TRIM"), 500.0..=2500.0, conduct, conduct.equipment.outputs[$index].trim_us, "us", "Pulse of the centre of the output"),
            ConductParameter {
                set: |conduct, value| {
                    let means = value == 0.0 || value == 1.0;
                    if means {
                        conduct.equipment.outputs[$index].reversed = value == 1.0;
                    }
                    means
                },
                get: |conduct| f64::from(u8::from(conduct.equipment.outputs[$index].reversed)),
                names: || vec![NamedValue::new(0, "Normal"), NamedValue::new(1, "Reversed")],
                ..number!(concat!("SERVO", $number, "_REVERSED"), 0.0..=1.0, conduct, conduct.radio.mode_channel, "", "Direction of the output")
            },
        ]
    };
}

static OUTPUTS: [Group; 12] = [
    output!("5", 0),
    output!("6", 1),
    output!("7", 2),
    output!("8", 3),
    output!("9", 4),
    output!("10", 5),
    output!("11", 6),
    output!("12", 7),
    output!("13", 8),
    output!("14", 9),
    output!("15", 10),
    output!("16", 11),
];

/// Degrees in a radian.
const DEGREES: f64 = 57.295_779_513_082_32;

/// An end of a range of the gimbal, which is shown in whole degrees.
macro_rules! end {
    ($id:literal, $minimum:literal..=$maximum:literal, $axis:ident, $end:literal, $text:literal) => {
        ConductParameter {
            integer: true,
            get: |conduct| (conduct.equipment.mount.$axis[$end] * DEGREES).round(),
            set: |conduct, value| {
                conduct.equipment.mount.$axis[$end] = value / DEGREES;
                value.fract() == 0.0
            },
            ..real!($id, None, $minimum..=$maximum, set_point_timeout_s, "deg", $text)
        }
    };
}

/// An angle of the gimbal.
macro_rules! angle {
    ($id:literal, $angles:ident, $axis:literal, $text:literal) => {
        ConductParameter {
            get: |conduct| conduct.equipment.mount.$angles[$axis] * DEGREES,
            set: |conduct, value| {
                conduct.equipment.mount.$angles[$axis] = value / DEGREES;
                true
            },
            ..real!($id, None, -180.0..=180.0, set_point_timeout_s, "deg", $text)
        }
    };
}

#[rustfmt::skip] // One line per parameter reads as the table that it is.
static OTHERS: Group = &[
    bitmask!("SERVO_RC_FS_MSK", CHANNELS, equipment.centred_when_lost, same, same, "Channels whose scaled outputs go to their centre when the radio is lost; others stay where they are"),
    whole!("GRIP_GRAB", 1000..=2000, equipment.grabbing_us, u16, "Pulse that grabs (us)"),
    whole!("GRIP_RELEASE", 1000..=2000, equipment.releasing_us, u16, "Pulse that releases (us)"),
    whole!("GRIP_NEUTRAL", 1000..=2000, equipment.gripper_waits_us, u16, "Pulse until the gripper is first told to grab or to release (us)"),
    real!("GRIP_AUTOCLOSE", None, 0.0..=255.0, equipment.gripper_closes_after_s, "s", "Time after a release after which the gripper grabs by itself; 0: never"),
    switch!("LGR_ENABLE", equipment.landing_gear, "Whether there is a landing gear"),
    whole!("MNT1_TYPE", 0..=13, equipment.mount.kind, u8, "Kind of gimbal: 0 is pointed by MAVLink only and has its own ranges; 1 has servos, which reach their angles at once; any other kind turns at 180 deg/s"),
    choice!("MNT1_DEFLT_MODE", MODES, equipment.mount.first_mode, "Mode of the gimbal at startup, and when there is no longer anything to look at; without effect if MNT1_TYPE is 0"),
    real!("MNT1_RC_RATE", None, 0.0..=90.0, equipment.mount.radio_rate_rad_s, DEGREES, "deg/s", "Rate of turn of the gimbal at full deflection of its channel; 0: the channel is its angle"),
    end!("MNT1_ROLL_MIN", -180.0..=180.0, roll_rad, 0, "Least roll of the gimbal"),
    end!("MNT1_ROLL_MAX", -180.0..=180.0, roll_rad, 1, "Largest roll of the gimbal"),
    end!("MNT1_PITCH_MIN", -90.0..=90.0, pitch_rad, 0, "Least pitch of the gimbal"),
    end!("MNT1_PITCH_MAX", -90.0..=90.0, pitch_rad, 1, "Largest pitch of the gimbal"),
    end!("MNT1_YAW_MIN", -180.0..=180.0, yaw_rad, 0, "Least yaw of the gimbal from the nose"),
    end!("MNT1_YAW_MAX", -180.0..=180.0, yaw_rad, 1, "Largest yaw of the gimbal from the nose"),
    angle!("MNT1_NEUTRAL_X", neutral_rad, 0, "Roll of the gimbal where it looks ahead"),
    angle!("MNT1_NEUTRAL_Y", neutral_rad, 1, "Pitch of the gimbal where it looks ahead"),
    angle!("MNT1_NEUTRAL_Z", neutral_rad, 2, "Yaw of the gimbal where it looks ahead"),
    angle!("MNT1_RETRACT_X", folded_rad, 0, "Roll of the gimbal where it is folded away"),
    angle!("MNT1_RETRACT_Y", folded_rad, 1, "Pitch of the gimbal where it is folded away"),
    angle!("MNT1_RETRACT_Z", folded_rad, 2, "Yaw of the gimbal where it is folded away"),
    switch!("CHUTE_ENABLED", equipment.parachute.enabled, "Whether the parachute may open"),
    whole!("CHUTE_SERVO_ON", 1000..=2000, equipment.parachute.on_us, u16, "Pulse that opens the parachute (us)"),
    whole!("CHUTE_SERVO_OFF", 1000..=2000, equipment.parachute.off_us, u16, "Pulse that does not open the parachute (us)"),
    real!("CHUTE_ALT_MIN", None, 0.0..=32_000.0, equipment.parachute.least_height_m, "m", "Least height above home at which the parachute opens; 0: any"),
    real!("CHUTE_DELAY_MS", None, 0.0..=5000.0, equipment.parachute.delay_s, 1000.0, "ms", "Time between the stop of the rotors and the opening of the parachute"),
    real!("CHUTE_CRT_SINK", None, 0.0..=15.0, equipment.parachute.fastest_m_s, "m/s", "Sink rate at which the parachute opens by itself; 0: none"),
    switch!("SIM_PARA_ENABLE", equipment.parachute.is_fitted, "Whether a parachute is simulated"),
    whole!("SIM_PARA_PIN", -1..=15, equipment.parachute.output, i8, "Output whose pulse opens the simulated parachute; it must follow the parachute (SERVOn_FUNCTION = 27)"),
];

/// The parameters of what the vehicle carries, which it has when it presents itself as ArduPilot.
pub fn equipment_parameters() -> impl Iterator<Item = &'static ConductParameter> {
    OUTPUTS.iter().copied().flatten().chain(OTHERS)
}

const CHANNELS: &[&str] = &[
    "Channel 1",
    "Channel 2",
    "Channel 3",
    "Channel 4",
    "Channel 5",
    "Channel 6",
    "Channel 7",
    "Channel 8",
    "Channel 9",
    "Channel 10",
    "Channel 11",
    "Channel 12",
    "Channel 13",
    "Channel 14",
    "Channel 15",
    "Channel 16",
];
const MODES: &[(GimbalMode, i32, &str)] = &[
    (GimbalMode::Retracted, 0, "Retracted"),
    (GimbalMode::Neutral, 1, "Neutral"),
    (GimbalMode::Commands, 2, "Pointed by commands"),
    (GimbalMode::Radio, 3, "Pointed by the radio"),
    (GimbalMode::Region, 4, "At what is looked at"),
    (GimbalMode::Home, 6, "At home"),
];
