//! The wind, as a vehicle that measures it would tell it.

use mavlink::dialects::ardupilotmega::{MavMessage, WIND_COV_DATA, WIND_DATA};
use vehicle::Vehicle;
use vehicle::world::heading_deg;

/// WIND_COV: where the air moves to, north, east and down, as PX4 tells it.
pub fn wind_cov(vehicle: &Vehicle) -> MavMessage {
    let wind_m_s = vehicle.wind_m_s();
    let place = vehicle.place_of(&vehicle.outputs().position_m);
    MavMessage::WIND_COV(WIND_COV_DATA {
        time_usec: vehicle.time_us(),
        wind_x: wind_m_s.x as f32,
        wind_y: wind_m_s.y as f32,
        wind_z: wind_m_s.z as f32,
        wind_alt: place.altitude_m as f32,
        ..WIND_COV_DATA::default()
    })
}

/// WIND: where the air comes from, degrees, and how fast, as ArduPilot tells it.
pub fn wind(vehicle: &Vehicle) -> MavMessage {
    let wind_m_s = vehicle.wind_m_s();
    MavMessage::WIND(WIND_DATA {
        direction: heading_deg(libm::atan2(-wind_m_s.y, -wind_m_s.x)) as f32,
        speed: wind_m_s.norm() as f32,
        speed_z: wind_m_s.z as f32,
    })
}
