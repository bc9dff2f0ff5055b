//! UTM_GLOBAL_POSITION: where this vehicle is and flies to, for a traffic management of unmanned aircraft.

use mavlink::dialects::ardupilotmega::{
    MavMessage, UTM_GLOBAL_POSITION_DATA, UtmDataAvailFlags, UtmFlightState,
};
use nalgebra::Vector3;
use vehicle::estimation::gps::{HORIZONTAL_M, VELOCITY_M_S, VERTICAL_M};
use vehicle::{LandedState, Vehicle};

use crate::codec::{millimetres, scaled_degrees};
use crate::stream::Component;

/// The identification of a vehicle: letters, and the number of its system.
const LETTERS: &[u8; 4] = b"LMPC";

/// The message of now.
pub fn own(component: &Component<'_>) -> Vec<MavMessage> {
    type Flags = UtmDataAvailFlags;
    let vehicle = component.vehicle;
    let outputs = vehicle.outputs();
    let place = vehicle.place_of(&outputs.position_m);
    let next = next_m(vehicle).map(|next_m| vehicle.place_of(&next_m));
    let mut flags = Flags::UTM_DATA_AVAIL_FLAGS_TIME_VALID
        | Flags::UTM_DATA_AVAIL_FLAGS_UAS_ID_AVAILABLE
        | Flags::UTM_DATA_AVAIL_FLAGS_POSITION_AVAILABLE
        | Flags::UTM_DATA_AVAIL_FLAGS_ALTITUDE_AVAILABLE
        | Flags::UTM_DATA_AVAIL_FLAGS_RELATIVE_ALTITUDE_AVAILABLE
        | Flags::UTM_DATA_AVAIL_FLAGS_HORIZONTAL_VELO_AVAILABLE
        | Flags::UTM_DATA_AVAIL_FLAGS_VERTICAL_VELO_AVAILABLE;
    flags.set(Flags::UTM_DATA_AVAIL_FLAGS_NEXT_WAYPOINT_AVAILABLE, next.is_some());
    let flight_state = match vehicle.landed_state() {
        _ if vehicle.is_terminated() => UtmFlightState::UTM_FLIGHT_STATE_EMERGENCY,
        LandedState::OnGround => UtmFlightState::UTM_FLIGHT_STATE_GROUND,
        _ => UtmFlightState::UTM_FLIGHT_STATE_AIRBORNE,
    };
    let mut uas_id = [0; 18];
    for (place, letter) in uas_id.iter_mut().zip(LETTERS.iter().chain([&component.parameters.system_id()])) {
        *place = *letter;
    }
    let [vx, vy, vz] = outputs.velocity_m_s.data.0[0].map(|m_s| (m_s * 100.0).round() as i16);
    vec![MavMessage::UTM_GLOBAL_POSITION(UTM_GLOBAL_POSITION_DATA {
        time: vehicle.unix_start_us() + vehicle.time_us(),
        lat: scaled_degrees(place.latitude_deg),
        lon: scaled_degrees(place.longitude_deg),
        alt: millimetres(place.altitude_m),
        relative_alt: millimetres(vehicle.home().position_m.z - outputs.position_m.z),
        next_lat: next.map_or(0, |next| scaled_degrees(next.latitude_deg)),
        next_lon: next.map_or(0, |next| scaled_degrees(next.longitude_deg)),
        next_alt: next.map_or(0, |next| millimetres(next.altitude_m)),
        vx,
        vy,
        vz,
        h_acc: (HORIZONTAL_M * 1e3) as u16,
        v_acc: (VERTICAL_M * 1e3) as u16,
        vel_acc: (VELOCITY_M_S * 1e3) as u16,
        update_rate: 0,
        uas_id,
        flight_state,
        flags,
    })]
}

/// Where it flies to, NED, m.
fn next_m(vehicle: &Vehicle) -> Option<Vector3<f64>> {
    if vehicle.landed_state() == LandedState::OnGround {
        return None;
    }
    vehicle.destination_m()
}
