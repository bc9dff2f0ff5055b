//! The radio of one vehicle.

use serde::{Deserialize, Serialize};

use super::button::ButtonSettings;
use super::channel::Channel;
use super::knob::Knobs;

/// Channels of the sticks, from 1; 0: none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axes {
    /// Roll.
    pub roll: f64,
    /// Pitch.
    pub pitch: f64,
    /// Throttle.
    pub throttle: f64,
    /// Yaw.
    pub yaw: f64,
}

/// Channels of PX4's switches, from 1; 0: none.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Switches {
    /// Arms and disarms (RC_MAP_ARM_SW).
    pub arm: f64,
    /// Stops the rotors (RC_MAP_KILL_SW).
    pub kill: f64,
    /// Returns (RC_MAP_RETURN_SW).
    pub return_home: f64,
    /// Holds (RC_MAP_LOITER_SW).
    pub hold: f64,
    /// Follows set-points (RC_MAP_OFFB_SW).
    pub offboard: f64,
}

/// Where sticks may come from (COM_RC_IN_MODE).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum InputChoice {
    /// The radio only.
    Radio,
    /// MANUAL_CONTROL only.
    Joystick,
    /// Both; the radio goes first.
    Either,
    /// Whichever came first.
    First,
    /// Neither.
    Nothing,
}

/// What the rudder stick does at the ends of its way (ARMING_RUDDER).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum RudderArming {
    /// Nothing.
    Off,
    /// Arms.
    Arms,
    /// Arms and disarms.
    ArmsAndDisarms,
}

/// How the simulated receiver fails (SIM_RC_FAIL).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum RadioFailure {
    /// It works.
    None,
    /// No pulses.
    NoPulses,
    /// The sticks are centred, and the throttle is at 950 µs.
    LowThrottle,
    /// It says itself that it has lost its sender.
    Told,
}

impl RadioFailure {
    /// Whether nothing of what it shows counts.
    pub fn is_silence(self) -> bool {
        matches!(self, Self::NoPulses | Self::Told)
    }
}

/// How a vehicle reads its radio.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RadioSettings {
    /// The channels.
    pub channels: [Channel; 16],
    /// Those of the sticks.
    pub axes: Axes,
    /// That of the mode switch, from 1; 0: none.
    pub mode_channel: f64,
    /// Modes of its six positions: ArduPilot's numbers, or PX4's of COM_FLTMODE1.
    pub modes: [f64; 6],
    /// Positions of the mode switch, as bits, in which sticks refer to the heading of arming (SIMPLE).
    #[serde(default)]
    pub simple_slots: u32,
    /// Positions of it in which they refer to the direction away from home (SUPER_SIMPLE).
    #[serde(default)]
    pub super_simple_slots: u32,
    /// PX4's switches.
    pub switches: Switches,
    /// Where sticks may come from.
    pub inputs: InputChoice,
    /// Modes in which nothing is done when the pilot is lost (COM_RCL_EXCEPT): 1 mission, 2 other automatic modes, 4 offboard.
    pub lost_exceptions: u32,
    /// What ArduPilot's FS_OPTIONS add up to.
    pub options: u32,
    /// Shorter pulses of the throttle than this, µs, are those of a receiver that has lost its sender (FS_THR_VALUE).
    pub low_throttle_us: f64,
    /// Overrides of channels count for this long, s; negative: for ever, 0: not at all (RC_OVERRIDE_TIME).
    pub override_s: f64,
    /// What the rudder stick does.
    pub rudder: RudderArming,
    /// Whether moved sticks take over automatic (1) and offboard (2) modes, added up (COM_RC_OVERRIDE).
    pub take_over: u32,
    /// By how much a stick must be moved for that, percent (COM_RC_STICK_OV).
    pub take_over_percent: f64,
    /// What is broken.
    pub failure: RadioFailure,
    /// Buttons beside the radio.
    #[serde(default)]
    pub buttons: ButtonSettings,
    /// Knobs that change values in flight.
    #[serde(default)]
    pub knobs: Knobs,
}

impl Default for RadioSettings {
    fn default() -> Self {
        Self::new(false)
    }
}

/// ArduPilot's values are those that its simulation starts with, PX4's those of a calibrated radio.
impl RadioSettings {
    /// The defaults, which differ by convention.
    pub fn new(ardupilot: bool) -> Self {
        let mut channels = [Channel::new(if ardupilot { 0.0 } else { 10.0 }); 16];
        if ardupilot {
            let [roll, pitch, throttle, yaw, _, _, seventh, ..] = &mut channels;
            for stick in [roll, pitch, yaw] {
                stick.dead_zone_us = 20.0;
            }
            throttle.dead_zone_us = 30.0;
            seventh.option = 7.0;
        }
        Self {
            channels,
            axes: Axes { roll: 1.0, pitch: 2.0, throttle: 3.0, yaw: 4.0 },
            mode_channel: if ardupilot { 5.0 } else { 0.0 },
            modes: if ardupilot { [7.0, 9.0, 6.0, 3.0, 5.0, 0.0] } else { [-1.0; 6] },
            simple_slots: 0,
            super_simple_slots: 0,
            switches: Switches::default(),
            inputs: InputChoice::Either,
            lost_exceptions: 0,
            options: 16,
            low_throttle_us: 975.0,
            override_s: 3.0,
            rudder: RudderArming::ArmsAndDisarms,
            take_over: 1,
            take_over_percent: 30.0,
            failure: RadioFailure::None,
            buttons: ButtonSettings::default(),
            knobs: Knobs::default(),
        }
    }

    /// The calibration of a channel from 1.
    pub fn channel(&self, number: f64) -> Option<(usize, &Channel)> {
        let index = (number as usize).checked_sub(1)?;
        Some((index, self.channels.get(index)?))
    }
}

/// Main and sub-mode of PX4's numbers of COM_FLTMODE1.
pub const PX4_SLOTS: &[(i32, [u32; 2], &str)] = &[
    (0, [1, 0], "Manual"),
    (1, [2, 0], "Altitude"),
    (2, [3, 0], "Position"),
    (3, [4, 4], "Mission"),
    (4, [4, 3], "Hold"),
    (5, [4, 5], "Return"),
    (6, [5, 0], "Acro"),
    (7, [6, 0], "Offboard"),
    (8, [7, 0], "Stabilized"),
    (10, [4, 2], "Takeoff"),
    (11, [4, 6], "Land"),
    (12, [4, 8], "Follow me"),
];
