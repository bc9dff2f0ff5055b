//! COMMAND_LONG and COMMAND_INT.

use super::{Frame, id};

/// Which of the two messages carried a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommandKind {
    /// COMMAND_LONG: seven floats.
    Long {
        /// How often the sender has sent it before.
        confirmation: u8,
    },
    /// COMMAND_INT: positions as scaled integers, in a frame.
    Int {
        /// MAV_FRAME.
        frame: u8,
    },
}

/// A command with its parameters. What the sender left out is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command {
    /// MAV_CMD; any number.
    pub number: u16,
    /// Component that it is for; 0: all of them.
    pub component: u8,
    /// How it came.
    pub kind: CommandKind,
    /// Parameters 1 to 4.
    pub parameters: [f64; 4],
    /// Parameter 5: latitude, degrees, or x of a local frame, m.
    pub x: f64,
    /// Parameter 6: longitude, degrees, or y of a local frame, m.
    pub y: f64,
    /// Parameter 7: altitude or z, m.
    pub z: f64,
}

impl Command {
    /// Reads either message.
    pub fn read(frame: &Frame) -> Option<Self> {
        let payload = frame.payload();
        let (number, component) = (payload.u16(28), payload.u8(31));
        let parameters = payload.reals(0);
        match frame.message_id() {
            id::COMMAND_LONG => {
                let [x, y, z] = payload.reals(16);
                Some(Self {
                    number,
                    component,
                    kind: CommandKind::Long { confirmation: payload.u8(32) },
                    parameters,
                    x,
                    y,
                    z,
                })
            }
            id::COMMAND_INT => {
                let kind = CommandKind::Int { frame: payload.u8(32) };
                let scale = scale(payload.u8(32));
                let real = |offset| match payload.i32(offset) {
                    // The integer that stands for "not given".
                    i32::MAX => f64::NAN,
                    value => f64::from(value) / scale,
                };
                let z = f64::from(payload.f32(24));
                Some(Self { number, component, kind, parameters, x: real(16), y: real(20), z })
            }
            _ => None,
        }
    }

    /// Parameter `n` of 1 to 4.
    pub fn parameter(&self, n: usize) -> f64 {
        n.checked_sub(1).and_then(|index| self.parameters.get(index)).copied().unwrap_or(f64::NAN)
    }

    /// Parameter `n` of 1 to 7 of a command that names no place: COMMAND_INT carries the fifth and the sixth as they are.
    pub fn integer(&self, n: usize) -> f64 {
        let scale = match self.kind {
            CommandKind::Long { .. } => 1.0,
            CommandKind::Int { frame } => scale(frame),
        };
        match n {
            5 => libm::round(self.x * scale),
            6 => libm::round(self.y * scale),
            7 => self.z,
            _ => self.parameter(n),
        }
    }

    /// A parameter that counts something: `None` unless it is a whole number that is not negative.
    pub fn whole(&self, n: usize) -> Option<u32> {
        let value = self.parameter(n);
        (value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value)).then_some(value as u32)
    }
}

/// How many integers of COMMAND_INT are a degree or, in a local frame, a metre.
fn scale(frame: u8) -> f64 {
    if is_local(frame) { 1e4 } else { 1e7 }
}

/// MAV_FRAME with metres instead of degrees.
pub(super) fn is_local(frame: u8) -> bool {
    matches!(frame, 1 | 4 | 7 | 8 | 9 | 12 | 20 | 21)
}
