//! Open Drone ID: what a transmitter would broadcast of this vehicle, and what ground stations tell it for that.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::*;
use nalgebra::Vector3;
use num_traits::FromPrimitive;
use vehicle::world::{Geodetic, heading_deg};
use vehicle::{BasicId, LandedState, OperatorId, OperatorPlace, SelfId, Vehicle};

use super::Service;
use crate::codec::{Frame, Payload, degrees, scaled_degrees};
use crate::context::Context;
use crate::envelope::Origin;
use crate::stream::{Build, Component, Stream};

/// Start of the clock of OPEN_DRONE_ID_SYSTEM: 1 January 2019, s since 1970.
const CLOCK_START_S: u64 = 1_546_300_800;
/// A serial number, and a multicopter.
const SERIAL_NUMBER: u8 = 1;
const MULTICOPTER: u8 = 2;
/// An altitude that is not known.
const UNKNOWN_ALTITUDE_M: f32 = -1000.0;

const STREAMS: &[Stream] = &[
    Stream::when(OPEN_DRONE_ID_BASIC_ID_DATA::ID, [1.0, 1.0], Build::Several(basic_id)),
    Stream::when(OPEN_DRONE_ID_LOCATION_DATA::ID, [1.0, 1.0], Build::Several(location)),
    Stream::when(OPEN_DRONE_ID_SYSTEM_DATA::ID, [1.0, 1.0], Build::Several(system)),
    Stream::when(OPEN_DRONE_ID_SELF_ID_DATA::ID, [1.0, 1.0], Build::Several(self_id)),
    Stream::when(OPEN_DRONE_ID_OPERATOR_ID_DATA::ID, [1.0, 1.0], Build::Several(operator_id)),
    Stream::when(OPEN_DRONE_ID_ARM_STATUS_DATA::ID, [1.0, 1.0], Build::Several(arm_status)),
];

/// The transmitter, as far as clients see one.
#[derive(Clone, Copy, Debug)]
pub struct RemoteIdentification;

impl Service for RemoteIdentification {
    fn summary(&self) -> &'static str {
        "Remote identification (Open Drone ID)"
    }

    fn messages(&self) -> &'static [u32] {
        &[
            OPEN_DRONE_ID_BASIC_ID_DATA::ID,
            OPEN_DRONE_ID_SELF_ID_DATA::ID,
            OPEN_DRONE_ID_OPERATOR_ID_DATA::ID,
            OPEN_DRONE_ID_SYSTEM_DATA::ID,
            OPEN_DRONE_ID_SYSTEM_UPDATE_DATA::ID,
        ]
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn receive(&mut self, context: &mut Context, _origin: &Origin, frame: &Frame) {
        let (vehicle, payload) = (&mut context.vehicle, frame.payload());
        match frame.message_id() {
            OPEN_DRONE_ID_BASIC_ID_DATA::ID => {
                let (id_kind, aircraft_kind) = (payload.u8(22), payload.u8(23));
                vehicle.remote_id_mut().basic =
                    Some(BasicId { id_kind, aircraft_kind, id: payload.bytes(24) });
            }
            OPEN_DRONE_ID_SELF_ID_DATA::ID => {
                vehicle.remote_id_mut().own = Some(SelfId { kind: payload.u8(22), text: payload.bytes(23) });
            }
            OPEN_DRONE_ID_OPERATOR_ID_DATA::ID => {
                vehicle.remote_id_mut().operator =
                    Some(OperatorId { kind: payload.u8(22), id: payload.bytes(23) });
            }
            OPEN_DRONE_ID_SYSTEM_DATA::ID => take_system(vehicle, &payload),
            _ => update_system(vehicle, &payload),
        }
    }
}

/// A place in units of 1e-7 degrees with an altitude, m, in the local frame; zero and zero stand for none.
fn place(vehicle: &Vehicle, latitude: i32, longitude: i32, altitude_m: f32) -> Option<Vector3<f64>> {
    let altitude_m = if altitude_m > UNKNOWN_ALTITUDE_M { f64::from(altitude_m) } else { 0.0 };
    let place = Geodetic { latitude_deg: degrees(latitude), longitude_deg: degrees(longitude), altitude_m };
    (place.is_valid() && (latitude, longitude) != (0, 0)).then(|| vehicle.frame().to_local_m(&place))
}

