//! What is logged: PX4's topics under PX4's names, as far as this vehicle has them, and the controllers' own.
//!
//! What the vehicle believes comes from its telemetry; topics with `groundtruth` are the simulation's truth, as in PX4's
//! simulations.

use autopilot::Autopilot;
use mavlink::dialects::common::{GpsFixType, MavMessage};
use quadrotor::ControllerActivity;
use vehicle::estimation::Validity;
use vehicle::identity::Identity;
use vehicle::{LandedState, MissionState, SteeringKind};

use super::row::Row;

/// A topic.
#[derive(Clone, Copy, Debug)]
pub struct Topic {
    /// Its name.
    pub name: &'static str,
    /// Its fields behind `uint64_t timestamp;`.
    pub fields: &'static str,
    /// How often it is sampled, µs: a multiple of the grid of the log.
    pub period_us: u64,
    /// Whether it is also logged whenever it changes.
    pub on_change: bool,
    /// Writes the fields; `false` when there are none now.
    pub sample: fn(&Autopilot, &mut Row) -> bool,
}

/// All sampling times are multiples of it, µs.
pub const GRID_US: u64 = 10_000;

/// How often the inertial sensors are sampled, µs.
const IMU_US: u64 = 20_000;

const fn topic(
    name: &'static str,
    fields: &'static str,
    period_us: u64,
    sample: fn(&Autopilot, &mut Row) -> bool,
) -> Topic {
    Topic { name, fields, period_us, on_change: false, sample }
}

const fn watched(
    name: &'static str,
    fields: &'static str,
    period_us: u64,
    sample: fn(&Autopilot, &mut Row) -> bool,
) -> Topic {
    Topic { name, fields, period_us, on_change: true, sample }
}

const LOCAL_POSITION: &str = "bool xy_valid;bool z_valid;bool v_xy_valid;bool v_z_valid;float x;float y;float z;float vx;\
     float vy;float vz;float heading;bool xy_global;bool z_global;double ref_lat;\
     double ref_lon;float ref_alt;float dist_bottom;bool dist_bottom_valid;";
const ATTITUDE: &str = "float[4] q;";
const GLOBAL_POSITION: &str = "double lat;double lon;float alt;";
const ANGULAR_VELOCITY: &str = "float[3] xyz;";

