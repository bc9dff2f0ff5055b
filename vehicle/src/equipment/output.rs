//! One servo output as ArduPilot's parameters describe it: what it follows, its ends and its direction.

use serde::{Deserialize, Serialize};

use super::servos::{CHANNELS, FIRST_FREE_CHANNEL};
use crate::radio::Channel;

/// Outputs that are no rotor's.
pub const FREE_OUTPUTS: usize = CHANNELS + 1 - FIRST_FREE_CHANNEL as usize;
/// Steps in which ArduPilot counts a deflection.
const STEPS: f64 = 4500.0;

/// An axis of the gimbal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // They are what they are called.
pub enum GimbalAxis {
    Roll,
    Pitch,
    Yaw,
}

/// What an output follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // The sentences of the variants name their fields.
pub enum OutputFunction {
    /// Commands: DO_SET_SERVO and its like.
    Command,
    /// A channel of the radio, counted from 1: its pulse, or its deflection between the ends of the output.
    Radio { channel: usize, scaled: bool },
    /// An axis of the gimbal.
    Gimbal(GimbalAxis),
    /// The gripper.
    Gripper,
    /// The parachute.
    Parachute,
    /// The landing gear.
    LandingGear,
    /// Its shortest pulse.
    Minimum,
    /// The pulse of its centre.
    Trim,
    /// Its longest pulse.
    Maximum,
    /// Something that this vehicle does not carry.
    Nothing,
}

/// The settings of an output (SERVOn_FUNCTION, _MIN, _MAX, _TRIM, _REVERSED).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Output {
    /// ArduPilot's number of its function.
    pub function: f64,
    /// Shortest pulse, µs.
    pub minimum_us: f64,
    /// Longest pulse, µs.
    pub maximum_us: f64,
    /// Pulse of its centre, µs.
    pub trim_us: f64,
    /// Whether a deflection moves it the other way.
    pub reversed: bool,
}

/// ArduPilot's.
impl Default for Output {
    fn default() -> Self {
        Self { function: 0.0, minimum_us: 1100.0, maximum_us: 1900.0, trim_us: 1500.0, reversed: false }
    }
}

impl Output {
    /// What it follows. `number` is its own, from 1.
    pub fn follows(&self, number: usize) -> OutputFunction {
        let radio = |channel: usize, scaled| OutputFunction::Radio { channel, scaled };
        match self.function as i32 {
            0 => OutputFunction::Command,
            1 => radio(number, false),
            6 => OutputFunction::Gimbal(GimbalAxis::Yaw),
            7 => OutputFunction::Gimbal(GimbalAxis::Pitch),
            8 => OutputFunction::Gimbal(GimbalAxis::Roll),
            27 => OutputFunction::Parachute,
            28 => OutputFunction::Gripper,
            29 => OutputFunction::LandingGear,
            function @ 51..=66 => radio((function - 50) as usize, false),
            134 => OutputFunction::Minimum,
            135 => OutputFunction::Trim,
            136 => OutputFunction::Maximum,
            function @ 140..=155 => radio((function - 139) as usize, true),
            _ => OutputFunction::Nothing,
        }
    }

    /// The pulse of a deflection within ±1 from its centre, µs.
    pub fn deflected_us(&self, deflection: f64) -> u16 {
        let steps = (if self.reversed { -deflection } else { deflection } * STEPS).trunc();
        let way_us =
            if steps > 0.0 { self.maximum_us - self.trim_us } else { self.trim_us - self.minimum_us };
        (self.trim_us + (steps * way_us / STEPS).trunc()) as u16
    }

    /// The pulse of a share of its way, 0 to 1, µs.
    pub fn along_us(&self, share: f64) -> u16 {
        let share = if self.reversed { 1.0 - share } else { share }.clamp(0.0, 1.0);
        (self.minimum_us + share * (self.maximum_us - self.minimum_us)).round() as u16
    }

    /// The pulse of a channel of the radio that is scaled to it, µs. The throttle has no centre.
    pub fn scaled_us(&self, channel: &Channel, pulse_us: u16, is_throttle: bool) -> u16 {
        if is_throttle {
            return self.along_us(Channel { dead_zone_us: 0.0, ..*channel }.way(pulse_us));
        }
        self.deflected_us(channel.deflection(pulse_us))
    }
}

#[cfg(test)]
mod tests {
    use super::{Output, OutputFunction};
    use crate::radio::Channel;

    /// Pulses that ArduPilot's own tests and its documentation give.
    #[test]
    fn a_channel_is_scaled_about_the_centre_of_the_output() {
        let output = Output { minimum_us: 1000.0, maximum_us: 2000.0, trim_us: 1450.0, ..Output::default() };
        let channel = Channel::new(0.0);
        for (pulse_us, expected) in [(1799, 1778), (1500, 1450), (1000, 1000), (2000, 2000), (1250, 1225)] {
            assert_eq!(output.scaled_us(&channel, pulse_us, false), expected, "{pulse_us}");
        }
        let reversed = Output { reversed: true, ..output };
        assert_eq!(reversed.scaled_us(&channel, 2000, false), 1000);
        assert_eq!((output.along_us(0.25), reversed.along_us(0.25)), (1250, 1750));
        let throttle = Channel::new(30.0);
        assert_eq!(output.scaled_us(&throttle, 1020, true), 1020);
    }

    #[test]
    fn functions_are_those_of_ardupilot() {
        let of = |function: f64| Output { function, ..Output::default() }.follows(9);
        let radio = |channel, scaled| OutputFunction::Radio { channel, scaled };
        for (number, function) in [
            (0.0, OutputFunction::Command),
            (1.0, radio(9, false)),
            (51.0, radio(1, false)),
            (66.0, radio(16, false)),
            (140.0, radio(1, true)),
            (146.0, radio(7, true)),
            (155.0, radio(16, true)),
            (28.0, OutputFunction::Gripper),
            (33.0, OutputFunction::Nothing),
        ] {
            assert_eq!(of(number), function, "{number}");
        }
    }
}
