//! Telemetry: every message that is sent regularly or asked for, made of the state of now.

mod attitude;
mod estimate;
mod navigation;
mod position;
mod sensors;
mod status;
mod targets;
mod truth;

use mavlink::dialects::common::MavMessage;

use crate::autopilot::Autopilot;
use crate::service::{
    component_metadata, heartbeat, identification, mission, standard_mode, time_synchronization,
};

/// A message by its id; `None` if there is none.
pub fn message(autopilot: &Autopilot, message_id: u32) -> Option<MavMessage> {
    let vehicle = &autopilot.vehicle;
    Some(match message_id {
        0 => heartbeat::message(vehicle),
        1 => status::sys_status(vehicle),
        2 => status::system_time(vehicle, autopilot.unix_start_us()),
        24 => sensors::gps_raw_int(vehicle),
        26 => sensors::scaled_imu(vehicle),
        27 => sensors::raw_imu(vehicle),
        29 => sensors::scaled_pressure(vehicle),
        30 => attitude::attitude(vehicle),
        31 => attitude::attitude_quaternion(vehicle),
        32 => position::local_position_ned(vehicle),
        33 => position::global_position_int(vehicle),
        36 => status::servo_output_raw(vehicle),
        42 => mission::current(vehicle),
        49 => position::gps_global_origin(vehicle),
        62 => navigation::nav_controller_output(vehicle),
        74 => position::vfr_hud(vehicle),
        83 => targets::attitude_target(vehicle),
        85 => targets::position_target_local_ned(vehicle),
        87 => targets::position_target_global_int(vehicle),
        105 => sensors::highres_imu(vehicle),
        108 => truth::sim_state(vehicle),
        111 => time_synchronization::request(autopilot),
        141 => position::altitude(vehicle),
        147 => status::battery_status(vehicle),
        162 => status::fence_status(vehicle),
        148 => identification::autopilot_version(vehicle.identity(), autopilot.system_id()),
        230 => estimate::estimator_status(vehicle),
        241 => sensors::vibration(vehicle),
        242 => position::home_position(vehicle),
        245 => status::extended_sys_state(vehicle),
        300 => identification::protocol_version(),
        331 => position::odometry(vehicle),
        397 => component_metadata::message(autopilot),
        436 => standard_mode::current(vehicle),
        _ => return None,
    })
}

/// Milliseconds of simulation time since the start.
fn boot_ms(time_us: u64) -> u32 {
    (time_us / 1000) as u32
}