/// All topics.
pub static TOPICS: &[Topic] = &[
    topic("vehicle_attitude", ATTITUDE, 20_000, attitude),
    topic("vehicle_attitude_groundtruth", ATTITUDE, 50_000, true_attitude),
    topic(
        "vehicle_attitude_setpoint",
        "float[4] q_d;float yaw_sp_move_rate;float[3] thrust_body;",
        20_000,
        attitude_setpoint,
    ),
    topic("vehicle_angular_velocity", ANGULAR_VELOCITY, 10_000, angular_velocity),
    topic("vehicle_angular_velocity_groundtruth", ANGULAR_VELOCITY, 50_000, true_angular_velocity),
    topic("vehicle_local_position", LOCAL_POSITION, 20_000, local_position),
    topic("vehicle_local_position_groundtruth", LOCAL_POSITION, 50_000, true_local_position),
    topic(
        "vehicle_local_position_setpoint",
        "float x;float y;float z;float vx;float vy;float vz;float[3] acceleration;float[3] thrust;float yaw;float yawspeed;",
        20_000,
        local_position_setpoint,
    ),
    topic("vehicle_global_position", GLOBAL_POSITION, 200_000, global_position),
    topic("vehicle_global_position_groundtruth", GLOBAL_POSITION, 200_000, true_global_position),
    topic(
        "vehicle_gps_position",
        "uint64_t time_utc_usec;double latitude_deg;double longitude_deg;double altitude_msl_m;\
         double altitude_ellipsoid_m;float eph;float epv;float hdop;float vdop;float vel_m_s;float cog_rad;\
         uint8_t fix_type;uint8_t satellites_used;",
        200_000,
        gps_position,
    ),
    topic(
        "sensor_combined",
        "float[3] gyro_rad;uint32_t gyro_integral_dt;float[3] accelerometer_m_s2;uint32_t accelerometer_integral_dt;",
        IMU_US,
        sensor_combined,
    ),
    topic(
        "vehicle_imu_status",
        "uint32_t[3] accel_clipping;float accel_vibration_metric;",
        200_000,
        imu_status,
    ),
    topic(
        "estimator_status",
        "float vel_test_ratio;float pos_test_ratio;float hgt_test_ratio;float mag_test_ratio;float pos_horiz_accuracy;\
         float pos_vert_accuracy;float time_slip;uint16_t innovation_check_flags;uint16_t solution_status_flags;\
         uint8_t health_flags;uint8_t timeout_flags;",
        200_000,
        estimator_status,
    ),
    topic("vehicle_magnetometer", "float[3] magnetometer_ga;", 100_000, magnetometer),
    topic("vehicle_air_data", "float baro_alt_meter;float baro_pressure_pa;", 100_000, air_data),
    topic("actuator_motors", "float[12] control;", 20_000, actuator_motors),
    topic("actuator_outputs", "uint32_t noutputs;float[16] output;", 100_000, actuator_outputs),
    topic(
        "battery_status",
        "float voltage_v;float voltage_filtered_v;float current_a;float discharged_mah;float remaining;float time_remaining_s;bool connected;\
         uint8_t cell_count;",
        500_000,
        battery_status,
    ),
    topic("wind", "float windspeed_north;float windspeed_east;", 500_000, wind),
    watched(
        "vehicle_status",
        "uint8_t arming_state;uint8_t nav_state;uint8_t vehicle_type;uint8_t system_id;uint8_t component_id;bool failsafe;",
        500_000,
        vehicle_status,
    ),
    watched(
        "vehicle_land_detected",
        "bool landed;bool maybe_landed;bool ground_contact;bool freefall;",
        1_000_000,
        land_detected,
    ),
    watched(
        "mission_result",
        "uint16_t seq_current;uint16_t seq_total;bool valid;bool finished;",
        1_000_000,
        mission_result,
    ),
    watched(
        "home_position",
        "double lat;double lon;float alt;float x;float y;float z;float yaw;bool valid_alt;bool valid_hpos;bool valid_lpos;",
        10_000_000,
        home_position,
    ),
    topic(
        "lmpc_status",
        "float[3] tracking_error_m;float yaw_error_rad;float[2] tilt_reference_rad;float thrust_n;float[3] torque_n_m;\
         float[4] rotor_speed_rad_s;uint32_t altitude_iterations;uint32_t position_iterations;\
         uint32_t attitude_iterations;uint32_t altitude_active_constraints;uint32_t position_active_constraints;\
         uint32_t attitude_active_constraints;uint8_t altitude_status;uint8_t position_status;uint8_t attitude_status;\
         uint8_t steering;",
        20_000,
        lmpc_status,
    ),
];

fn attitude(autopilot: &Autopilot, row: &mut Row) -> bool {
    const ATTITUDE_QUATERNION: u32 = 31;
    match autopilot.message(ATTITUDE_QUATERNION) {
        Some(MavMessage::ATTITUDE_QUATERNION(told)) => {
            row.floats([told.q1, told.q2, told.q3, told.q4]);
            true
        }
        _ => false,
    }
}

fn true_attitude(autopilot: &Autopilot, row: &mut Row) -> bool {
    row.reals(autopilot.vehicle().truth().quaternion);
    true
}

fn attitude_setpoint(autopilot: &Autopilot, row: &mut Row) -> bool {
    const ATTITUDE_TARGET: u32 = 83;
    match autopilot.message(ATTITUDE_TARGET) {
        Some(MavMessage::ATTITUDE_TARGET(told)) => {
            row.floats(told.q).floats([told.body_yaw_rate]).floats([0.0, 0.0, -told.thrust]);
            true
        }
        _ => false,
    }
}

fn angular_velocity(autopilot: &Autopilot, row: &mut Row) -> bool {
    const ATTITUDE_QUATERNION: u32 = 31;
    match autopilot.message(ATTITUDE_QUATERNION) {
        Some(MavMessage::ATTITUDE_QUATERNION(told)) => {
            row.floats([told.rollspeed, told.pitchspeed, told.yawspeed]);
            true
        }
        _ => false,
    }
}

fn true_angular_velocity(autopilot: &Autopilot, row: &mut Row) -> bool {
    row.reals(autopilot.vehicle().truth().body_rate_rad_s.data.0[0]);
    true
}