fn take_system(vehicle: &mut Vehicle, payload: &Payload) {
    let position_m = place(vehicle, payload.i32(0), payload.i32(4), payload.f32(16));
    vehicle.remote_id_mut().place = Some(OperatorPlace {
        position_m,
        kind: payload.u8(50),
        area: (payload.u16(24), payload.u16(26)),
        altitudes_m: (f64::from(payload.f32(8)), f64::from(payload.f32(12))),
        classification: payload.bytes(51),
        time_s: payload.u32(20),
    });
}

/// OPEN_DRONE_ID_SYSTEM_UPDATE: the operator has moved.
fn update_system(vehicle: &mut Vehicle, payload: &Payload) {
    let moved_m = place(vehicle, payload.i32(0), payload.i32(4), payload.f32(8));
    if let Some(known) = &mut vehicle.remote_id_mut().place {
        (known.position_m, known.time_s) = (moved_m, payload.u32(12));
    }
}

fn enabled<'a>(component: &Component<'a>) -> Option<&'a Vehicle> {
    Some(component.vehicle).filter(|vehicle| vehicle.conduct().surroundings.remote_id)
}

/// What was told; PX4 makes one of its own number if nothing was.
fn basic_id(component: &Component<'_>) -> Vec<MavMessage> {
    let Some(vehicle) = enabled(component) else { return Vec::new() };
    let own = || {
        let mut id = [0; 20];
        for (place, letter) in
            id.iter_mut().zip(format!("LMPC{:03}", component.parameters.system_id()).bytes())
        {
            *place = letter;
        }
        BasicId { id_kind: SERIAL_NUMBER, aircraft_kind: MULTICOPTER, id }
    };
    let told = vehicle.remote_id().basic;
    let basic = told.or_else(|| (!vehicle.identity().is_ardupilot()).then(own));
    let message = |basic: BasicId| {
        MavMessage::OPEN_DRONE_ID_BASIC_ID(OPEN_DRONE_ID_BASIC_ID_DATA {
            id_type: MavOdidIdType::from_u8(basic.id_kind).unwrap_or_default(),
            ua_type: MavOdidUaType::from_u8(basic.aircraft_kind).unwrap_or_default(),
            uas_id: basic.id,
            ..OPEN_DRONE_ID_BASIC_ID_DATA::default()
        })
    };
    basic.map(message).into_iter().collect()
}

/// The motion as the vehicle knows it.
fn location(component: &Component<'_>) -> Vec<MavMessage> {
    let Some(vehicle) = enabled(component) else { return Vec::new() };
    let outputs = vehicle.outputs();
    let place = vehicle.place_of(&outputs.position_m);
    let velocity_m_s = outputs.velocity_m_s;
    let course_rad = libm::atan2(velocity_m_s.y, velocity_m_s.x);
    let now_us = vehicle.unix_start_us() + vehicle.time_us();
    let since_hour_s = (now_us % 3_600_000_000) as f64 / 1e6;
    let status = match vehicle.landed_state() {
        _ if vehicle.is_terminated() => MavOdidStatus::MAV_ODID_STATUS_EMERGENCY,
        LandedState::OnGround => MavOdidStatus::MAV_ODID_STATUS_GROUND,
        _ => MavOdidStatus::MAV_ODID_STATUS_AIRBORNE,
    };
    vec![MavMessage::OPEN_DRONE_ID_LOCATION(OPEN_DRONE_ID_LOCATION_DATA {
        latitude: scaled_degrees(place.latitude_deg),
        longitude: scaled_degrees(place.longitude_deg),
        altitude_barometric: place.altitude_m as f32,
        altitude_geodetic: place.altitude_m as f32,
        height: (vehicle.home().position_m.z - outputs.position_m.z) as f32,
        timestamp: since_hour_s as f32,
        direction: (heading_deg(course_rad) * 100.0).round() as u16 % 36_000,
        speed_horizontal: (velocity_m_s.xy().norm() * 100.0).round().min(25_425.0) as u16,
        speed_vertical: (-velocity_m_s.z * 100.0).round().clamp(-6200.0, 6200.0) as i16,
        status,
        height_reference: MavOdidHeightRef::MAV_ODID_HEIGHT_REF_OVER_TAKEOFF,
        horizontal_accuracy: MavOdidHorAcc::MAV_ODID_HOR_ACC_3_METER,
        vertical_accuracy: MavOdidVerAcc::MAV_ODID_VER_ACC_3_METER,
        barometer_accuracy: MavOdidVerAcc::MAV_ODID_VER_ACC_3_METER,
        speed_accuracy: MavOdidSpeedAcc::MAV_ODID_SPEED_ACC_1_METERS_PER_SECOND,
        timestamp_accuracy: MavOdidTimeAcc::MAV_ODID_TIME_ACC_0_1_SECOND,
        ..OPEN_DRONE_ID_LOCATION_DATA::default()
    })]
}

