//! Buttons on the vehicle's pins, which do what switches of the radio do (ArduPilot: BTN_…).

use serde::{Deserialize, Serialize};

/// Buttons that there may be.
pub const BUTTONS: usize = 4;

/// One button.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Button {
    /// Its pin; −1: none.
    pub pin: f64,
    /// ArduPilot's number of its function; 0: none.
    pub function: f64,
    /// Whether it counts as pressed while its pin is low.
    pub inverted: bool,
}

/// All buttons.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ButtonSettings {
    /// Whether they are looked at.
    pub enabled: bool,
    /// The buttons.
    pub buttons: [Button; BUTTONS],
    /// For how long a change is told, s.
    pub told_s: f64,
    /// Pins that are simulated as high, as bits (SIM_PIN_MASK).
    pub high_pins: u32,
}

/// ArduPilot's.
impl Default for ButtonSettings {
    fn default() -> Self {
        let button = Button { pin: -1.0, function: 0.0, inverted: false };
        Self { enabled: false, buttons: [button; BUTTONS], told_s: 10.0, high_pins: 0 }
    }
}

impl ButtonSettings {
    /// The buttons that are pressed, as bits.
    pub fn pressed(&self) -> u8 {
        if !self.enabled {
            return 0;
        }
        let is_pressed = |button: &Button| {
            let high = (0.0..32.0).contains(&button.pin) && self.high_pins >> button.pin as u32 & 1 != 0;
            button.pin >= 0.0 && high != button.inverted
        };
        let bits =
            self.buttons.iter().enumerate().map(|(place, button)| u8::from(is_pressed(button)) << place);
        bits.sum()
    }
}

#[cfg(test)]
mod tests {
    use super::ButtonSettings;

    #[test]
    fn a_button_is_pressed_by_its_pin() {
        let mut settings = ButtonSettings { enabled: true, ..ButtonSettings::default() };
        settings.high_pins = 0b1000;
        assert_eq!(settings.pressed(), 0);
        settings.buttons[1].pin = 3.0;
        assert_eq!(settings.pressed(), 0b10);
        settings.buttons[0].pin = 2.0;
        settings.buttons[0].inverted = true;
        assert_eq!(settings.pressed(), 0b11);
        settings.enabled = false;
        assert_eq!(settings.pressed(), 0);
    }
}