/// Validity, then what the caller says, then the origin and the height above ground.
fn position_row(autopilot: &Autopilot, row: &mut Row, validity: &Validity, values: [f32; 7]) {
    let origin = autopilot.vehicle().frame().origin();
    let (horizontal, vertical) = (validity.horizontal_position, validity.vertical_position);
    row.bool(horizontal).bool(vertical);
    row.bool(validity.horizontal_velocity).bool(validity.vertical_velocity);
    row.floats(values).bool(horizontal).bool(vertical);
    row.f64(origin.latitude_deg).f64(origin.longitude_deg).f32(origin.altitude_m as f32);
    let [_, _, z, ..] = values;
    row.f32(-z).bool(vertical);
}

fn local_position(autopilot: &Autopilot, row: &mut Row) -> bool {
    const LOCAL_POSITION_NED: u32 = 32;
    const ATTITUDE: u32 = 30;
    let (Some(MavMessage::LOCAL_POSITION_NED(told)), Some(MavMessage::ATTITUDE(attitude))) =
        (autopilot.message(LOCAL_POSITION_NED), autopilot.message(ATTITUDE))
    else {
        return false;
    };
    let values = [told.x, told.y, told.z, told.vx, told.vy, told.vz, attitude.yaw];
    position_row(autopilot, row, &autopilot.vehicle().validity(), values);
    true
}

fn true_local_position(autopilot: &Autopilot, row: &mut Row) -> bool {
    let truth = autopilot.vehicle().truth();
    let [x, y, z] = truth.position_m.data.0[0];
    let [vx, vy, vz] = truth.velocity_m_s.data.0[0];
    let values = [x, y, z, vx, vy, vz, truth.attitude_rad.z];
    position_row(autopilot, row, &Validity::ALL, values.map(|value| value as f32));
    true
}

/// NaN while the vehicle is not steered by position.
fn local_position_setpoint(autopilot: &Autopilot, row: &mut Row) -> bool {
    let vehicle = autopilot.vehicle();
    let reference = &vehicle.outputs().setpoint;
    if vehicle.steering_kind() != SteeringKind::Position {
        row.floats([f32::NAN; 14]);
        return true;
    }
    row.reals(reference.position_m.data.0[0]).reals(reference.velocity_m_s.data.0[0]);
    row.reals(reference.acceleration_m_s2.data.0[0]);
    let (_, strongest_n) = vehicle.simulation().configuration().airframe.thrust_range_n();
    row.reals([0.0, 0.0, -vehicle.outputs().thrust_n / strongest_n]);
    row.reals([reference.yaw_rad, reference.yaw_rate_rad_s]);
    true
}

fn global_position(autopilot: &Autopilot, row: &mut Row) -> bool {
    const GLOBAL_POSITION_INT: u32 = 33;
    match autopilot.message(GLOBAL_POSITION_INT) {
        Some(MavMessage::GLOBAL_POSITION_INT(told)) => {
            row.f64(f64::from(told.lat) / 1e7).f64(f64::from(told.lon) / 1e7).f32(told.alt as f32 / 1e3);
            true
        }
        _ => false,
    }
}

fn true_global_position(autopilot: &Autopilot, row: &mut Row) -> bool {
    let vehicle = autopilot.vehicle();
    let place = vehicle.frame().to_geodetic(&vehicle.truth().position_m);
    row.f64(place.latitude_deg).f64(place.longitude_deg).f32(place.altitude_m as f32);
    true
}

fn gps_position(autopilot: &Autopilot, row: &mut Row) -> bool {
    const GPS_RAW_INT: u32 = 24;
    let Some(MavMessage::GPS_RAW_INT(told)) = autopilot.message(GPS_RAW_INT) else {
        return false;
    };
    let hundredths = |value: u16| if value == u16::MAX { f32::NAN } else { f32::from(value) / 100.0 };
    row.u64(autopilot.unix_start_us() + autopilot.vehicle().time_us());
    row.f64(f64::from(told.lat) / 1e7).f64(f64::from(told.lon) / 1e7);
    row.f64(f64::from(told.alt) / 1e3).f64(f64::from(told.alt_ellipsoid) / 1e3);
    // Zero would be the best of all.
    let fixed = told.fix_type != GpsFixType::GPS_FIX_TYPE_NO_FIX;
    row.floats([told.h_acc, told.v_acc].map(|mm| if fixed { mm as f32 / 1e3 } else { f32::NAN }));
    row.floats([hundredths(told.eph), hundredths(told.epv), hundredths(told.vel)]);
    row.f32(hundredths(told.cog).to_radians()).u8(told.fix_type as u8).u8(told.satellites_visible);
    true
}

