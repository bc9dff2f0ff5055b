//! The origin of the local frame: where the flight began, until a client moves it.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{GPS_GLOBAL_ORIGIN_DATA, MavMessage, SET_GPS_GLOBAL_ORIGIN_DATA};
use vehicle::world::Geodetic;
use vehicle::{Refusal, Severity, Vehicle};

use super::command::global_frame;
use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::{Command, Frame, degrees, millimetres, scaled_degrees};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::stream::Stream;

const STREAMS: &[Stream] = &[Stream::new(GPS_GLOBAL_ORIGIN_DATA::ID, [0.1, 1.0], message)];
/// MAV_CMD_DO_SET_GLOBAL_ORIGIN, which replaces SET_GPS_GLOBAL_ORIGIN.
const DO_SET_GLOBAL_ORIGIN: u16 = 611;
const COMMANDS: &[CommandEntry] = &[CommandEntry::action(DO_SET_GLOBAL_ORIGIN)];

/// Tells the origin, and moves it.
#[derive(Clone, Copy, Debug)]
pub struct GlobalOrigin;

impl Service for GlobalOrigin {
    fn summary(&self) -> &'static str {
        "The origin of the local frame"
    }

    fn messages(&self) -> &'static [u32] {
        &[SET_GPS_GLOBAL_ORIGIN_DATA::ID]
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let payload = frame.payload();
        let [latitude_deg, longitude_deg] = [0, 4].map(|at| degrees(payload.i32(at)));
        let altitude_m = f64::from(payload.i32(8)) / 1000.0;
        let asked = Geodetic { latitude_deg, longitude_deg, altitude_m };
        if let Err(refusal) = move_origin(context, asked) {
            context.say(Severity::Warning, &refusal.to_string());
            context.outbox.send(Destination::Peer(origin.peer), message(&context.vehicle));
        }
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        let frame = global_frame(command)?;
        let altitude_m = context.vehicle.frame().origin().altitude_m
            - context.vehicle.site().down_m(frame, command.z, context.vehicle.horizontal_m());
        move_origin(context, Geodetic { latitude_deg: command.x, longitude_deg: command.y, altitude_m })?;
        Ok(Progress::Done)
    }
}

/// Moves the origin, and tells everyone. ArduPilot does so only before it knows where it is, and this vehicle always knows, unless it
/// flies by vision and has never had a fix.
fn move_origin(context: &mut Context, origin: Geodetic) -> Result<(), Refusal> {
    let is_known = context.vehicle.knows_origin() || !context.vehicle.can_be_told_origin();
    if context.identity().is_ardupilot() && is_known {
        return Err(Refusal::denied("Origin refused: ArduPilot's origin is already set; start with --home"));
    }
    context.vehicle.move_origin(origin)?;
    context.outbox.send(Destination::Everyone, message(&context.vehicle));
    Ok(())
}

fn message(vehicle: &Vehicle) -> MavMessage {
    let origin = vehicle.told_frame().origin();
    MavMessage::GPS_GLOBAL_ORIGIN(GPS_GLOBAL_ORIGIN_DATA {
        latitude: scaled_degrees(origin.latitude_deg),
        longitude: scaled_degrees(origin.longitude_deg),
        altitude: millimetres(origin.altitude_m),
        time_usec: vehicle.time_us(),
    })
}
