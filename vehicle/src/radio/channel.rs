//! How the pulses of one channel are read.

use serde::{Deserialize, Serialize};

/// The calibration of a channel, and what it is for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Channel {
    /// The shortest pulse, µs.
    pub minimum_us: f64,
    /// The longest pulse, µs.
    pub maximum_us: f64,
    /// The pulse of a centred stick, µs.
    pub trim_us: f64,
    /// Pulses this near to the trim, or for a throttle to its low end, mean zero, µs.
    pub dead_zone_us: f64,
    /// Whether a long pulse means the opposite.
    pub reversed: bool,
    /// ArduPilot's number of the function of a switch; 0: none.
    pub option: f64,
}

impl Channel {
    /// A channel of 1000 to 2000 µs with a dead zone, µs.
    pub const fn new(dead_zone_us: f64) -> Self {
        Self {
            minimum_us: 1000.0,
            maximum_us: 2000.0,
            trim_us: 1500.0,
            dead_zone_us,
            reversed: false,
            option: 0.0,
        }
    }

    /// The pulse within the ends, in the direction that the channel means.
    fn meant_us(&self, pulse_us: u16) -> f64 {
        f64::from(pulse_us).min(self.maximum_us).max(self.minimum_us)
    }

    /// Deflection from the trim within ±1, without the dead zone.
    pub fn deflection(&self, pulse_us: u16) -> f64 {
        let pulse_us = self.meant_us(pulse_us);
        let (high, low) = (self.trim_us + self.dead_zone_us, self.trim_us - self.dead_zone_us);
        let share = |way: f64, whole: f64| if whole > 0.0 { (way / whole).min(1.0) } else { 0.0 };
        let deflection = if pulse_us > high {
            share(pulse_us - high, self.maximum_us - high)
        } else if pulse_us < low {
            -share(low - pulse_us, low - self.minimum_us)
        } else {
            0.0
        };
        if self.reversed { -deflection } else { deflection }
    }

    /// Way from the low end, 0 to 1, without the dead zone.
    pub fn way(&self, pulse_us: u16) -> f64 {
        let pulse_us = self.meant_us(pulse_us);
        let pulse_us = if self.reversed { self.maximum_us + self.minimum_us - pulse_us } else { pulse_us };
        let low = self.minimum_us + self.dead_zone_us;
        if pulse_us > low && self.maximum_us > low { (pulse_us - low) / (self.maximum_us - low) } else { 0.0 }
    }

    /// The way in the middle between the ends.
    pub fn middle_way(&self) -> f64 {
        self.way(((self.minimum_us + self.maximum_us) / 2.0) as u16)
    }

    /// The pulse of a share of the way between the ends, 0 to 1.
    pub fn pulse_us(&self, share: f64) -> u16 {
        let share = if self.reversed { 1.0 - share } else { share };
        (self.minimum_us + share.clamp(0.0, 1.0) * (self.maximum_us - self.minimum_us)).round() as u16
    }
}

#[cfg(test)]
mod tests {
    use super::Channel;

    #[test]
    fn a_deflection_begins_beyond_the_dead_zone_and_ends_at_the_ends() {
        let channel = Channel { minimum_us: 1100.0, maximum_us: 1900.0, ..Channel::new(20.0) };
        for (pulse, deflection) in [
            (1500, 0.0),
            (1520, 0.0),
            (1480, 0.0),
            (1900, 1.0),
            (2100, 1.0),
            (1100, -1.0),
            (900, -1.0),
            (1710, 0.5),
        ] {
            assert!((channel.deflection(pulse) - deflection).abs() < 1e-12, "{pulse}");
            let reversed = Channel { reversed: true, ..channel };
            assert!((reversed.deflection(pulse) + deflection).abs() < 1e-12, "{pulse}");
        }
        // ArduPilot's mid-stick of a throttle with a dead zone of 30 µs is 484 of 1000.
        let throttle = Channel::new(30.0);
        assert!((throttle.middle_way() - 470.0 / 970.0).abs() < 1e-12);
        assert_eq!((throttle.way(1030), throttle.way(2000)), (0.0, 1.0));
        assert_eq!(Channel { reversed: true, ..throttle }.way(1000), 1.0);
        for share in [0.0, 0.25, 1.0] {
            for reversed in [false, true] {
                let channel = Channel { reversed, ..Channel::new(0.0) };
                assert!((channel.way(channel.pulse_us(share)) - share).abs() < 1e-9);
            }
        }
    }
}