fn sensor_combined(autopilot: &Autopilot, row: &mut Row) -> bool {
    let Some(told) = imu(autopilot) else { return false };
    let dt_us = IMU_US as u32;
    row.floats([told.xgyro, told.ygyro, told.zgyro]).u32(dt_us);
    row.floats([told.xacc, told.yacc, told.zacc]).u32(dt_us);
    true
}

fn imu_status(autopilot: &Autopilot, row: &mut Row) -> bool {
    const VIBRATION: u32 = 241;
    let Some(MavMessage::VIBRATION(told)) = autopilot.message(VIBRATION) else { return false };
    row.u32(told.clipping_0).u32(told.clipping_1).u32(told.clipping_2);
    let level = [told.vibration_x, told.vibration_y, told.vibration_z];
    row.f32(level.iter().map(|axis| axis * axis).sum::<f32>().sqrt());
    true
}

/// The checks are bits: velocity, horizontal position, height, three of the field, heading; health and timeouts: velocity,
/// position, height.
fn estimator_status(autopilot: &Autopilot, row: &mut Row) -> bool {
    const ESTIMATOR_STATUS: u32 = 230;
    let Some(MavMessage::ESTIMATOR_STATUS(told)) = autopilot.message(ESTIMATOR_STATUS) else {
        return false;
    };
    let ratios = [told.vel_ratio, told.pos_horiz_ratio, told.pos_vert_ratio, told.mag_ratio];
    row.floats(ratios).floats([told.pos_horiz_accuracy, told.pos_vert_accuracy, 0.0]);
    let bits = |set: &[(bool, u16)]| set.iter().map(|(set, bit)| u16::from(*set) << bit).sum::<u16>();
    let [velocity, position, height, heading] = ratios.map(|ratio| ratio > 1.0);
    row.u16(bits(&[(velocity, 0), (position, 1), (height, 2), (heading, 6)])).u16(told.flags.bits());
    let validity = autopilot.vehicle().validity();
    let healthy = [
        (validity.horizontal_velocity && validity.vertical_velocity, 0),
        (validity.horizontal_position, 1),
        (validity.vertical_position, 2),
    ];
    let health = bits(&healthy) as u8;
    row.u8(health).u8(!health & 0b111);
    true
}

fn magnetometer(autopilot: &Autopilot, row: &mut Row) -> bool {
    let Some(told) = imu(autopilot) else { return false };
    row.floats([told.xmag, told.ymag, told.zmag]);
    true
}

fn air_data(autopilot: &Autopilot, row: &mut Row) -> bool {
    let Some(told) = imu(autopilot) else { return false };
    row.f32(told.pressure_alt).f32(told.abs_pressure * 100.0);
    true
}

fn imu(autopilot: &Autopilot) -> Option<mavlink::dialects::common::HIGHRES_IMU_DATA> {
    const HIGHRES_IMU: u32 = 105;
    match autopilot.message(HIGHRES_IMU) {
        Some(MavMessage::HIGHRES_IMU(told)) => Some(told),
        _ => None,
    }
}

/// Speed as a share of the fastest, squared: the share of the thrust. NaN where there is no rotor.
fn actuator_motors(autopilot: &Autopilot, row: &mut Row) -> bool {
    let vehicle = autopilot.vehicle();
    let fastest = vehicle.simulation().configuration().airframe.rotor_speed_max_rad_s;
    let shares = vehicle.outputs().rotor_speed_rad_s.map(|speed| (speed / fastest) * (speed / fastest));
    row.reals(shares).floats([f32::NAN; 8]);
    true
}

/// As pulses, µs.
fn actuator_outputs(autopilot: &Autopilot, row: &mut Row) -> bool {
    let vehicle = autopilot.vehicle();
    let fastest = vehicle.simulation().configuration().airframe.rotor_speed_max_rad_s;
    let pulses = vehicle.outputs().rotor_speed_rad_s.map(|speed| 1000.0 + 1000.0 * speed / fastest);
    row.u32(pulses.len() as u32).reals(pulses).floats([0.0; 12]);
    true
}

