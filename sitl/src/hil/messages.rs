//! Messages to the autopilot.

use autopilot::codec::{centimetres_per_second, floats, millimetres, scaled_degrees};
use mavlink::dialects::ardupilotmega::{
    HEARTBEAT_DATA, HIL_GPS_DATA, HIL_SENSOR_DATA, HilSensorUpdatedFlags, MavAutopilot, MavMessage,
    MavModeFlag, MavState, MavType,
};
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
    let [vn, ve, vd] = velocity.data.0[0].map(centimetres_per_second);
    MavMessage::HIL_GPS(HIL_GPS_DATA {
        time_usec: fix.time_us,
        lat: scaled_degrees(place.latitude_deg),
        lon: scaled_degrees(place.longitude_deg),
        alt: millimetres(place.altitude_m),
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