/// Where the operator is; PX4 takes the place of the takeoff if nobody said so.
fn system(component: &Component<'_>) -> Vec<MavMessage> {
    let Some(vehicle) = enabled(component) else { return Vec::new() };
    let now_s = (vehicle.unix_start_us() + vehicle.time_us()) / 1_000_000;
    let own = || OperatorPlace {
        position_m: Some(vehicle.home().position_m),
        kind: 0,
        area: (1, 0),
        altitudes_m: (f64::from(UNKNOWN_ALTITUDE_M), f64::from(UNKNOWN_ALTITUDE_M)),
        classification: [0; 3],
        time_s: u32::try_from(now_s.saturating_sub(CLOCK_START_S)).unwrap_or(u32::MAX),
    };
    let known = vehicle.remote_id().place.or_else(|| (!vehicle.identity().is_ardupilot()).then(own));
    let message = |known: OperatorPlace| {
        let place = known.position_m.map(|position_m| vehicle.place_of(&position_m));
        let [kind, category, class] = known.classification;
        MavMessage::OPEN_DRONE_ID_SYSTEM(OPEN_DRONE_ID_SYSTEM_DATA {
            operator_latitude: place.map_or(0, |place| scaled_degrees(place.latitude_deg)),
            operator_longitude: place.map_or(0, |place| scaled_degrees(place.longitude_deg)),
            operator_altitude_geo: place.map_or(UNKNOWN_ALTITUDE_M, |place| place.altitude_m as f32),
            area_ceiling: known.altitudes_m.0 as f32,
            area_floor: known.altitudes_m.1 as f32,
            timestamp: known.time_s,
            area_count: known.area.0,
            area_radius: known.area.1,
            operator_location_type: MavOdidOperatorLocationType::from_u8(known.kind).unwrap_or_default(),
            classification_type: MavOdidClassificationType::from_u8(kind).unwrap_or_default(),
            category_eu: MavOdidCategoryEu::from_u8(category).unwrap_or_default(),
            class_eu: MavOdidClassEu::from_u8(class).unwrap_or_default(),
            ..OPEN_DRONE_ID_SYSTEM_DATA::default()
        })
    };
    known.map(message).into_iter().collect()
}

fn self_id(component: &Component<'_>) -> Vec<MavMessage> {
    let told = enabled(component).and_then(|vehicle| vehicle.remote_id().own);
    let message = |own: SelfId| {
        MavMessage::OPEN_DRONE_ID_SELF_ID(OPEN_DRONE_ID_SELF_ID_DATA {
            description_type: MavOdidDescType::from_u8(own.kind).unwrap_or_default(),
            description: own.text.into(),
            ..OPEN_DRONE_ID_SELF_ID_DATA::default()
        })
    };
    told.map(message).into_iter().collect()
}

fn operator_id(component: &Component<'_>) -> Vec<MavMessage> {
    let told = enabled(component).and_then(|vehicle| vehicle.remote_id().operator);
    let message = |operator: OperatorId| {
        MavMessage::OPEN_DRONE_ID_OPERATOR_ID(OPEN_DRONE_ID_OPERATOR_ID_DATA {
            operator_id_type: MavOdidOperatorIdType::from_u8(operator.kind).unwrap_or_default(),
            operator_id: operator.id.into(),
            ..OPEN_DRONE_ID_OPERATOR_ID_DATA::default()
        })
    };
    told.map(message).into_iter().collect()
}

/// OPEN_DRONE_ID_ARM_STATUS: what a transmitter says about its readiness.
fn arm_status(component: &Component<'_>) -> Vec<MavMessage> {
    let Some(vehicle) = enabled(component) else { return Vec::new() };
    let lacks = vehicle.remote_id_lacks();
    vec![MavMessage::OPEN_DRONE_ID_ARM_STATUS(OPEN_DRONE_ID_ARM_STATUS_DATA {
        status: match lacks {
            None => MavOdidArmStatus::MAV_ODID_ARM_STATUS_GOOD_TO_ARM,
            Some(_) => MavOdidArmStatus::MAV_ODID_ARM_STATUS_PRE_ARM_FAIL_GENERIC,
        },
        error: lacks.unwrap_or_default().into(),
    })]
}