fn battery_status(autopilot: &Autopilot, row: &mut Row) -> bool {
    let vehicle = autopilot.vehicle();
    let battery = vehicle.battery();
    let capacity_ah = vehicle.conduct().battery_capacity_ah;
    // Its model has no noise to be filtered; readers that ask for both show neither without.
    row.reals([battery.voltage_v(), battery.voltage_v(), battery.current_a(), battery.drawn_ah() * 1e3]);
    row.reals([vehicle.battery_remaining(), battery.time_remaining_s(capacity_ah)]);
    row.bool(true).u8(vehicle::BATTERY_CELLS as u8);
    true
}

fn wind(autopilot: &Autopilot, row: &mut Row) -> bool {
    let wind = autopilot.vehicle().wind_m_s();
    row.reals([wind.x, wind.y]);
    true
}

fn vehicle_status(autopilot: &Autopilot, row: &mut Row) -> bool {
    const DISARMED: u8 = 1;
    const ARMED: u8 = 2;
    const ROTARY_WING: u8 = 1;
    let vehicle = autopilot.vehicle();
    row.u8(if vehicle.is_armed() { ARMED } else { DISARMED });
    row.u8(nav_state(Identity::Px4.custom_mode(vehicle.mode()))).u8(ROTARY_WING);
    row.u8(autopilot.system_id()).u8(autopilot::COMPONENT);
    row.bool(vehicle.failsafe().engaged().is_some());
    true
}

/// PX4's `nav_state` of a mode as PX4 tells it in heartbeats.
fn nav_state(custom_mode: u32) -> u8 {
    match (custom_mode >> 16 & 0xff, custom_mode >> 24) {
        (2, _) => 1,
        (3, _) => 2,
        (4, 2) => 17,
        (4, 4) => 3,
        (4, 5) => 5,
        (4, 6) => 18,
        (4, _) => 4,
        (5, _) => 10,
        (6, _) => 14,
        (7, _) => 15,
        _ => 0,
    }
}

fn land_detected(autopilot: &Autopilot, row: &mut Row) -> bool {
    let landed = autopilot.vehicle().landed_state() == LandedState::OnGround;
    row.bool(landed).bool(landed).bool(landed).bool(false);
    true
}

fn mission_result(autopilot: &Autopilot, row: &mut Row) -> bool {
    let status = autopilot.vehicle().mission_status();
    let sequence = |number: usize| u16::try_from(number).unwrap_or(u16::MAX);
    row.u16(sequence(status.current)).u16(sequence(status.total));
    row.bool(status.state != MissionState::None).bool(status.state == MissionState::Complete);
    true
}

fn home_position(autopilot: &Autopilot, row: &mut Row) -> bool {
    let vehicle = autopilot.vehicle();
    let home = vehicle.home();
    let place = vehicle.frame().to_geodetic(&home.position_m);
    row.f64(place.latitude_deg).f64(place.longitude_deg).f32(place.altitude_m as f32);
    row.reals(home.position_m.data.0[0]).reals([home.yaw_rad]).bool(true).bool(true).bool(true);
    true
}

/// A status counts optimal, relaxed, at the iteration limit, held; steering counts idle, position, attitude.
fn lmpc_status(autopilot: &Autopilot, row: &mut Row) -> bool {
    let vehicle = autopilot.vehicle();
    let outputs = vehicle.outputs();
    row.reals(outputs.tracking_error_m.data.0[0]).reals([outputs.yaw_error_rad]);
    row.reals(outputs.tilt_reference_rad).reals([outputs.thrust_n]).reals(outputs.torque_n_m.data.0[0]);
    row.reals(outputs.rotor_speed_rad_s);
    let activity = &outputs.activity;
    let all = [&activity.altitude, &activity.position, &activity.attitude];
    for of in [|one: &ControllerActivity| one.iterations, |one: &ControllerActivity| one.active] {
        for controller in all {
            row.u32(of(controller));
        }
    }
    for controller in all {
        row.u8(controller.status as u8);
    }
    row.u8(vehicle.steering_kind() as u8);
    true
}
