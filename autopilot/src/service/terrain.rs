//! Terrain, as ArduPilot tells it: the ground of the simulation is known everywhere, so that no data has to be asked for.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    MavMessage, TERRAIN_CHECK_DATA, TERRAIN_DATA_DATA, TERRAIN_REPORT_DATA,
};
use vehicle::Vehicle;
use vehicle::identity::Identity;
use vehicle::world::Geodetic;

use super::Service;
use crate::codec::{Frame, degrees, scaled_degrees};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::stream::{Group, Stream};

const STREAMS: &[Stream] =
    &[Stream::new(TERRAIN_REPORT_DATA::ID, [0.0, 0.0], report).of(Group::Extra3).of_ardupilot()];

/// Distance of the places of ArduPilot's grid, m; zero would say that the terrain is unknown.
const SPACING_M: u16 = 100;

/// Tells how high the ground is.
#[derive(Clone, Copy, Debug)]
pub struct Terrain;

impl Service for Terrain {
    fn summary(&self) -> &'static str {
        "Height of the ground of the world; received terrain data is ignored"
    }

    fn messages(&self) -> &'static [u32] {
        &[TERRAIN_CHECK_DATA::ID, TERRAIN_DATA_DATA::ID]
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    /// TERRAIN_CHECK: the ground at a place.
    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        if frame.message_id() != TERRAIN_CHECK_DATA::ID || context.identity() != Identity::ArduPilot {
            return;
        }
        let payload = frame.payload();
        let message = report_of(&context.vehicle, [payload.i32(0), payload.i32(4)]);
        context.outbox.send(Destination::Peer(origin.peer), message);
    }
}

/// TERRAIN_REPORT of the ground below the vehicle.
fn report(vehicle: &Vehicle) -> MavMessage {
    let place = vehicle.place_of(&vehicle.outputs().position_m);
    report_of(vehicle, [place.latitude_deg, place.longitude_deg].map(scaled_degrees))
}

/// The same of a place, degrees · 1e7.
fn report_of(vehicle: &Vehicle, [lat, lon]: [i32; 2]) -> MavMessage {
    let altitude_m = vehicle.frame().origin().altitude_m;
    let [latitude_deg, longitude_deg] = [lat, lon].map(degrees);
    let there_m = vehicle.frame().to_local_m(&Geodetic { latitude_deg, longitude_deg, altitude_m });
    let here_m = vehicle.outputs().position_m;
    MavMessage::TERRAIN_REPORT(TERRAIN_REPORT_DATA {
        lat,
        lon,
        terrain_height: (altitude_m - vehicle.terrain().z_below_m(&there_m)) as f32,
        current_height: (vehicle.terrain().z_below_m(&here_m) - here_m.z) as f32,
        spacing: SPACING_M,
        pending: 0,
        loaded: 1,
    })
}
