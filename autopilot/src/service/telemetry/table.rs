//! The table of telemetry: messages, their rates, groups and makers.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::*;

use super::{
    actuators, attitude, board, estimate, navigation, position, sensors, speed_controllers, status, targets,
    truth, wind,
};
use crate::service::Service;
use crate::stream::{Build, Group, Stream};

/// Messages of the vehicle's state. They need no state of their own.
#[derive(Clone, Copy, Debug)]
pub struct Telemetry;

impl Service for Telemetry {
    fn summary(&self) -> &'static str {
        "Telemetry"
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }
}

/// Rates in Hz on a ground station's link and on an onboard one; 0 is never, unless it is asked for.
const STREAMS: &[Stream] = &[
    Stream::new(SYS_STATUS_DATA::ID, [1.0, 5.0], status::sys_status).of(Group::ExtendedStatus),
    Stream::new(POWER_STATUS_DATA::ID, [0.0, 0.0], board::power_status)
        .of(Group::ExtendedStatus)
        .of_ardupilot(),
    Stream::new(MEMINFO_DATA::ID, [0.0, 0.0], board::memory).of(Group::ExtendedStatus).of_ardupilot(),
    Stream::new(HWSTATUS_DATA::ID, [0.0, 0.0], board::hardware_status).of(Group::Extra3).of_ardupilot(),
    Stream::new(SYSTEM_TIME_DATA::ID, [1.0, 1.0], status::system_time).of(Group::Extra3),
    Stream::new(GPS_RAW_INT_DATA::ID, [1.0, 5.0], sensors::gps_raw_int).of(Group::ExtendedStatus),
    Stream::new(SCALED_IMU_DATA::ID, [0.0, 0.0], sensors::scaled_imu).of(Group::RawSensors),
    Stream::new(RAW_IMU_DATA::ID, [0.0, 0.0], sensors::raw_imu).of(Group::RawSensors),
    Stream::new(SCALED_PRESSURE_DATA::ID, [0.0, 0.0], sensors::scaled_pressure).of(Group::RawSensors),
    Stream::when(SCALED_PRESSURE2_DATA::ID, [0.0, 0.0], Build::Perhaps(sensors::scaled_pressure2))
        .of(Group::RawSensors)
        .of_ardupilot(),
    Stream::when(SCALED_PRESSURE3_DATA::ID, [0.0, 0.0], Build::Perhaps(sensors::scaled_pressure3))
        .of(Group::RawSensors)
        .of_ardupilot(),
    Stream::new(ATTITUDE_DATA::ID, [15.0, 100.0], attitude::attitude).of(Group::Extra1),
    Stream::new(ATTITUDE_QUATERNION_DATA::ID, [15.0, 50.0], attitude::attitude_quaternion).of(Group::Extra1),
    Stream::new(AHRS2_DATA::ID, [0.0, 0.0], attitude::second_attitude).of(Group::Extra1).of_ardupilot(),
    Stream::new(LOCAL_POSITION_NED_DATA::ID, [10.0, 30.0], position::local_position_ned).of(Group::Position),
    Stream::new(GLOBAL_POSITION_INT_DATA::ID, [5.0, 50.0], position::global_position_int).of(Group::Position),
    Stream::new(SERVO_OUTPUT_RAW_DATA::ID, [1.0, 10.0], status::servo_output_raw).of(Group::RcChannels),
    Stream::new(NAV_CONTROLLER_OUTPUT_DATA::ID, [2.0, 10.0], navigation::nav_controller_output)
        .of(Group::ExtendedStatus),
    Stream::new(VFR_HUD_DATA::ID, [4.0, 10.0], position::vfr_hud).of(Group::Extra2),
    Stream::new(ATTITUDE_TARGET_DATA::ID, [2.0, 10.0], targets::attitude_target),
    Stream::when(
        POSITION_TARGET_LOCAL_NED_DATA::ID,
        [2.0, 10.0],
        Build::Perhaps(targets::position_target_local_ned),
    )
    .of(Group::Position),
    Stream::new(POSITION_TARGET_GLOBAL_INT_DATA::ID, [1.0, 10.0], targets::position_target_global_int)
        .of(Group::ExtendedStatus),
    Stream::when(PID_TUNING_DATA::ID, [4.0, 10.0], Build::Several(targets::pid_tuning))
        .of(Group::Extra1)
        .of_ardupilot(),
    Stream::new(HIGHRES_IMU_DATA::ID, [0.0, 50.0], sensors::highres_imu),
    Stream::new(SIM_STATE_DATA::ID, [0.0, 0.0], truth::sim_state),
    Stream::new(SIMSTATE_DATA::ID, [0.0, 0.0], truth::simstate).of(Group::Extra1),
    // As PX4's simulation streams it.
    Stream::new(HIL_STATE_QUATERNION_DATA::ID, [0.0, 25.0], truth::true_state),
    Stream::new(ACTUATOR_OUTPUT_STATUS_DATA::ID, [0.0, 0.0], actuators::actuator_output_status),
    Stream::new(ACTUATOR_CONTROL_TARGET_DATA::ID, [0.0, 0.0], actuators::actuator_control_target),
    Stream::new(ESC_INFO_DATA::ID, [1.0, 10.0], speed_controllers::esc_info),
    Stream::new(ESC_STATUS_DATA::ID, [1.0, 10.0], speed_controllers::esc_status),
    Stream::new(ESC_TELEMETRY_1_TO_4_DATA::ID, [0.0, 0.0], speed_controllers::esc_telemetry)
        .of(Group::Extra3)
        .of_ardupilot(),
    Stream::new(ALTITUDE_DATA::ID, [1.0, 10.0], position::altitude).of(Group::Extra3),
    Stream::new(BATTERY_STATUS_DATA::ID, [0.5, 0.5], status::battery_status).of(Group::Extra3),
    Stream::new(FENCE_STATUS_DATA::ID, [0.5, 1.0], status::fence_status).of(Group::ExtendedStatus),
    Stream::new(ESTIMATOR_STATUS_DATA::ID, [0.5, 1.0], estimate::estimator_status),
    Stream::new(EKF_STATUS_REPORT_DATA::ID, [1.0, 2.0], estimate::ekf_status_report)
        .of(Group::Extra3)
        .of_ardupilot(),
    Stream::new(VIBRATION_DATA::ID, [0.1, 0.5], sensors::vibration).of(Group::Extra3),
    Stream::new(HOME_POSITION_DATA::ID, [0.5, 0.5], position::home_position).of(Group::ExtendedStatus),
    Stream::new(EXTENDED_SYS_STATE_DATA::ID, [1.0, 5.0], status::extended_sys_state)
        .of(Group::ExtendedStatus),
    Stream::new(WIND_COV_DATA::ID, [0.5, 10.0], wind::wind_cov),
    Stream::new(WIND_DATA::ID, [0.0, 0.0], wind::wind).of(Group::Extra3).of_ardupilot(),
    Stream::new(ODOMETRY_DATA::ID, [0.0, 30.0], position::odometry),
];
