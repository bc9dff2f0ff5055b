//! The safety switch of ArduPilot's boards: while it is on, no output is driven, and the vehicle does not arm.

use super::notice::Refusal;

/// Whether it is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct SafetySwitch {
    is_on: bool,
}

impl SafetySwitch {
    /// At the start (BRD_SAFETY_DEFLT).
    pub fn new(is_on: bool) -> Self {
        Self { is_on }
    }

    /// Whether it is on.
    pub fn is_on(&self) -> bool {
        self.is_on
    }

    /// Switches it.
    ///
    /// # Errors
    /// [`Refusal::Failed`] where it would stop rotors that are to turn.
    pub fn switch(&mut self, on: bool, armed: bool) -> Result<(), Refusal> {
        if on && armed {
            return Err(Refusal::Failed("Safety switch stays off while armed: disarm first".to_owned()));
        }
        self.is_on = on;
        Ok(())
    }

    /// What speaks against arming, in the words of ArduPilot, and how to go on.
    pub fn obstacle(&self) -> Option<&'static str> {
        self.is_on
            .then_some("Hardware safety switch is on; switch it off (DO_SET_SAFETY_SWITCH_STATE, param1 = 1)")
    }
}
