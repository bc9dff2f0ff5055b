//! ATTITUDE, ATTITUDE_QUATERNION and AHRS2.

use mavlink::dialects::ardupilotmega::{AHRS2_DATA, ATTITUDE_DATA, ATTITUDE_QUATERNION_DATA, MavMessage};
use vehicle::Vehicle;

use crate::codec::{boot_ms, floats, scaled_degrees};

/// ATTITUDE: ZYX Euler angles and body rates.
pub fn attitude(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let [roll, pitch, yaw] = floats(&outputs.attitude_rad);
    let [rollspeed, pitchspeed, yawspeed] = floats(&outputs.body_rate_rad_s);
    let time_boot_ms = boot_ms(outputs.time_us);
    MavMessage::ATTITUDE(ATTITUDE_DATA { time_boot_ms, roll, pitch, yaw, rollspeed, pitchspeed, yawspeed })
}

/// ATTITUDE_QUATERNION: FRD into NED.
pub fn attitude_quaternion(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let [q1, q2, q3, q4] = outputs.quaternion.map(|part| part as f32);
    let [rollspeed, pitchspeed, yawspeed] = floats(&outputs.body_rate_rad_s);
    MavMessage::ATTITUDE_QUATERNION(ATTITUDE_QUATERNION_DATA {
        time_boot_ms: boot_ms(outputs.time_us),
        q1,
        q2,
        q3,
        q4,
        rollspeed,
        pitchspeed,
        yawspeed,
        repr_offset_q: [0.0; 4],
    })
}

/// AHRS2: what ArduPilot's second estimator says. Here there is one, which says the same again.
pub fn second_attitude(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let [roll, pitch, yaw] = floats(&outputs.attitude_rad);
    let place = vehicle.place_of(&outputs.position_m);
    MavMessage::AHRS2(AHRS2_DATA {
        roll,
        pitch,
        yaw,
        altitude: place.altitude_m as f32,
        lat: scaled_degrees(place.latitude_deg),
        lng: scaled_degrees(place.longitude_deg),
    })
}
