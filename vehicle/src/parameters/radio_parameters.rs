//! The pilot's radio and sticks by the names and numbers of both autopilots.

use super::conduct_parameter::{bitmask, choice, real, switch};
use super::{ConductParameter, NamedValue};
use crate::radio::{InputChoice, PX4_SLOTS, RadioFailure, RadioLossAction, RudderArming};
use crate::vehicle::Trainer;

/// A whole number in a field that is one.
macro_rules! whole {
    ($id:expr, $minimum:literal..=$maximum:literal, $conduct:ident, $field:expr, $unit:literal, $text:literal) => {
        ConductParameter {
            id: $id,
            ardupilot: None,
            also: &[],
            is_other: false,
            integer: true,
            minimum: $minimum,
            maximum: $maximum,
            get: |$conduct| $field,
            set: |$conduct, value| {
                let means = value.fract() == 0.0;
                if means {
                    $field = value;
                }
                means
            },
            unit: $unit,
            text: $text,
            names: Vec::new,
            bits: &[],
        }
    };
}

pub(super) use whole as number;

/// Ends, trim, dead zone and direction of one channel, and for ArduPilot the function of its switch.
macro_rules! channel {
    ($number:literal, $index:literal, [$($own:expr),*]) => {
        &[
            whole!(concat!("RC", $number, "_MIN"), 800.0..=2200.0, conduct, conduct.radio.channels[$index].minimum_us, "us", "Shortest pulse of the channel"),
            whole!(concat!("RC", $number, "_MAX"), 800.0..=2200.0, conduct, conduct.radio.channels[$index].maximum_us, "us", "Longest pulse of the channel"),
            whole!(concat!("RC", $number, "_TRIM"), 800.0..=2200.0, conduct, conduct.radio.channels[$index].trim_us, "us", "Pulse of the centred stick"),
            whole!(concat!("RC", $number, "_DZ"), 0.0..=200.0, conduct, conduct.radio.channels[$index].dead_zone_us, "us", "Dead zone about the trim, or above the low end of a throttle"),
            $($own),*
        ]
    };
}

macro_rules! ardupilot_channel {
    ($number:literal, $index:literal) => {
        channel!(
            $number,
            $index,
            [
                ConductParameter {
                    set: |conduct, value| {
                        let means = value == 0.0 || value == 1.0;
                        if means {
                            conduct.radio.channels[$index].reversed = value == 1.0;
                        }
                        means
                    },
                    get: |conduct| f64::from(u8::from(conduct.radio.channels[$index].reversed)),
                    names: || vec![
                        super::NamedValue::new(0, "Normal"),
                        super::NamedValue::new(1, "Reversed")
                    ],
                    ..whole!(
                        concat!("RC", $number, "_REVERSED"),
                        0.0..=1.0,
                        conduct,
                        conduct.radio.mode_channel,
                        "",
                        "Direction of the channel"
                    )
                },
                whole!(
                    concat!("RC", $number, "_OPTION"),
                    0.0..=400.0,
                    conduct,
                    conduct.radio.channels[$index].option,
                    "",
                    "Function of the switch on the channel; 0: none"
                )
            ]
        )
    };
}

macro_rules! px4_channel {
    ($number:literal, $index:literal) => {
        channel!(
            $number,
            $index,
            [ConductParameter {
                id: concat!("RC", $number, "_REV"),
                ardupilot: None,
                also: &[],
                is_other: false,
                integer: false,
                minimum: -1.0,
                maximum: 1.0,
                get: |conduct| if conduct.radio.channels[$index].reversed { -1.0 } else { 1.0 },
                set: |conduct, value| {
                    let means = value.abs() == 1.0;
                    if means {
                        conduct.radio.channels[$index].reversed = value < 0.0;
                    }
                    means
                },
                unit: "",
                text: "Direction of the channel: -1 is reversed",
                names: || vec![super::NamedValue::new(-1, "Reversed"), super::NamedValue::new(1, "Normal")],
                bits: &[],
            }]
        )
    };
}

