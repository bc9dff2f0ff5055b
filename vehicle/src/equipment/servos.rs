//! Servo outputs beside the rotors'.

use super::repetition::Repetition;
use crate::Refusal;

/// Outputs that there are, counted from 1.
pub const CHANNELS: usize = 16;
/// The first of them that is no rotor's.
pub const FIRST_FREE_CHANNEL: u8 = 5;
/// A pulse to which a repeated servo returns, µs: the middle.
const MIDDLE_US: u16 = 1500;
/// Pulses, µs.
const PULSES_US: core::ops::RangeInclusive<u16> = 500..=2500;

/// Pulses of all outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Servos {
    /// µs; 0: nothing has been asked of it.
    pulses_us: [u16; CHANNELS],
    /// Output that is moved back and forth, by its place, and the pulse that it is moved to.
    repeated: Option<(usize, u16, Repetition)>,
}

impl Servos {
    /// The pulse of an output, counted from 1, µs; 0: none.
    pub fn pulse_us(&self, channel: usize) -> u16 {
        channel.checked_sub(1).and_then(|place| self.pulses_us.get(place)).copied().unwrap_or(0)
    }

    /// Moves an output to a pulse, µs; 0 ends its pulses.
    ///
    /// # Errors
    /// [`Refusal`] of a rotor, of an output that there is not, and of a pulse out of range.
    pub fn set(&mut self, channel: u8, pulse_us: u16) -> Result<(), Refusal> {
        let place = Self::place(channel, pulse_us)?;
        self.repeated = self.repeated.filter(|(repeated, ..)| *repeated != place);
        self.put(place, pulse_us);
        Ok(())
    }

    /// Moves an output to a pulse, µs, and back to the middle, so many times.
    ///
    /// # Errors
    /// As [`Servos::set`].
    pub fn repeat(
        &mut self,
        channel: u8,
        pulse_us: u16,
        cycles: u32,
        period_s: f64,
        now_us: u64,
    ) -> Result<(), Refusal> {
        let place = Self::place(channel, pulse_us)?;
        self.repeated = Some((place, pulse_us, Repetition::new(cycles, period_s, now_us)));
        Ok(())
    }

    /// What is due by now.
    pub fn step(&mut self, now_us: u64) {
        let Some((place, pulse_us, mut repetition)) = self.repeated else { return };
        if let Some(there) = repetition.due(now_us) {
            self.put(place, if there { pulse_us } else { MIDDLE_US });
        }
        self.repeated = Some((place, pulse_us, repetition)).filter(|_| !repetition.is_over());
    }

    /// Whether nothing will happen by itself.
    pub fn rest(&self) -> bool {
        self.repeated.is_none()
    }

    fn place(channel: u8, pulse_us: u16) -> Result<usize, Refusal> {
        if (1..FIRST_FREE_CHANNEL).contains(&channel) {
            return Err(Refusal::Failed(format!(
                "Servo {channel} drives a rotor; use {FIRST_FREE_CHANNEL} to {CHANNELS}"
            )));
        }
        if channel == 0 || usize::from(channel) > CHANNELS {
            return Err(Refusal::Failed(format!(
                "Servo {channel} does not exist; allowed {FIRST_FREE_CHANNEL} to {CHANNELS}"
            )));
        }
        if pulse_us != 0 && !PULSES_US.contains(&pulse_us) {
            let (low, high) = (PULSES_US.start(), PULSES_US.end());
            return Err(Refusal::denied(format!(
                "Servo pulse = {pulse_us} us; allowed 0, or {low} to {high} us"
            )));
        }
        Ok(usize::from(channel) - 1)
    }

    fn put(&mut self, place: usize, pulse_us: u16) {
        if let Some(pulse) = self.pulses_us.get_mut(place) {
            *pulse = pulse_us;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Servos;

    #[test]
    fn rotors_and_what_there_is_not_are_refused() {
        let mut servos = Servos::default();
        assert!(servos.set(9, 1900).is_ok());
        for (channel, pulse_us) in [(0, 1500), (1, 1500), (4, 1500), (17, 1500), (9, 499), (9, 2501)] {
            assert!(servos.set(channel, pulse_us).is_err(), "{channel} {pulse_us}");
        }
        assert_eq!((servos.pulse_us(9), servos.pulse_us(8), servos.pulse_us(0)), (1900, 0, 0));
    }

    #[test]
    fn a_repeated_servo_ends_in_the_middle() {
        let mut servos = Servos::default();
        servos.repeat(7, 1100, 2, 1.0, 0).unwrap();
        let mut seen = Vec::new();
        for now_us in (0..3_000_000).step_by(100_000) {
            servos.step(now_us);
            if seen.last() != Some(&servos.pulse_us(7)) {
                seen.push(servos.pulse_us(7));
            }
        }
        assert_eq!(seen, [1100, 1500, 1100, 1500]);
        assert!(servos.rest());
    }
}
