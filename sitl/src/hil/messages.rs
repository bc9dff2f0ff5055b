//! Messages to the autopilot.

use autopilot::codec::floats;
use mavlink::dialects::ardupilotmega::{
    HEARTBEAT_DATA, HIL_GPS_DATA, HIL_SENSOR_DATA, HIL_STATE_QUATERNION_DATA, HilSensorUpdatedFlags,
    MavAutopilot, MavMessage, MavModeFlag, MavState, MavType,
};
use nalgebra::Vector3;
use quadrotor::GRAVITY_M_S2;
use vehicle::estimation::TrueMotion;
use vehicle::estimation::gps::GpsFix;
use vehicle::world::{LocalFrame, atmospheric_temperature_degc};

use super::instruments::Readings;

/// HEARTBEAT of a simulator.
pub fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        custom_mode: 0,
        mavtype: MavType::MAV_TYPE_GENERIC,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: MavModeFlag::MAV_MODE_FLAG_HIL_ENABLED,
        system_status: MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
    })
}

/// HIL_SENSOR: the inertial unit always, the others when they have something new.
pub fn sensor(time_us: u64, readings: &Readings) -> MavMessage {
    let [xacc, yacc, zacc] = floats(&readings.specific_force_m_s2());
    let [xgyro, ygyro, zgyro] = floats(&readings.body_rate_rad_s());
    let mut data = HIL_SENSOR_DATA {
        time_usec: time_us,
        xacc,
        yacc,
        zacc,
        xgyro,
        ygyro,
        zgyro,
        fields_updated: HilSensorUpdatedFlags::from_bits_retain(0b11_1111),
        ..HIL_SENSOR_DATA::default()
    };
    if let Some(reading) = readings.magnetometer {
        [data.xmag, data.ymag, data.zmag] = floats(&reading.field_gauss);
        data.fields_updated |= HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_XMAG
            | HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_YMAG
            | HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_ZMAG;
    }
    if let Some(reading) = readings.barometer {
        let altitude_m = reading.altitude_m();
        data.abs_pressure = (reading.pressure_pa / 100.0) as f32;
        data.pressure_alt = altitude_m as f32;
        data.temperature = atmospheric_temperature_degc(altitude_m) as f32;
        // Autopilots look for all three at once.
        data.fields_updated |= HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_ABS_PRESSURE
            | HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_PRESSURE_ALT
            | HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_TEMPERATURE;
    }
    MavMessage::HIL_SENSOR(data)
}

/// HIL_GPS.
pub fn gps(fix: &GpsFix, frame: &LocalFrame) -> MavMessage {
    let place = frame.to_geodetic(&fix.position_m);
    let velocity = fix.velocity_m_s;
    let course_deg = libm::atan2(velocity.y, velocity.x).to_degrees().rem_euclid(360.0);
    let [vn, ve, vd] = centi(&velocity);
    MavMessage::HIL_GPS(HIL_GPS_DATA {
        time_usec: fix.time_us,
        lat: (place.latitude_deg * 1e7).round() as i32,
        lon: (place.longitude_deg * 1e7).round() as i32,
        alt: (place.altitude_m * 1e3).round() as i32,
        // The field is a dilution of precision; PX4 reads centimetres.
        eph: (fix.horizontal_accuracy_m * 1e2).round() as u16,
        epv: (fix.vertical_accuracy_m * 1e2).round() as u16,
        vel: (velocity.xy().norm() * 1e2).round() as u16,
        vn,
        ve,
        vd,
        cog: (course_deg * 1e2) as u16,
        fix_type: 3,
        satellites_visible: fix.satellites,
        id: 0,
        yaw: 0,
    })
}

/// HIL_STATE_QUATERNION: the truth, with the acceleration along the body's axes.
pub fn state_quaternion(motion: &TrueMotion, frame: &LocalFrame, wind_m_s: &Vector3<f64>) -> MavMessage {
    let place = frame.to_geodetic(&motion.position_m);
    let q = motion.attitude;
    let gravity = q.inverse_transform_vector(&Vector3::new(0.0, 0.0, GRAVITY_M_S2));
    let acceleration_mg = (motion.specific_force_m_s2 + gravity) * (1e3 / GRAVITY_M_S2);
    let [rollspeed, pitchspeed, yawspeed] = floats(&motion.body_rate_rad_s);
    let [vx, vy, vz] = centi(&motion.velocity_m_s);
    let [xacc, yacc, zacc] = acceleration_mg.data.0[0].map(|value| value.round() as i16);
    let airspeed = ((motion.velocity_m_s - wind_m_s).norm() * 1e2).round() as u16;
    MavMessage::HIL_STATE_QUATERNION(HIL_STATE_QUATERNION_DATA {
        time_usec: motion.time_us,
        attitude_quaternion: [q.w as f32, q.i as f32, q.j as f32, q.k as f32],
        rollspeed,
        pitchspeed,
        yawspeed,
        lat: (place.latitude_deg * 1e7).round() as i32,
        lon: (place.longitude_deg * 1e7).round() as i32,
        alt: (place.altitude_m * 1e3).round() as i32,
        vx,
        vy,
        vz,
        ind_airspeed: airspeed,
        true_airspeed: airspeed,
        xacc,
        yacc,
        zacc,
    })
}

/// Hundredths; beyond the range of the field its end.
fn centi(vector: &Vector3<f64>) -> [i16; 3] {
    vector.data.0[0].map(|value| (value * 1e2).round() as i16)
}