/// Pin and function of one button.
macro_rules! button {
    ($number:literal, $index:literal) => {
        &[
            whole!(
                concat!("BTN_PIN", $number),
                -1.0..=31.0,
                conduct,
                conduct.radio.buttons.buttons[$index].pin,
                "",
                "Pin of the button; -1: none"
            ),
            whole!(
                concat!("BTN_FUNC", $number),
                0.0..=400.0,
                conduct,
                conduct.radio.buttons.buttons[$index].function,
                "",
                "Function of the button, as of a switch (RCn_OPTION) that is high while it is pressed; 0: none"
            ),
            ConductParameter {
                get: |conduct| f64::from(u8::from(conduct.radio.buttons.buttons[$index].inverted)) * INVERTED,
                set: |conduct, value| {
                    let means = value == 0.0 || value == INVERTED;
                    if means {
                        conduct.radio.buttons.buttons[$index].inverted = value == INVERTED;
                    }
                    means
                },
                names: || vec![NamedValue::new(0, "Pressed while high"), NamedValue::new(2, "Pressed while low")],
                ..whole!(
                    concat!("BTN_OPTIONS", $number),
                    0.0..=2.0,
                    conduct,
                    conduct.radio.mode_channel,
                    "",
                    "When the button is pressed"
                )
            },
        ]
    };
}

/// The bit of BTN_OPTIONSn that inverts the pin.
const INVERTED: f64 = 2.0;

static BUTTONS: [Group; 4] = [button!("1", 0), button!("2", 1), button!("3", 2), button!("4", 3)];

type Group = &'static [ConductParameter];

macro_rules! all {
    ($channel:ident) => {
        [
            $channel!("1", 0),
            $channel!("2", 1),
            $channel!("3", 2),
            $channel!("4", 3),
            $channel!("5", 4),
            $channel!("6", 5),
            $channel!("7", 6),
            $channel!("8", 7),
            $channel!("9", 8),
            $channel!("10", 9),
            $channel!("11", 10),
            $channel!("12", 11),
            $channel!("13", 12),
            $channel!("14", 13),
            $channel!("15", 14),
            $channel!("16", 15),
        ]
    };
}

static ARDUPILOT_CHANNELS: [Group; 16] = all!(ardupilot_channel);
static PX4_CHANNELS: [Group; 16] = all!(px4_channel);

/// The parameters of radio and sticks of an identity.
pub fn radio_parameters(ardupilot: bool) -> impl Iterator<Item = &'static ConductParameter> {
    let (channels, others) =
        if ardupilot { (&ARDUPILOT_CHANNELS, ARDUPILOT_RADIO) } else { (&PX4_CHANNELS, PX4_RADIO) };
    let buttons = BUTTONS.iter().filter(move |_| ardupilot);
    channels.iter().chain(buttons).copied().flatten().chain(others)
}

macro_rules! flight_mode {
    ($id:literal, $index:literal) => {
        whole!(
            $id,
            0.0..=100.0,
            conduct,
            conduct.radio.modes[$index],
            "",
            "Mode of this position of the mode switch"
        )
    };
}

