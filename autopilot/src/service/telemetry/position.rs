//! Where the vehicle is, and how it moves.

use mavlink::dialects::ardupilotmega::{
    ALTITUDE_DATA, GLOBAL_POSITION_INT_DATA, HOME_POSITION_DATA, LOCAL_POSITION_NED_DATA, MavEstimatorType,
    MavFrame, MavMessage, ODOMETRY_DATA, VFR_HUD_DATA,
};
use vehicle::Vehicle;
use vehicle::world::heading_deg;

use crate::codec::{boot_ms, centimetres_per_second, floats, millimetres, scaled_degrees};

/// LOCAL_POSITION_NED.
pub fn local_position_ned(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let [x, y, z] = floats(&vehicle.told_frame().told_m(&outputs.position_m));
    let [vx, vy, vz] = floats(&outputs.velocity_m_s);
    let time_boot_ms = boot_ms(outputs.time_us);
    MavMessage::LOCAL_POSITION_NED(LOCAL_POSITION_NED_DATA { time_boot_ms, x, y, z, vx, vy, vz })
}

/// GLOBAL_POSITION_INT.
pub fn global_position_int(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let place = vehicle.place_of(&outputs.position_m);
    let above_home_m = vehicle.home().position_m.z - outputs.position_m.z;
    let [vx, vy, vz] = outputs.velocity_m_s.data.0[0].map(centimetres_per_second);
    MavMessage::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA {
        time_boot_ms: boot_ms(outputs.time_us),
        lat: scaled_degrees(place.latitude_deg),
        lon: scaled_degrees(place.longitude_deg),
        alt: millimetres(place.altitude_m),
        relative_alt: millimetres(above_home_m),
        vx,
        vy,
        vz,
        hdg: (heading_deg(outputs.attitude_rad.z) * 100.0).floor() as u16,
    })
}

/// HOME_POSITION.
pub fn home_position(vehicle: &Vehicle) -> MavMessage {
    let home = vehicle.home();
    let place = vehicle.place_of(&home.position_m);
    let [x, y, z] = floats(&vehicle.told_frame().told_m(&home.position_m));
    MavMessage::HOME_POSITION(HOME_POSITION_DATA {
        latitude: scaled_degrees(place.latitude_deg),
        longitude: scaled_degrees(place.longitude_deg),
        altitude: millimetres(place.altitude_m),
        x,
        y,
        z,
        q: [(home.yaw_rad / 2.0).cos() as f32, 0.0, 0.0, (home.yaw_rad / 2.0).sin() as f32],
        time_usec: vehicle.time_us(),
        ..HOME_POSITION_DATA::default()
    })
}

/// ALTITUDE: every kind of it.
pub fn altitude(vehicle: &Vehicle) -> MavMessage {
    let position_m = vehicle.outputs().position_m;
    let height_m = -position_m.z;
    let above_ground_m = vehicle.terrain().z_below_m(&position_m) + height_m;
    let amsl_m = vehicle.frame().origin().altitude_m + height_m;
    MavMessage::ALTITUDE(ALTITUDE_DATA {
        time_usec: vehicle.time_us(),
        altitude_monotonic: amsl_m as f32,
        altitude_amsl: amsl_m as f32,
        altitude_local: -vehicle.told_frame().told_m(&position_m).z as f32,
        altitude_relative: (vehicle.home().position_m.z + height_m) as f32,
        altitude_terrain: above_ground_m as f32,
        bottom_clearance: above_ground_m as f32,
    })
}

/// VFR_HUD.
pub fn vfr_hud(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let (_, strongest_n) = vehicle.simulation().configuration().airframe.thrust_range_n();
    MavMessage::VFR_HUD(VFR_HUD_DATA {
        airspeed: (outputs.velocity_m_s - vehicle.wind_m_s()).norm() as f32,
        groundspeed: outputs.velocity_m_s.xy().norm() as f32,
        alt: (vehicle.frame().origin().altitude_m - outputs.position_m.z) as f32,
        climb: -outputs.velocity_m_s.z as f32,
        heading: heading_deg(outputs.attitude_rad.z).floor() as i16,
        throttle: (100.0 * outputs.thrust_n / strongest_n).round() as u16,
    })
}

/// ODOMETRY: pose in the local frame, velocity in the body's.
pub fn odometry(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let [x, y, z] = floats(&vehicle.told_frame().told_m(&outputs.position_m));
    let [vx, vy, vz] = floats(&outputs.body_velocity_m_s);
    let [rollspeed, pitchspeed, yawspeed] = floats(&outputs.body_rate_rad_s);
    // NaN in the first place: the covariance is unknown.
    let unknown = core::array::from_fn(|index| if index == 0 { f32::NAN } else { 0.0 });
    MavMessage::ODOMETRY(ODOMETRY_DATA {
        time_usec: outputs.time_us,
        x,
        y,
        z,
        q: outputs.quaternion.map(|part| part as f32),
        vx,
        vy,
        vz,
        rollspeed,
        pitchspeed,
        yawspeed,
        pose_covariance: unknown,
        velocity_covariance: unknown,
        frame_id: MavFrame::MAV_FRAME_LOCAL_NED,
        child_frame_id: MavFrame::MAV_FRAME_BODY_FRD,
        reset_counter: vehicle.estimate().map_or(0, |estimate| estimate.resets as u8),
        estimator_type: MavEstimatorType::MAV_ESTIMATOR_TYPE_AUTOPILOT,
        quality: 100,
    })
}
