//! TIMESYNC and PING: answers in simulation time.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{MavMessage, PING_DATA, TIMESYNC_DATA};
use vehicle::Vehicle;

use super::Service;
use crate::codec::{Frame, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::stream::Stream;

const STREAMS: &[Stream] = &[Stream::new(TIMESYNC_DATA::ID, [0.0, 10.0], request)];

/// Answers, and asks companion computers.
#[derive(Clone, Copy, Debug)]
pub struct TimeSynchronization;

impl Service for TimeSynchronization {
    fn summary(&self) -> &'static str {
        "Round trips and clocks"
    }

    fn answers(&self) -> &'static [u32] {
        &[id::PING, id::TIMESYNC]
    }

    fn messages(&self) -> &'static [u32] {
        &[id::PING, id::TIMESYNC]
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        match frame.message_id() {
            id::PING => ping(context, origin, frame),
            _ => timesync(context, origin, frame),
        }
    }
}

/// Answers a request; what answers somebody else's is not ours.
fn timesync(context: &mut Context, origin: &Origin, frame: &Frame) {
    let (tc1, ts1) = (frame.payload().i64(0), frame.payload().i64(8));
    if tc1 != 0 {
        return;
    }
    let answer = TIMESYNC_DATA {
        tc1: nanoseconds(&context.vehicle),
        ts1,
        target_system: origin.system,
        target_component: origin.component,
    };
    context.outbox.send(Destination::Peer(origin.peer), MavMessage::TIMESYNC(answer));
}

/// Our own request, which a companion computer answers.
fn request(vehicle: &Vehicle) -> MavMessage {
    MavMessage::TIMESYNC(TIMESYNC_DATA { tc1: 0, ts1: nanoseconds(vehicle), ..TIMESYNC_DATA::default() })
}

/// Zero would be a request.
fn nanoseconds(vehicle: &Vehicle) -> i64 {
    (vehicle.time_us().max(1) as i64).saturating_mul(1000)
}

/// Answers a ping; one that has a target is itself an answer.
fn ping(context: &mut Context, origin: &Origin, frame: &Frame) {
    let payload = frame.payload();
    if payload.u8(12) != 0 || payload.u8(13) != 0 {
        return;
    }
    let answer = PING_DATA {
        time_usec: payload.u64(0),
        seq: payload.u32(8),
        target_system: origin.system,
        target_component: origin.component,
    };
    context.outbox.send(Destination::Peer(origin.peer), MavMessage::PING(answer));
}