#[rustfmt::skip] // One line per parameter reads as the table that it is.
static ARDUPILOT_RADIO: &[ConductParameter] = &[
    whole!("RCMAP_ROLL", 1.0..=16.0, conduct, conduct.radio.axes.roll, "", "Channel of roll"),
    whole!("RCMAP_PITCH", 1.0..=16.0, conduct, conduct.radio.axes.pitch, "", "Channel of pitch"),
    whole!("RCMAP_THROTTLE", 1.0..=16.0, conduct, conduct.radio.axes.throttle, "", "Channel of the throttle"),
    whole!("RCMAP_YAW", 1.0..=16.0, conduct, conduct.radio.axes.yaw, "", "Channel of yaw"),
    whole!("FLTMODE_CH", 0.0..=16.0, conduct, conduct.radio.mode_channel, "", "Channel of the mode switch; 0: none"),
    flight_mode!("FLTMODE1", 0),
    flight_mode!("FLTMODE2", 1),
    flight_mode!("FLTMODE3", 2),
    flight_mode!("FLTMODE4", 3),
    flight_mode!("FLTMODE5", 4),
    flight_mode!("FLTMODE6", 5),
    bitmask!("SIMPLE", SLOTS, radio.simple_slots, same, same, "Positions of the mode switch in which sticks refer to the heading of arming"),
    bitmask!("SUPER_SIMPLE", SLOTS, radio.super_simple_slots, same, same, "Positions of the mode switch in which sticks refer to the direction away from home"),
    bitmask!("FS_OPTIONS", OPTIONS, radio.options, same, same, "What goes on in spite of a failsafe"),
    whole!("FS_THR_VALUE", 910.0..=1100.0, conduct, conduct.radio.low_throttle_us, "us", "Throttle below which the receiver has lost its sender"),
    real!("RC_OVERRIDE_TIME", None, -1.0..=120.0, radio.override_s, "s", "Time for which an override of a channel counts; -1 is for ever, 0 ignores overrides"),
    choice!("ARMING_RUDDER", RUDDER, radio.rudder, "What the rudder stick does that is held at an end with the throttle low"),
    switch!("BTN_ENABLE", radio.buttons.enabled, "Look at buttons"),
    real!("BTN_REPORT_SEND", None, 0.0..=3600.0, radio.buttons.told_s, "s", "For how long a change of the buttons is told (BUTTON_CHANGE)"),
    bitmask!("SIM_PIN_MASK", PINS, radio.buttons.high_pins, same, same, "Pins of buttons that are simulated as high"),
    whole!("TUNE", 0.0..=70.0, conduct, conduct.radio.knobs.first.target, "", "What the knob on the channel with the option 219 changes: 10 speed of the way in cm/s, 61 in m/s, 60 LOIT_SPEED_MS, 39 CIRCLE_RATE, 25 ACRO_RP_RATE, 40 ACRO_Y_RATE, 28 PSC_NE_VEL_I; the other numbers are gains that there are not"),
    real!("TUNE_MIN", None, -1000.0..=1000.0, radio.knobs.first.minimum, "", "Value of the knob's low end"),
    real!("TUNE_MAX", None, -1000.0..=1000.0, radio.knobs.first.maximum, "", "Value of the knob's high end"),
    whole!("TUNE2", 0.0..=70.0, conduct, conduct.radio.knobs.second.target, "", "What the knob on the channel with the option 220 changes: 10 speed of the way in cm/s, 61 in m/s, 60 LOIT_SPEED_MS, 39 CIRCLE_RATE, 25 ACRO_RP_RATE, 40 ACRO_Y_RATE, 28 PSC_NE_VEL_I; the other numbers are gains that there are not"),
    real!("TUNE2_MIN", None, -1000.0..=1000.0, radio.knobs.second.minimum, "", "Value of the knob's low end"),
    real!("TUNE2_MAX", None, -1000.0..=1000.0, radio.knobs.second.maximum, "", "Value of the knob's high end"),
    choice!("SIM_RC_FAIL", FAILURES, radio.failure, "Simulated failure of the receiver"),
    real!("ANGLE_MAX", None, 1000.0..=8000.0, sticks.lean_rad, 5_729.577_951_308_232, "cdeg", "Lean angle at full stick deflection"),
    real!("PILOT_Y_RATE", None, 1.0..=360.0, sticks.turn_rad_s, 57.295_779_513_082_32, "deg/s", "Rate of turn at full stick deflection"),
    real!("PILOT_ACCEL_Z", None, 50.0..=500.0, sticks.climb_m_s2, 100.0, "cm/s/s", "Vertical acceleration of a pilot's climb"),
    real!("THR_DZ", None, 0.0..=300.0, sticks.throttle_dead_zone, 1000.0, "", "Thousandths of the throttle's way above and below its middle that mean no climb"),
    ConductParameter {
        set: |conduct, value| {
            conduct.sticks.roll_rad_s = value.to_radians();
            conduct.sticks.pitch_rad_s = value.to_radians();
            true
        },
        ..real!("ACRO_RP_RATE", None, 1.0..=1080.0, sticks.roll_rad_s, 57.295_779_513_082_32, "deg/s", "Roll and pitch rate at full stick deflection in Acro mode")
    },
    real!("ACRO_Y_RATE", None, 1.0..=360.0, sticks.spin_rad_s, 57.295_779_513_082_32, "deg/s", "Yaw rate at full stick deflection in Acro mode"),
    real!("ACRO_RP_EXPO", None, 0.0..=0.95, sticks.exponent, "", "How much gentler the middle of the sticks is in Acro mode"),
    real!("ACRO_BAL_ROLL", None, 0.0..=3.0, sticks.levelling_1_s, "", "How fast the trainer of Acro mode levels"),
    choice!("ACRO_TRAINER", TRAINERS, sticks.trainer, "Help in Acro mode"),
];

