//! The table of all topics.

use super::super::row::Row;
use super::motion;
use super::sensors::{self, IMU_US};
use super::status;
use super::topic::Topic;
use crate::flight_log::LogSource;

const fn topic(
    name: &'static str,
    fields: &'static str,
    period_us: u64,
    sample: fn(&LogSource<'_>, &mut Row),
) -> Topic {
    Topic { name, fields, period_us, on_change: false, sample }
}

const fn watched(
    name: &'static str,
    fields: &'static str,
    period_us: u64,
    sample: fn(&LogSource<'_>, &mut Row),
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
    topic("vehicle_attitude", ATTITUDE, 20_000, motion::attitude),
    topic("vehicle_attitude_groundtruth", ATTITUDE, 50_000, motion::true_attitude),
    topic(
        "vehicle_attitude_setpoint",
        "float[4] q_d;float yaw_sp_move_rate;float[3] thrust_body;",
        20_000,
        motion::attitude_setpoint,
    ),
    topic("vehicle_angular_velocity", ANGULAR_VELOCITY, 10_000, motion::angular_velocity),
    topic("vehicle_angular_velocity_groundtruth", ANGULAR_VELOCITY, 50_000, motion::true_angular_velocity),
    topic("vehicle_local_position", LOCAL_POSITION, 20_000, motion::local_position),
    topic("vehicle_local_position_groundtruth", LOCAL_POSITION, 50_000, motion::true_local_position),
    topic(
        "vehicle_local_position_setpoint",
        "float x;float y;float z;float vx;float vy;float vz;float[3] acceleration;float[3] thrust;float yaw;float yawspeed;",
        20_000,
        motion::local_position_setpoint,
    ),
    topic("vehicle_global_position", GLOBAL_POSITION, 200_000, motion::global_position),
    topic("vehicle_global_position_groundtruth", GLOBAL_POSITION, 200_000, motion::true_global_position),
    topic(
        "vehicle_gps_position",
        "uint64_t time_utc_usec;double latitude_deg;double longitude_deg;double altitude_msl_m;\
         double altitude_ellipsoid_m;float eph;float epv;float hdop;float vdop;float vel_m_s;float cog_rad;\
         uint8_t fix_type;uint8_t satellites_used;",
        200_000,
        sensors::gps_position,
    ),
    topic(
        "sensor_combined",
        "float[3] gyro_rad;uint32_t gyro_integral_dt;float[3] accelerometer_m_s2;uint32_t accelerometer_integral_dt;",
        IMU_US,
        sensors::sensor_combined,
    ),
    topic(
        "vehicle_imu_status",
        "uint32_t[3] accel_clipping;float accel_vibration_metric;",
        200_000,
        sensors::imu_status,
    ),
    topic(
        "estimator_status",
        "float vel_test_ratio;float pos_test_ratio;float hgt_test_ratio;float mag_test_ratio;float pos_horiz_accuracy;\
         float pos_vert_accuracy;float time_slip;uint16_t innovation_check_flags;uint16_t solution_status_flags;\
         uint8_t health_flags;uint8_t timeout_flags;",
        200_000,
        sensors::estimator_status,
    ),
    topic("vehicle_magnetometer", "float[3] magnetometer_ga;", 100_000, sensors::magnetometer),
    topic("vehicle_air_data", "float baro_alt_meter;float baro_pressure_pa;", 100_000, sensors::air_data),
    topic("actuator_motors", "float[12] control;", 20_000, status::actuator_motors),
    topic("actuator_outputs", "uint32_t noutputs;float[16] output;", 100_000, status::actuator_outputs),
    topic(
        "battery_status",
        "float voltage_v;float voltage_filtered_v;float current_a;float discharged_mah;float remaining;float time_remaining_s;bool connected;\
         uint8_t cell_count;",
        500_000,
        status::battery_status,
    ),
    topic("wind", "float windspeed_north;float windspeed_east;", 500_000, status::wind),
    watched(
        "vehicle_status",
        "uint8_t arming_state;uint8_t nav_state;uint8_t vehicle_type;uint8_t system_id;uint8_t component_id;bool failsafe;",
        500_000,
        status::vehicle_status,
    ),
    watched(
        "vehicle_land_detected",
        "bool landed;bool maybe_landed;bool ground_contact;bool freefall;",
        1_000_000,
        status::land_detected,
    ),
    watched(
        "mission_result",
        "uint16_t seq_current;uint16_t seq_total;bool valid;bool finished;",
        1_000_000,
        status::mission_result,
    ),
    watched(
        "home_position",
        "double lat;double lon;float alt;float x;float y;float z;float yaw;bool valid_alt;bool valid_hpos;bool valid_lpos;",
        10_000_000,
        status::home_position,
    ),
    topic(
        "lmpc_status",
        "float[3] tracking_error_m;float yaw_error_rad;float[2] tilt_reference_rad;float thrust_n;float[3] torque_n_m;\
         float[4] rotor_speed_rad_s;float believed_mass_kg;float[3] believed_drag_n_s_m;\
         uint32_t altitude_iterations;uint32_t position_iterations;\
         uint32_t attitude_iterations;uint32_t altitude_active_constraints;uint32_t position_active_constraints;\
         uint32_t attitude_active_constraints;uint8_t altitude_status;uint8_t position_status;uint8_t attitude_status;\
         uint8_t steering;",
        20_000,
        status::lmpc_status,
    ),
];
