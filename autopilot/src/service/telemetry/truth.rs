//! What a real autopilot could not tell.

use mavlink::dialects::ardupilotmega::{MavMessage, SIM_STATE_DATA, SIMSTATE_DATA};
use vehicle::Vehicle;
use vehicle::estimation::TrueMotion;

use crate::codec::{floats, hil_state_quaternion, scaled_degrees};

/// SIM_STATE: the true motion, whatever the vehicle flies by.
pub fn sim_state(vehicle: &Vehicle) -> MavMessage {
    let truth = vehicle.truth();
    let force = TrueMotion::of(truth).specific_force_m_s2;
    let place = vehicle.place_of(&truth.position_m);
    let [q1, q2, q3, q4] = truth.quaternion.map(|part| part as f32);
    MavMessage::SIM_STATE(SIM_STATE_DATA {
        q1,
        q2,
        q3,
        q4,
        roll: truth.attitude_rad.x as f32,
        pitch: truth.attitude_rad.y as f32,
        yaw: truth.attitude_rad.z as f32,
        xacc: force.x as f32,
        yacc: force.y as f32,
        zacc: force.z as f32,
        xgyro: truth.body_rate_rad_s.x as f32,
        ygyro: truth.body_rate_rad_s.y as f32,
        zgyro: truth.body_rate_rad_s.z as f32,
        lat: place.latitude_deg as f32,
        lon: place.longitude_deg as f32,
        alt: place.altitude_m as f32,
        std_dev_horz: 0.0,
        std_dev_vert: 0.0,
        vn: truth.velocity_m_s.x as f32,
        ve: truth.velocity_m_s.y as f32,
        vd: truth.velocity_m_s.z as f32,
        lat_int: scaled_degrees(place.latitude_deg),
        lon_int: scaled_degrees(place.longitude_deg),
    })
}

/// HIL_STATE_QUATERNION: the same, as PX4's simulation tells it, and MAVSDK takes it for the ground truth.
pub fn true_state(vehicle: &Vehicle) -> MavMessage {
    let truth = vehicle.truth();
    let place = vehicle.place_of(&truth.position_m);
    hil_state_quaternion(&TrueMotion::of(truth), &place, &vehicle.wind_m_s())
}

/// SIMSTATE: the same, as ArduPilot's simulation tells it.
pub fn simstate(vehicle: &Vehicle) -> MavMessage {
    let truth = vehicle.truth();
    let place = vehicle.place_of(&truth.position_m);
    let [roll, pitch, yaw] = floats(&truth.attitude_rad);
    let [xacc, yacc, zacc] = floats(&TrueMotion::of(truth).specific_force_m_s2);
    let [xgyro, ygyro, zgyro] = floats(&truth.body_rate_rad_s);
    MavMessage::SIMSTATE(SIMSTATE_DATA {
        roll,
        pitch,
        yaw,
        xacc,
        yacc,
        zacc,
        xgyro,
        ygyro,
        zgyro,
        lat: scaled_degrees(place.latitude_deg),
        lng: scaled_degrees(place.longitude_deg),
    })
}
