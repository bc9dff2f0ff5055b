//! Other aircraft: who is heard by transponder, who is told to clients, and who comes too near.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    ADSB_VEHICLE_DATA, AdsbAltitudeType, AdsbEmitterType, AdsbFlags, COLLISION_DATA, MavCollisionAction,
    MavCollisionSrc, MavCollisionThreatLevel, MavMessage, UTM_GLOBAL_POSITION_DATA,
};
use nalgebra::Vector3;
use num_traits::FromPrimitive;
use vehicle::surroundings::Aircraft;
use vehicle::world::{Geodetic, heading_deg};
use vehicle::{Action, Encounter, Threat, Vehicle};

use super::{Service, utm_position};
use crate::codec::{Frame, Payload, degrees, millimetres, scaled_degrees};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::stream::{Build, Component, Stream};

const STREAMS: &[Stream] = &[
    Stream::when(ADSB_VEHICLE_DATA::ID, [1.0, 1.0], Build::Several(heard)),
    Stream::on_request(UTM_GLOBAL_POSITION_DATA::ID, Build::Several(utm_position::own)),
];

/// Hears and tells traffic.
#[derive(Clone, Copy, Debug)]
pub struct Traffic;

impl Service for Traffic {
    fn summary(&self) -> &'static str {
        "Other aircraft, and who comes too near"
    }

    fn messages(&self) -> &'static [u32] {
        &[ADSB_VEHICLE_DATA::ID, UTM_GLOBAL_POSITION_DATA::ID]
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn answers(&self) -> &'static [u32] {
        &[COLLISION_DATA::ID]
    }

    fn receive(&mut self, context: &mut Context, _origin: &Origin, frame: &Frame) {
        let payload = frame.payload();
        let aircraft = match frame.message_id() {
            ADSB_VEHICLE_DATA::ID => transponder(&context.vehicle, &payload),
            _ => unmanned(&context.vehicle, &payload),
        };
        if let Some(aircraft) = aircraft {
            context.vehicle.hear_aircraft(aircraft);
        }
    }

    fn announce(&mut self, context: &mut Context) {
        if let Some(encounter) = context.vehicle.take_encounter() {
            context.outbox.send(Destination::Everyone, collision(&encounter));
        }
    }
}

/// A place in units of 1e-7 degrees and mm, in the local frame; `None` if it is none.
fn place(vehicle: &Vehicle, [latitude, longitude, altitude]: [i32; 3]) -> Option<Vector3<f64>> {
    let place = Geodetic {
        latitude_deg: degrees(latitude),
        longitude_deg: degrees(longitude),
        altitude_m: f64::from(altitude) / 1e3,
    };
    (place.is_valid() && (latitude, longitude) != (0, 0)).then(|| vehicle.frame().to_local_m(&place))
}

/// ADSB_VEHICLE with a place and an altitude.
fn transponder(vehicle: &Vehicle, payload: &Payload) -> Option<Aircraft> {
    let flags = AdsbFlags::from_bits_truncate(payload.u16(22));
    if !flags.contains(AdsbFlags::ADSB_FLAGS_VALID_COORDS | AdsbFlags::ADSB_FLAGS_VALID_ALTITUDE) {
        return None;
    }
    let position_m = place(vehicle, [payload.i32(4), payload.i32(8), payload.i32(12)])?;
    let speed_m_s = f64::from(payload.u16(18)) / 100.0;
    let heading_rad = (f64::from(payload.u16(16)) / 100.0).to_radians();
    let moves = flags.contains(AdsbFlags::ADSB_FLAGS_VALID_HEADING | AdsbFlags::ADSB_FLAGS_VALID_VELOCITY);
    let speed_m_s = if moves { speed_m_s } else { 0.0 };
    // ArduPilot's clients know no flag for it, and send zero where there is none.
    let climb_m_s = f64::from(payload.i16(20)) / 100.0;
    Some(Aircraft {
        id: payload.u32(0),
        callsign: payload.bytes(27),
        category: payload.u8(36),
        position_m,
        velocity_m_s: Vector3::new(
            libm::cos(heading_rad) * speed_m_s,
            libm::sin(heading_rad) * speed_m_s,
            -climb_m_s,
        ),
        heard_us: vehicle.time_us().saturating_sub(u64::from(payload.u8(37)) * 1_000_000),
        simulated: flags.contains(AdsbFlags::ADSB_FLAGS_SIMULATED),
    })
}

/// UTM_GLOBAL_POSITION, which PX4 takes. Its long identifier becomes an address of 24 bits.
fn unmanned(vehicle: &Vehicle, payload: &Payload) -> Option<Aircraft> {
    const UNMANNED: u8 = 14;
    if vehicle.identity().is_ardupilot() {
        return None;
    }
    let position_m = place(vehicle, [payload.i32(8), payload.i32(12), payload.i32(16)])?;
    let id = crc32fast::hash(&payload.bytes::<18>(50)) & 0xff_ffff;
    let speed = |offset| f64::from(payload.i16(offset)) / 100.0;
    Some(Aircraft {
        id,
        callsign: [0; 9],
        category: UNMANNED,
        position_m,
        velocity_m_s: Vector3::new(speed(36), speed(38), speed(40)),
        heard_us: vehicle.time_us(),
        simulated: false,
    })
}

