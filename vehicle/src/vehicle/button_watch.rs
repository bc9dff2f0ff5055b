//! Buttons that are pressed and released.

use crate::radio::{ButtonSettings, Position};

/// What has been seen of the buttons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ButtonWatch {
    pressed: u8,
    changed_us: Option<u64>,
}

impl ButtonWatch {
    /// The buttons that are pressed, as bits, and when that has changed last, µs; `None`: never.
    pub fn state(&self) -> (u8, Option<u64>) {
        (self.pressed, self.changed_us)
    }

    /// Looks at the buttons at a time, µs. Returns the functions of those that have changed, with the positions that a switch would have.
    pub fn look(&mut self, settings: &ButtonSettings, time_us: u64) -> Vec<(u32, Position)> {
        let pressed = settings.pressed();
        let changed = pressed ^ self.pressed;
        if changed == 0 {
            return Vec::new();
        }
        (self.pressed, self.changed_us) = (pressed, Some(time_us));
        let of = |bits: u8, place: usize| bits >> place & 1 != 0;
        let buttons = settings.buttons.iter().enumerate();
        let buttons = buttons.filter(|(place, button)| of(changed, *place) && button.function > 0.0);
        buttons
            .map(|(place, button)| {
                let position = if of(pressed, place) { Position::High } else { Position::Low };
                (button.function as u32, position)
            })
            .collect()
    }
}
