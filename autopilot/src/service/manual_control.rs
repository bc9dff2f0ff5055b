//! The pilot's radio: MANUAL_CONTROL and RC_CHANNELS_OVERRIDE in, RC_CHANNELS out, and functions of switches by command.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage, RC_CHANNELS_DATA, RC_CHANNELS_RAW_DATA};
use vehicle::radio::{CHANNELS, Position};
use vehicle::{Refusal, Sticks, Vehicle};

use super::command::as_told_by;
use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::{Command, Frame, boot_ms, id};
use crate::context::Context;
use crate::envelope::Origin;
use crate::stream::{Group, Stream};

const COMMANDS: &[CommandEntry] = &[CommandEntry::action(MavCmd::MAV_CMD_DO_AUX_FUNCTION as u16)];

const STREAMS: &[Stream] = &[
    Stream::new(RC_CHANNELS_DATA::ID, [5.0, 20.0], rc_channels).of(Group::RcChannels),
    // DroneKit knows no other one, and asks ArduPilot for the group.
    Stream::new(RC_CHANNELS_RAW_DATA::ID, [0.0, 0.0], rc_channels_raw).of(Group::RcChannels),
];

/// Hands sticks and pulses on to the vehicle.
#[derive(Clone, Copy, Debug)]
pub struct ManualControl;

impl Service for ManualControl {
    fn summary(&self) -> &'static str {
        "Sticks"
    }

    fn messages(&self) -> &'static [u32] {
        &[id::MANUAL_CONTROL, id::RC_CHANNELS_OVERRIDE]
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        // ArduPilot is flown by its own ground station alone.
        let stations = &context.vehicle.conduct().ground_stations;
        if context.identity().is_ardupilot() && !stations.include(origin.system) {
            return;
        }
        match frame.message_id() {
            id::MANUAL_CONTROL => manual_control(context, frame),
            _ => channels_override(context, frame),
        }
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        let position = match command.parameter(2) {
            0.0 => Position::Low,
            1.0 => Position::Middle,
            2.0 => Position::High,
            other => {
                let text =
                    format!("Switch position {other} is not available: 0 (low), 1 (middle) or 2 (high)");
                return Err(Refusal::denied(text));
            }
        };
        let number = command.parameter(1);
        let unknown = || Refusal::Unsupported(format!("RC switch function {number} is not available"));
        let function = command.whole(1).ok_or_else(unknown)?;
        let identity = context.identity();
        let moved = context.vehicle.move_switch(function, position);
        moved.map_err(|refusal| as_told_by(identity, refusal))?;
        Ok(Progress::Done)
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

/// RC_CHANNELS_OVERRIDE: pulses, µs. Among the first eight 0 gives a channel back and 65535 leaves it; among the others, which older
/// senders do not have, 0 leaves it, too, and 65534 gives it back.
fn channels_override(context: &mut Context, frame: &Frame) {
    const FIRST: usize = 8;
    /// Behind the first eight channels are the two numbers of the receiver.
    const TARGETS: usize = 2;
    let payload = frame.payload();
    let pulses: [Option<u16>; CHANNELS] = core::array::from_fn(|channel| {
        if channel < FIRST {
            return Some(payload.u16(2 * channel)).filter(|pulse| *pulse != u16::MAX);
        }
        match payload.u16(2 * channel + TARGETS) {
            0 | u16::MAX => None,
            pulse if pulse == u16::MAX - 1 => Some(0),
            pulse => Some(pulse),
        }
    });
    context.vehicle.override_channels(&pulses);
}

/// Pulses as messages have them, and how many channels there are.
fn pulses(vehicle: &Vehicle) -> ([u16; CHANNELS], u8) {
    match vehicle.pilot().pulses {
        None => ([u16::MAX; CHANNELS], 0),
        Some(pulses) => {
            let last = pulses.iter().rposition(|pulse| *pulse > 0).map_or(0, |last| last + 1);
            (pulses.map(|pulse| if pulse == 0 { u16::MAX } else { pulse }), last as u8)
        }
    }
}

/// Strength of the reception, 0 to 254; nothing is known without a radio.
fn rssi(vehicle: &Vehicle) -> u8 {
    const UNKNOWN: u8 = 255;
    const BEST: u8 = 254;
    match vehicle.pilot() {
        pilot if !pilot.has_radio => UNKNOWN,
        pilot if pilot.lost => 0,
        _ => BEST,
    }
}

/// RC_CHANNELS.
fn rc_channels(vehicle: &Vehicle) -> MavMessage {
    let (pulses, chancount) = pulses(vehicle);
    let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r] = pulses;
    MavMessage::RC_CHANNELS(RC_CHANNELS_DATA {
        time_boot_ms: boot_ms(vehicle.time_us()),
        chan1_raw: a,
        chan2_raw: b,
        chan3_raw: c,
        chan4_raw: d,
        chan5_raw: e,
        chan6_raw: f,
        chan7_raw: g,
        chan8_raw: h,
        chan9_raw: i,
        chan10_raw: j,
        chan11_raw: k,
        chan12_raw: l,
        chan13_raw: m,
        chan14_raw: n,
        chan15_raw: o,
        chan16_raw: p,
        chan17_raw: q,
        chan18_raw: r,
        chancount,
        rssi: rssi(vehicle),
    })
}

/// RC_CHANNELS_RAW: the first eight channels.
fn rc_channels_raw(vehicle: &Vehicle) -> MavMessage {
    let ([a, b, c, d, e, f, g, h, ..], _) = pulses(vehicle);
    MavMessage::RC_CHANNELS_RAW(RC_CHANNELS_RAW_DATA {
        time_boot_ms: boot_ms(vehicle.time_us()),
        chan1_raw: a,
        chan2_raw: b,
        chan3_raw: c,
        chan4_raw: d,
        chan5_raw: e,
        chan6_raw: f,
        chan7_raw: g,
        chan8_raw: h,
        port: 0,
        rssi: rssi(vehicle),
    })
}
