//! What the instruments on board show.

use mavlink::dialects::ardupilotmega::{
    GPS_RAW_INT_DATA, GpsFixType, HIGHRES_IMU_DATA, HighresImuUpdatedFlags, MavMessage, RAW_IMU_DATA,
    SCALED_IMU_DATA, SCALED_PRESSURE_DATA, SCALED_PRESSURE2_DATA, SCALED_PRESSURE3_DATA, VIBRATION_DATA,
};
use nalgebra::Vector3;
use num_traits::FromPrimitive;
use quadrotor::GRAVITY_M_S2;
use vehicle::Vehicle;
use vehicle::estimation::gps::{HORIZONTAL_DILUTION, VERTICAL_DILUTION};
use vehicle::estimation::inertial::{ACCELEROMETER_COUNTS_PER_M_S2, GYROSCOPE_COUNTS_PER_RAD_S};
use vehicle::estimation::magnetometer::COUNTS_PER_GAUSS;
use vehicle::estimation::{FIX_3D, Readings};
use vehicle::world::{atmospheric_temperature_degc, heading_deg};

use crate::codec::{boot_ms, scaled_degrees};

/// GPS_RAW_INT: the latest fix, if it is young enough to be one.
pub fn gps_raw_int(vehicle: &Vehicle) -> MavMessage {
    let told = vehicle.conduct().simulated.errors.gps_fix_type;
    let Some(fix) = vehicle.readings().gps.filter(|fix| fix.is_fresh(vehicle.time_us())) else {
        return MavMessage::GPS_RAW_INT(GPS_RAW_INT_DATA {
            time_usec: vehicle.time_us(),
            fix_type: GpsFixType::from_u8(told)
                .filter(|_| told < FIX_3D)
                .unwrap_or(GpsFixType::GPS_FIX_TYPE_NO_FIX),
            // Unknown.
            eph: u16::MAX,
            epv: u16::MAX,
            vel: u16::MAX,
            cog: u16::MAX,
            ..GPS_RAW_INT_DATA::default()
        });
    };
    let place = vehicle.place_of(&fix.position_m);
    let altitude_mm = (place.altitude_m * 1e3).round() as i32;
    let ground_m_s = fix.velocity_m_s.xy();
    let course_rad = libm::atan2(ground_m_s.y, ground_m_s.x);
    let millimetres = |accuracy_m: f64| (accuracy_m * 1e3).round() as u32;
    let hundredths = |value: f64| (value * 1e2).round() as u16;
    let (speed, course) = if fix.tells_velocity() {
        (hundredths(ground_m_s.norm()), (heading_deg(course_rad) * 1e2).floor() as u16)
    } else {
        (u16::MAX, u16::MAX)
    };
    MavMessage::GPS_RAW_INT(GPS_RAW_INT_DATA {
        time_usec: fix.time_us,
        lat: scaled_degrees(place.latitude_deg),
        lon: scaled_degrees(place.longitude_deg),
        alt: altitude_mm,
        eph: hundredths(HORIZONTAL_DILUTION),
        epv: hundredths(VERTICAL_DILUTION),
        vel: speed,
        cog: course,
        fix_type: GpsFixType::from_u8(told).unwrap_or(GpsFixType::GPS_FIX_TYPE_3D_FIX),
        satellites_visible: fix.satellites,
        alt_ellipsoid: altitude_mm,
        h_acc: millimetres(fix.horizontal_accuracy_m),
        v_acc: millimetres(fix.vertical_accuracy_m),
        vel_acc: millimetres(fix.velocity_accuracy_m_s),
        hdg_acc: 0,
        // Zero: no heading from it.
        yaw: 0,
    })
}

/// The field that the magnetometer shows, gauss.
fn field_gauss(readings: &Readings) -> Vector3<f64> {
    readings.magnetometer.map_or_else(Vector3::zeros, |reading| reading.field_gauss)
}

/// HIGHRES_IMU: specific force, body rates, magnetic field and air pressure.
pub fn highres_imu(vehicle: &Vehicle) -> MavMessage {
    let readings = vehicle.readings();
    let (force, rate) = (readings.inertial.specific_force_m_s2, readings.inertial.body_rate_rad_s);
    let field = field_gauss(&readings);
    let mut updated = HighresImuUpdatedFlags::all()
        & !HighresImuUpdatedFlags::HIGHRES_IMU_UPDATED_DIFF_PRESSURE
        & !HighresImuUpdatedFlags::HIGHRES_IMU_UPDATED_TEMPERATURE;
    if readings.magnetometer.is_none() {
        updated &= !HighresImuUpdatedFlags::HIGHRES_IMU_UPDATED_XMAG
            & !HighresImuUpdatedFlags::HIGHRES_IMU_UPDATED_YMAG
            & !HighresImuUpdatedFlags::HIGHRES_IMU_UPDATED_ZMAG;
    }
    if readings.barometer.is_none() {
        updated &= !HighresImuUpdatedFlags::HIGHRES_IMU_UPDATED_ABS_PRESSURE
            & !HighresImuUpdatedFlags::HIGHRES_IMU_UPDATED_PRESSURE_ALT;
    }
    MavMessage::HIGHRES_IMU(HIGHRES_IMU_DATA {
        time_usec: readings.inertial.time_us,
        xacc: force.x as f32,
        yacc: force.y as f32,
        zacc: force.z as f32,
        xgyro: rate.x as f32,
        ygyro: rate.y as f32,
        zgyro: rate.z as f32,
        xmag: field.x as f32,
        ymag: field.y as f32,
        zmag: field.z as f32,
        abs_pressure: readings.barometer.map_or(0.0, |reading| (reading.pressure_pa / 100.0) as f32),
        diff_pressure: 0.0,
        pressure_alt: readings.barometer.map_or(0.0, |reading| reading.altitude_m() as f32),
        temperature: 0.0,
        fields_updated: updated,
        id: 0,
    })
}

