//! MANUAL_CONTROL and RC_CHANNELS_OVERRIDE: sticks of the position mode.

use vehicle::Sticks;

use super::Service;
use crate::codec::{Frame, id};
use crate::context::Context;
use crate::envelope::Origin;

/// Hands sticks on to the vehicle.
#[derive(Clone, Copy, Debug)]
pub struct ManualControl;

impl Service for ManualControl {
    fn summary(&self) -> &'static str {
        "Sticks"
    }

    fn messages(&self) -> &'static [u32] {
        &[id::MANUAL_CONTROL, id::RC_CHANNELS_OVERRIDE]
    }

    fn receive(&mut self, context: &mut Context, _origin: &Origin, frame: &Frame) {
        match frame.message_id() {
            id::MANUAL_CONTROL => manual_control(context, frame),
            _ => channels_override(context, frame),
        }
    }
}

/// MANUAL_CONTROL: ±1000, the thrust stick 0 to 1000 with its centre at 500.
fn manual_control(context: &mut Context, frame: &Frame) {
    let payload = frame.payload();
    // The largest negative number stands for an axis that is not there.
    let axis = |offset| match payload.i16(offset) {
        i16::MAX | i16::MIN => 0.0,
        value => f64::from(value) / 1000.0,
    };
    let up = match payload.i16(4) {
        i16::MAX | i16::MIN => 0.0,
        value => (f64::from(value) - 500.0) / 500.0,
    };
    let sticks = Sticks { forward: axis(0), right: axis(2), up, turn: axis(6) };
    context.vehicle.move_sticks(sticks);
}

/// RC_CHANNELS_OVERRIDE: roll, pitch, throttle and yaw as pulses of 1000 to 2000 µs. All four released ends it.
fn channels_override(context: &mut Context, frame: &Frame) {
    let payload = frame.payload();
    // 0 releases a channel, 65535 leaves it.
    let channel = |number: usize| match payload.u16(2 * number) {
        0 | u16::MAX => None,
        pulse => Some((f64::from(pulse) - 1500.0) / 500.0),
    };
    let channels = [channel(0), channel(1), channel(2), channel(3)];
    if channels.iter().all(Option::is_none) {
        return;
    }
    let [roll, pitch, throttle, yaw] = channels.map(|channel| channel.unwrap_or(0.0));
    // A pitch stick that is pulled is a long pulse.
    context.vehicle.move_sticks(Sticks { forward: -pitch, right: roll, up: throttle, turn: yaw });
}
