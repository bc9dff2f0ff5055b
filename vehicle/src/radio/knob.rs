//! Knobs of the radio that change a value in flight (ArduPilot's TUNE).

use serde::{Deserialize, Serialize};

use super::settings::RadioSettings;

/// Numbers of the channels' options that are the two knobs.
pub const KNOBS: [u32; 2] = [219, 220];

/// What a knob changes, and between which values.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Knob {
    /// ArduPilot's number of what it changes; 0: nothing.
    pub target: f64,
    /// The value of its low end.
    pub minimum: f64,
    /// The value of its high end.
    pub maximum: f64,
}

/// Both of them.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Knobs {
    /// TUNE.
    pub first: Knob,
    /// TUNE2.
    pub second: Knob,
}

impl RadioSettings {
    /// The value that a knob, 0 or 1, asks for with these pulses, µs, and the number of what it changes. `None`: it has no channel, or
    /// changes nothing.
    pub fn turned(&self, index: usize, pulses: &[u16]) -> Option<(u32, f64)> {
        let knob = if index == 0 { &self.knobs.first } else { &self.knobs.second };
        let option = f64::from(*KNOBS.get(index)?);
        if knob.target <= 0.0 || knob.minimum == 0.0 && knob.maximum == 0.0 {
            return None;
        }
        let mut channels = self.channels.iter().zip(pulses);
        let (channel, pulse) = channels.find(|(channel, _)| channel.option == option)?;
        let whole_us = channel.maximum_us - channel.minimum_us;
        if *pulse == 0 || whole_us <= 0.0 {
            return None;
        }
        let share = ((f64::from(*pulse) - channel.minimum_us) / whole_us).clamp(0.0, 1.0);
        Some((knob.target as u32, knob.minimum + share * (knob.maximum - knob.minimum)))
    }
}

#[cfg(test)]
mod tests {
    use super::{Knob, RadioSettings};

    #[test]
    fn a_knob_goes_from_one_value_to_the_other() {
        let mut settings = RadioSettings::new(true);
        settings.knobs.second = Knob { target: 60.0, minimum: 0.25, maximum: 10.25 };
        let pulses = [1500, 1500, 1000, 1500, 1800, 1125, 1150];
        assert_eq!(settings.turned(1, &pulses), None, "no channel");
        settings.channels[6].option = 220.0;
        (settings.channels[6].minimum_us, settings.channels[6].maximum_us) = (1100.0, 1200.0);
        assert_eq!(settings.turned(1, &pulses), Some((60, 5.25)));
        for (pulse, value) in [(1100, Some(0.25)), (1000, Some(0.25)), (1200, Some(10.25)), (0, None)] {
            let pulses = [0, 0, 0, 0, 0, 0, pulse];
            assert_eq!(settings.turned(1, &pulses).map(|(_, value)| value), value, "{pulse}");
        }
        assert_eq!(settings.turned(0, &pulses), None, "another knob");
    }
}