/// Per m/s², rad/s and G: those of mG, mrad/s and mgauss.
const SCALES_OF_SCALED_IMU: [f64; 3] = [1e3 / GRAVITY_M_S2, 1e3, 1e3];

/// RAW_IMU: what stands in the registers, at the full scales of the parts; of ArduPilot the units of SCALED_IMU.
pub fn raw_imu(vehicle: &Vehicle) -> MavMessage {
    let readings = vehicle.readings();
    let [force, rate, field] = if vehicle.identity().is_ardupilot() {
        SCALES_OF_SCALED_IMU
    } else {
        [ACCELEROMETER_COUNTS_PER_M_S2, GYROSCOPE_COUNTS_PER_RAD_S, COUNTS_PER_GAUSS]
    };
    let [xacc, yacc, zacc] = whole(&readings.inertial.specific_force_m_s2, force);
    let [xgyro, ygyro, zgyro] = whole(&readings.inertial.body_rate_rad_s, rate);
    let [xmag, ymag, zmag] = whole(&field_gauss(&readings), field);
    MavMessage::RAW_IMU(RAW_IMU_DATA {
        time_usec: readings.inertial.time_us,
        xacc,
        yacc,
        zacc,
        xgyro,
        ygyro,
        zgyro,
        xmag,
        ymag,
        zmag,
        id: 0,
        temperature: 0,
    })
}

/// SCALED_IMU: mG, mrad/s and mgauss.
pub fn scaled_imu(vehicle: &Vehicle) -> MavMessage {
    let readings = vehicle.readings();
    let [force, rate, field] = SCALES_OF_SCALED_IMU;
    let [xacc, yacc, zacc] = whole(&readings.inertial.specific_force_m_s2, force);
    let [xgyro, ygyro, zgyro] = whole(&readings.inertial.body_rate_rad_s, rate);
    let [xmag, ymag, zmag] = whole(&field_gauss(&readings), field);
    MavMessage::SCALED_IMU(SCALED_IMU_DATA {
        time_boot_ms: boot_ms(readings.inertial.time_us),
        xacc,
        yacc,
        zacc,
        xgyro,
        ygyro,
        zgyro,
        xmag,
        ymag,
        zmag,
        temperature: 0,
    })
}

fn whole(vector: &Vector3<f64>, scale: f64) -> [i16; 3] {
    // Out of range it stays at the end of it.
    vector.data.0[0].map(|value| (value * scale).round() as i16)
}

/// SCALED_PRESSURE: the barometer, at the temperature of the standard atmosphere.
pub fn scaled_pressure(vehicle: &Vehicle) -> MavMessage {
    MavMessage::SCALED_PRESSURE(pressure(vehicle))
}

/// SCALED_PRESSURE2: a second barometer, which measures the same.
pub fn scaled_pressure2(vehicle: &Vehicle) -> Option<MavMessage> {
    let SCALED_PRESSURE_DATA { time_boot_ms, press_abs, press_diff, temperature, temperature_press_diff } =
        pressure(vehicle);
    (vehicle.conduct().simulated.told_barometers() > 1).then_some(MavMessage::SCALED_PRESSURE2(
        SCALED_PRESSURE2_DATA { time_boot_ms, press_abs, press_diff, temperature, temperature_press_diff },
    ))
}

/// SCALED_PRESSURE3: a third one.
pub fn scaled_pressure3(vehicle: &Vehicle) -> Option<MavMessage> {
    let SCALED_PRESSURE_DATA { time_boot_ms, press_abs, press_diff, temperature, temperature_press_diff } =
        pressure(vehicle);
    (vehicle.conduct().simulated.told_barometers() > 2).then_some(MavMessage::SCALED_PRESSURE3(
        SCALED_PRESSURE3_DATA { time_boot_ms, press_abs, press_diff, temperature, temperature_press_diff },
    ))
}

fn pressure(vehicle: &Vehicle) -> SCALED_PRESSURE_DATA {
    let reading = vehicle.readings().barometer;
    let altitude_m = reading.map_or(0.0, |reading| reading.altitude_m());
    SCALED_PRESSURE_DATA {
        time_boot_ms: boot_ms(reading.map_or(0, |reading| reading.time_us)),
        press_abs: reading.map_or(0.0, |reading| (reading.pressure_pa / 100.0) as f32),
        press_diff: 0.0,
        temperature: (atmospheric_temperature_degc(altitude_m) * 1e2).round() as i16,
        temperature_press_diff: 0,
    }
}

/// VIBRATION: of the accelerometers. The rigid body has none, so that ideal ones do not shake.
pub fn vibration(vehicle: &Vehicle) -> MavMessage {
    let navigation = vehicle.navigation();
    let level = navigation.map(|navigation| navigation.vibration().level_m_s2()).unwrap_or_default();
    let [clipping_0, clipping_1, clipping_2] =
        navigation.map(|navigation| navigation.clipped()).unwrap_or_default();
    MavMessage::VIBRATION(VIBRATION_DATA {
        time_usec: vehicle.time_us(),
        vibration_x: level.x as f32,
        vibration_y: level.y as f32,
        vibration_z: level.z as f32,
        clipping_0,
        clipping_1,
        clipping_2,
    })
}
