//! The origin of the local frame: it is where the flight began, and can be asked for but not set.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{GPS_GLOBAL_ORIGIN_DATA, MavMessage, SET_GPS_GLOBAL_ORIGIN_DATA};
use vehicle::{Severity, Vehicle};

use super::Service;
use crate::codec::{Frame, millimetres, scaled_degrees};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::stream::Stream;

const STREAMS: &[Stream] = &[Stream::new(GPS_GLOBAL_ORIGIN_DATA::ID, [0.1, 1.0], message)];

/// Tells the origin.
#[derive(Clone, Copy, Debug)]
pub struct GlobalOrigin;

impl Service for GlobalOrigin {
    fn summary(&self) -> &'static str {
        "The origin of the local frame, which is told and cannot be changed"
    }

    fn messages(&self) -> &'static [u32] {
        &[SET_GPS_GLOBAL_ORIGIN_DATA::ID]
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, _frame: &Frame) {
        context.say(Severity::Warning, "The origin cannot be changed; start with --home");
        context.outbox.send(Destination::Peer(origin.peer), message(&context.vehicle));
    }
}

fn message(vehicle: &Vehicle) -> MavMessage {
    let origin = vehicle.frame().origin();
    MavMessage::GPS_GLOBAL_ORIGIN(GPS_GLOBAL_ORIGIN_DATA {
        latitude: scaled_degrees(origin.latitude_deg),
        longitude: scaled_degrees(origin.longitude_deg),
        altitude: millimetres(origin.altitude_m),
        time_usec: vehicle.time_us(),
    })
}
