//! HIL_ACTUATOR_CONTROLS.

use autopilot::codec::Frame;

/// Motor commands of an autopilot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorControls {
    /// Time of the HIL_SENSOR that they answer, µs; zero if unknown.
    pub time_us: u64,
    /// Whether the autopilot runs in lock-step.
    pub lockstep: bool,
    /// Whether the motors may turn.
    pub armed: bool,
    /// Motors 1 to 4, 0 to 1; values that are not finite count as 0.
    pub motors: [f64; 4],
}

impl ActuatorControls {
    /// Identifier of the message.
    pub const ID: u32 = 93;

    /// Reads a frame of it.
    pub fn read(frame: &Frame) -> Self {
        const LOCKSTEP: u64 = 1;
        const ARMED: u8 = 128;
        let payload = frame.payload();
        let motors: [f64; 4] = payload.reals(16);
        Self {
            time_us: payload.u64(0),
            lockstep: payload.u64(8) & LOCKSTEP != 0,
            armed: payload.u8(80) & ARMED != 0,
            motors: motors.map(|motor| if motor.is_finite() { motor.clamp(0.0, 1.0) } else { 0.0 }),
        }
    }
}
