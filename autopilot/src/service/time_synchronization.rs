//! TIMESYNC and PING: answers in simulation time.

use mavlink::dialects::common::{MavMessage, PING_DATA, TIMESYNC_DATA};

use super::{Destination, Origin};
use crate::autopilot::Autopilot;
use crate::codec::Frame;

/// Answers a request; what answers somebody else's is not ours.
pub fn timesync(autopilot: &mut Autopilot, origin: &Origin, frame: &Frame) {
    let (tc1, ts1) = (frame.payload().i64(0), frame.payload().i64(8));
    if tc1 != 0 {
        return;
    }
    let answer = TIMESYNC_DATA {
        tc1: nanoseconds(autopilot),
        ts1,
        target_system: origin.system,
        target_component: origin.component,
    };
    autopilot.send(Destination::Peer(origin.peer), MavMessage::TIMESYNC(answer));
}

/// Our own request, which a companion computer answers.
pub fn request(autopilot: &Autopilot) -> MavMessage {
    MavMessage::TIMESYNC(TIMESYNC_DATA { tc1: 0, ts1: nanoseconds(autopilot), ..TIMESYNC_DATA::default() })
}

/// Zero would be a request.
fn nanoseconds(autopilot: &Autopilot) -> i64 {
    (autopilot.vehicle.time_us().max(1) as i64).saturating_mul(1000)
}

/// Answers a ping; one that has a target is itself an answer.
pub fn ping(autopilot: &mut Autopilot, origin: &Origin, frame: &Frame) {
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
    autopilot.send(Destination::Peer(origin.peer), MavMessage::PING(answer));
}