macro_rules! slot {
    ($id:literal, $index:literal) => {
        ConductParameter {
            set: |conduct, value| {
                let means = value == -1.0 || PX4_SLOTS.iter().any(|(number, ..)| f64::from(*number) == value);
                if means {
                    conduct.radio.modes[$index] = value;
                }
                means
            },
            names: || {
                let named = PX4_SLOTS.iter().map(|(number, _, name)| super::NamedValue::new(*number, name));
                std::iter::once(super::NamedValue::new(-1, "Unassigned")).chain(named).collect()
            },
            ..whole!(
                $id,
                -1.0..=12.0,
                conduct,
                conduct.radio.modes[$index],
                "",
                "Mode of this position of the mode switch"
            )
        }
    };
}

#[rustfmt::skip] // One line per parameter reads as the table that it is.
static PX4_RADIO: &[ConductParameter] = &[
    whole!("RC_MAP_ROLL", 0.0..=16.0, conduct, conduct.radio.axes.roll, "", "Channel of roll; 0: none"),
    whole!("RC_MAP_PITCH", 0.0..=16.0, conduct, conduct.radio.axes.pitch, "", "Channel of pitch; 0: none"),
    whole!("RC_MAP_THROTTLE", 0.0..=16.0, conduct, conduct.radio.axes.throttle, "", "Channel of the throttle; 0: none"),
    whole!("RC_MAP_YAW", 0.0..=16.0, conduct, conduct.radio.axes.yaw, "", "Channel of yaw; 0: none"),
    whole!("RC_MAP_FLTMODE", 0.0..=16.0, conduct, conduct.radio.mode_channel, "", "Channel of the mode switch; 0: none"),
    whole!("RC_MAP_ARM_SW", 0.0..=16.0, conduct, conduct.radio.switches.arm, "", "Channel of the switch that arms; 0: none"),
    whole!("RC_MAP_KILL_SW", 0.0..=16.0, conduct, conduct.radio.switches.kill, "", "Channel of the switch that stops the rotors; 0: none"),
    whole!("RC_MAP_RETURN_SW", 0.0..=16.0, conduct, conduct.radio.switches.return_home, "", "Channel of the switch that returns; 0: none"),
    whole!("RC_MAP_LOITER_SW", 0.0..=16.0, conduct, conduct.radio.switches.hold, "", "Channel of the switch that holds; 0: none"),
    whole!("RC_MAP_OFFB_SW", 0.0..=16.0, conduct, conduct.radio.switches.offboard, "", "Channel of the switch of offboard mode; 0: none"),
    slot!("COM_FLTMODE1", 0),
    slot!("COM_FLTMODE2", 1),
    slot!("COM_FLTMODE3", 2),
    slot!("COM_FLTMODE4", 3),
    slot!("COM_FLTMODE5", 4),
    slot!("COM_FLTMODE6", 5),
    choice!("NAV_RCL_ACT", PX4_LOSS, failsafe.pilot_lost, "Action when manual control is lost"),
    bitmask!("COM_RCL_EXCEPT", EXCEPTIONS, radio.lost_exceptions, same, same, "Modes that go on when manual control is lost"),
    choice!("COM_RC_IN_MODE", INPUTS, radio.inputs, "Where sticks may come from"),
    bitmask!("COM_RC_OVERRIDE", OVERRIDES, radio.take_over, same, same, "Modes that moved sticks take over"),
    real!("COM_RC_STICK_OV", None, 5.0..=80.0, radio.take_over_percent, "%", "By how much a stick must be moved to take over"),
    choice!("MAN_ARM_GESTURE", GESTURES, radio.rudder, "Whether the sticks held low and to one side arm and disarm"),
    real!("MPC_MAN_TILT_MAX", None, 1.0..=70.0, sticks.lean_rad, 57.295_779_513_082_32, "deg", "Lean angle at full stick deflection"),
    real!("MPC_MAN_Y_MAX", None, 1.0..=400.0, sticks.turn_rad_s, 57.295_779_513_082_32, "deg/s", "Rate of turn at full stick deflection"),
    real!("MPC_HOLD_DZ", None, 0.0..=0.9, sticks.dead_zone, "", "Dead zone of the sticks around the centre, in which the vehicle holds its position"),
    real!("MPC_MANTHR_MIN", None, 0.0..=1.0, sticks.least_thrust, "norm", "Thrust at the lowest throttle in modes without control of the height"),
    choice!("MPC_THR_CURVE", CURVES, sticks.hovers_centred, "What the centred throttle means"),
    real!("MC_ACRO_R_MAX", None, 1.0..=1800.0, sticks.roll_rad_s, 57.295_779_513_082_32, "deg/s", "Roll rate at full stick deflection in Acro mode"),
    real!("MC_ACRO_P_MAX", None, 1.0..=1800.0, sticks.pitch_rad_s, 57.295_779_513_082_32, "deg/s", "Pitch rate at full stick deflection in Acro mode"),
    real!("MC_ACRO_Y_MAX", None, 1.0..=1800.0, sticks.spin_rad_s, 57.295_779_513_082_32, "deg/s", "Yaw rate at full stick deflection in Acro mode"),
    real!("MC_ACRO_EXPO", None, 0.0..=1.0, sticks.exponent, "", "How much gentler the middle of the sticks is in Acro mode"),
];

