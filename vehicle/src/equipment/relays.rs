//! Relays.

use super::operation::Switch;
use super::repetition::Repetition;
use crate::Refusal;

/// Relays that there are, counted from 0.
pub const RELAYS: u8 = 6;

/// Which relays are on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Relays {
    /// A bit for each.
    on: u16,
    repeated: Option<(u8, Repetition)>,
}

impl Relays {
    /// Those that are on, a bit for each.
    pub fn on(&self) -> u16 {
        self.on
    }

    /// Those that there are, a bit for each.
    pub fn present() -> u16 {
        (1 << RELAYS) - 1
    }

    /// Switches one.
    ///
    /// # Errors
    /// [`Refusal`] of one that there is not.
    pub fn set(&mut self, relay: u8, to: Switch) -> Result<(), Refusal> {
        let bit = Self::bit(relay)?;
        self.repeated = self.repeated.filter(|(repeated, _)| *repeated != relay);
        match to {
            Switch::On => self.on |= bit,
            Switch::Off => self.on &= !bit,
            Switch::Toggle => self.on ^= bit,
        }
        Ok(())
    }

    /// Switches one to the other state and back, so many times.
    ///
    /// # Errors
    /// [`Refusal`] of one that there is not.
    pub fn repeat(&mut self, relay: u8, cycles: u32, period_s: f64, now_us: u64) -> Result<(), Refusal> {
        Self::bit(relay)?;
        self.repeated = Some((relay, Repetition::new(cycles, period_s, now_us)));
        Ok(())
    }

    /// What is due by now.
    pub fn step(&mut self, now_us: u64) {
        let Some((relay, mut repetition)) = self.repeated else { return };
        if repetition.due(now_us).is_some() {
            self.on ^= 1 << relay;
        }
        self.repeated = Some((relay, repetition)).filter(|_| !repetition.is_over());
    }

    /// Whether nothing will happen by itself.
    pub fn rest(&self) -> bool {
        self.repeated.is_none()
    }

    fn bit(relay: u8) -> Result<u16, Refusal> {
        if relay < RELAYS {
            Ok(1 << relay)
        } else {
            Err(Refusal::Failed(format!("Relay {relay} does not exist; allowed 0 to {}", RELAYS - 1)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Relays, Switch};

    #[test]
    fn each_is_switched_by_itself() {
        let mut relays = Relays::default();
        relays.set(0, Switch::On).unwrap();
        relays.set(5, Switch::Toggle).unwrap();
        assert_eq!(relays.on(), 0b10_0001);
        relays.set(0, Switch::Off).unwrap();
        assert_eq!(relays.on(), 0b10_0000);
        assert!(relays.set(6, Switch::On).is_err());
        relays.repeat(5, 1, 1.0, 0).unwrap();
        relays.step(0);
        assert_eq!(relays.on(), 0);
        relays.step(500_000);
        assert_eq!((relays.on(), relays.rest()), (0b10_0000, true));
    }
}