/// ADSB_VEHICLE of everyone who is heard.
fn heard(component: &Component<'_>) -> Vec<MavMessage> {
    let vehicle = component.vehicle;
    vehicle.traffic().aircraft().iter().map(|aircraft| adsb_vehicle(vehicle, aircraft)).collect()
}

fn adsb_vehicle(vehicle: &Vehicle, aircraft: &Aircraft) -> MavMessage {
    let place = vehicle.place_of(&aircraft.position_m);
    let velocity_m_s = &aircraft.velocity_m_s;
    let heading_rad = libm::atan2(velocity_m_s.y, velocity_m_s.x);
    let mut flags = AdsbFlags::ADSB_FLAGS_VALID_COORDS
        | AdsbFlags::ADSB_FLAGS_VALID_ALTITUDE
        | AdsbFlags::ADSB_FLAGS_VALID_HEADING
        | AdsbFlags::ADSB_FLAGS_VALID_VELOCITY
        | AdsbFlags::ADSB_FLAGS_VERTICAL_VELOCITY_VALID;
    if aircraft.callsign.iter().any(|letter| *letter != 0) {
        flags |= AdsbFlags::ADSB_FLAGS_VALID_CALLSIGN;
    }
    if aircraft.simulated {
        flags |= AdsbFlags::ADSB_FLAGS_SIMULATED;
    }
    MavMessage::ADSB_VEHICLE(ADSB_VEHICLE_DATA {
        ICAO_address: aircraft.id,
        lat: scaled_degrees(place.latitude_deg),
        lon: scaled_degrees(place.longitude_deg),
        altitude: millimetres(place.altitude_m),
        heading: (heading_deg(heading_rad) * 100.0).round() as u16,
        hor_velocity: (velocity_m_s.xy().norm() * 100.0).round() as u16,
        ver_velocity: (-velocity_m_s.z * 100.0).round() as i16,
        flags,
        squawk: 0,
        altitude_type: AdsbAltitudeType::ADSB_ALTITUDE_TYPE_GEOMETRIC,
        callsign: aircraft.callsign.into(),
        emitter_type: AdsbEmitterType::from_u8(aircraft.category)
            .unwrap_or(AdsbEmitterType::ADSB_EMITTER_TYPE_NO_INFO),
        tslc: aircraft.age_s(vehicle.time_us()).round().clamp(0.0, f64::from(u8::MAX)) as u8,
    })
}

/// What the transponder of this vehicle tells to others.
pub fn own_report(vehicle: &Vehicle, system_id: u8) -> MavMessage {
    /// Addresses of simulated vehicles, which no state has given away.
    const ADDRESS: u32 = 0x4c_4d00;
    const UNMANNED: u8 = 14;
    let mut callsign = [0; 9];
    for (place, letter) in callsign.iter_mut().zip(format!("LMPC{system_id}").bytes()) {
        *place = letter;
    }
    let outputs = vehicle.outputs();
    adsb_vehicle(
        vehicle,
        &Aircraft {
            id: ADDRESS | u32::from(system_id),
            callsign,
            category: UNMANNED,
            position_m: outputs.position_m,
            velocity_m_s: outputs.velocity_m_s,
            heard_us: vehicle.time_us(),
            simulated: true,
        },
    )
}

/// COLLISION: who comes how near, and what is done about it.
fn collision(encounter: &Encounter) -> MavMessage {
    MavMessage::COLLISION(COLLISION_DATA {
        id: encounter.aircraft.id,
        time_to_minimum_delta: encounter.nearest_s as f32,
        altitude_minimum_delta: encounter.vertical_m as f32,
        horizontal_minimum_delta: encounter.horizontal_m as f32,
        src: MavCollisionSrc::MAV_COLLISION_SRC_ADSB,
        action: match encounter.action {
            Action::None => MavCollisionAction::MAV_COLLISION_ACTION_NONE,
            Action::Hold | Action::BrakeOrLand | Action::Position | Action::Altitude | Action::Stabilize => {
                MavCollisionAction::MAV_COLLISION_ACTION_HOVER
            }
            Action::Return
            | Action::TraceOrReturn
            | Action::MissionLandingOrReturn
            | Action::TraceOrLand
            | Action::Land => MavCollisionAction::MAV_COLLISION_ACTION_RTL,
            Action::Warn | Action::Disarm | Action::Terminate => {
                MavCollisionAction::MAV_COLLISION_ACTION_REPORT
            }
        },
        threat_level: match encounter.threat {
            Threat::None => MavCollisionThreatLevel::MAV_COLLISION_THREAT_LEVEL_NONE,
            Threat::Low => MavCollisionThreatLevel::MAV_COLLISION_THREAT_LEVEL_LOW,
            Threat::High => MavCollisionThreatLevel::MAV_COLLISION_THREAT_LEVEL_HIGH,
        },
    })
}
