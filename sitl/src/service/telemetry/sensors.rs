//! What instruments on board would show, without noise, and how good the estimate is: it is the truth.

use mavlink::dialects::common::{
    ESTIMATOR_STATUS_DATA, EstimatorStatusFlags, GPS_RAW_INT_DATA, GpsFixType, HIGHRES_IMU_DATA,
    HighresImuUpdatedFlags, MavMessage, VIBRATION_DATA,
};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use quadrotor::GRAVITY_M_S2;

use super::position::{heading_deg, scaled_degrees};
use crate::vehicle::Vehicle;
use crate::world::{atmospheric_pressure_pa, earth_field_ned};

/// GPS_RAW_INT: a fix of twelve satellites.
pub fn gps_raw_int(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let place = vehicle.frame().to_geodetic(&outputs.position_m);
    let altitude_mm = (place.altitude_m * 1e3).round() as i32;
    let ground_m_s = outputs.velocity_m_s.xy();
    let course_rad = libm::atan2(ground_m_s.y, ground_m_s.x);
    MavMessage::GPS_RAW_INT(GPS_RAW_INT_DATA {
        time_usec: outputs.time_us,
        lat: scaled_degrees(place.latitude_deg),
        lon: scaled_degrees(place.longitude_deg),
        alt: altitude_mm,
        eph: 70,
        epv: 110,
        vel: (ground_m_s.norm() * 1e2).round() as u16,
        cog: (heading_deg(course_rad) * 1e2).floor() as u16,
        fix_type: GpsFixType::GPS_FIX_TYPE_3D_FIX,
        satellites_visible: 12,
        alt_ellipsoid: altitude_mm,
        h_acc: 0,
        v_acc: 0,
        vel_acc: 0,
        hdg_acc: 0,
        // Zero: no heading from it.
        yaw: 0,
    })
}

/// HIGHRES_IMU: specific force, body rates, magnetic field and air pressure.
pub fn highres_imu(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let [w, x, y, z] = outputs.quaternion;
    let rotation = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
    let gravity = Vector3::new(0.0, 0.0, GRAVITY_M_S2);
    let force = rotation.inverse_transform_vector(&(outputs.acceleration_m_s2 - gravity));
    let place = vehicle.frame().to_geodetic(&outputs.position_m);
    let field = rotation.inverse_transform_vector(&earth_field_ned(&place));
    let updated = HighresImuUpdatedFlags::all()
        & !HighresImuUpdatedFlags::HIGHRES_IMU_UPDATED_DIFF_PRESSURE
        & !HighresImuUpdatedFlags::HIGHRES_IMU_UPDATED_TEMPERATURE;
    MavMessage::HIGHRES_IMU(HIGHRES_IMU_DATA {
        time_usec: outputs.time_us,
        xacc: force.x as f32,
        yacc: force.y as f32,
        zacc: force.z as f32,
        xgyro: outputs.body_rate_rad_s.x as f32,
        ygyro: outputs.body_rate_rad_s.y as f32,
        zgyro: outputs.body_rate_rad_s.z as f32,
        xmag: field.x as f32,
        ymag: field.y as f32,
        zmag: field.z as f32,
        abs_pressure: (atmospheric_pressure_pa(place.altitude_m) / 100.0) as f32,
        diff_pressure: 0.0,
        pressure_alt: place.altitude_m as f32,
        temperature: 0.0,
        fields_updated: updated,
        id: 0,
    })
}

/// ESTIMATOR_STATUS: the state is known.
pub fn estimator_status(vehicle: &Vehicle) -> MavMessage {
    MavMessage::ESTIMATOR_STATUS(ESTIMATOR_STATUS_DATA {
        time_usec: vehicle.time_us(),
        flags: EstimatorStatusFlags::ESTIMATOR_ATTITUDE
            | EstimatorStatusFlags::ESTIMATOR_VELOCITY_HORIZ
            | EstimatorStatusFlags::ESTIMATOR_VELOCITY_VERT
            | EstimatorStatusFlags::ESTIMATOR_POS_HORIZ_REL
            | EstimatorStatusFlags::ESTIMATOR_POS_HORIZ_ABS
            | EstimatorStatusFlags::ESTIMATOR_POS_VERT_ABS
            | EstimatorStatusFlags::ESTIMATOR_POS_VERT_AGL
            | EstimatorStatusFlags::ESTIMATOR_PRED_POS_HORIZ_REL
            | EstimatorStatusFlags::ESTIMATOR_PRED_POS_HORIZ_ABS,
        ..ESTIMATOR_STATUS_DATA::default()
    })
}

/// VIBRATION: the rigid body has none.
pub fn vibration(vehicle: &Vehicle) -> MavMessage {
    MavMessage::VIBRATION(VIBRATION_DATA { time_usec: vehicle.time_us(), ..VIBRATION_DATA::default() })
}
