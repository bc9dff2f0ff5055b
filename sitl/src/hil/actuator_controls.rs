//! HIL_ACTUATOR_CONTROLS.

use autopilot::codec::Frame;

/// What an autopilot wants of the motors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorControls {
    /// The autopilot's time, µs: that of the sensors that they answer. Zero if it tells none.
    pub time_us: u64,
    /// Whether it waits for sensors as we wait for controls.
    pub lockstep: bool,
    /// Whether the motors may turn.
    pub armed: bool,
    /// Motors 1 to 4, 0 to 1. What is no number counts as 0.
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