/// Bits that are kept as they are shown.
pub(super) const fn same(bits: u32) -> u32 {
    bits
}

const PX4_LOSS: &[(RadioLossAction, i32, &str)] = &[
    (RadioLossAction::None, 0, "Nothing"),
    (RadioLossAction::Hold, 1, "Hold"),
    (RadioLossAction::Return, 2, "Return"),
    (RadioLossAction::Land, 3, "Land"),
    (RadioLossAction::Terminate, 5, "Terminate"),
    (RadioLossAction::Disarm, 6, "Disarm"),
];
const RUDDER: &[(RudderArming, i32, &str)] = &[
    (RudderArming::Off, 0, "Nothing"),
    (RudderArming::Arms, 1, "Arm"),
    (RudderArming::ArmsAndDisarms, 2, "Arm and disarm"),
];
const GESTURES: &[(RudderArming, i32, &str)] =
    &[(RudderArming::Off, 0, "Off"), (RudderArming::ArmsAndDisarms, 1, "On")];
const FAILURES: &[(RadioFailure, i32, &str)] = &[
    (RadioFailure::None, 0, "Works"),
    (RadioFailure::NoPulses, 1, "No pulses"),
    (RadioFailure::LowThrottle, 2, "Sticks centred, throttle at 950 us"),
    (RadioFailure::Told, 3, "Told by the receiver"),
];
const TRAINERS: &[(Trainer, i32, &str)] = &[
    (Trainer::Off, 0, "Off"),
    (Trainer::Levels, 1, "Levels"),
    (Trainer::LevelsAndLimits, 2, "Levels and limits the lean"),
];
const INPUTS: &[(InputChoice, i32, &str)] = &[
    (InputChoice::Radio, 0, "Radio only"),
    (InputChoice::Joystick, 1, "Joystick only"),
    (InputChoice::Either, 2, "Both, the radio goes first"),
    (InputChoice::First, 3, "Whichever comes first"),
    (InputChoice::Nothing, 4, "None"),
];
const CURVES: &[(bool, i32, &str)] = &[(true, 0, "Hovering thrust"), (false, 1, "Half of the thrust")];
const EXCEPTIONS: &[&str] = &["Mission", "Hold and other automatic modes", "Offboard"];
const OPTIONS: &[&str] = &[
    "Continue a mission without the radio",
    "Continue a mission without the ground station",
    "Continue in guided mode without the radio",
    "Continue a landing",
    "Continue with a pilot without the ground station",
    "Release the gripper",
];
const PINS: &[&str] = &[
    "Pin 0", "Pin 1", "Pin 2", "Pin 3", "Pin 4", "Pin 5", "Pin 6", "Pin 7", "Pin 8", "Pin 9", "Pin 10",
    "Pin 11", "Pin 12", "Pin 13", "Pin 14", "Pin 15",
];
const SLOTS: &[&str] = &["Position 1", "Position 2", "Position 3", "Position 4", "Position 5", "Position 6"];
const OVERRIDES: &[&str] = &["Automatic modes", "Offboard"];
