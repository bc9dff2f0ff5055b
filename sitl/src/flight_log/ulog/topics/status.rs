//! Actuators, battery, wind, and what the vehicle is about.

use quadrotor::ControllerActivity;
use vehicle::{LandedState, MissionState, Mode};

use super::super::row::Row;
use crate::flight_log::LogSource;

/// Shares of the thrust. NaN where there is no rotor.
pub fn actuator_motors(source: &LogSource<'_>, row: &mut Row) {
    row.reals(source.motor_shares()).floats([f32::NAN; 8]);
}

/// As pulses, µs.
pub fn actuator_outputs(source: &LogSource<'_>, row: &mut Row) {
    let pulses = source.pulses_us();
    row.u32(pulses.len() as u32).reals(pulses).floats([0.0; 12]);
}

pub fn battery_status(source: &LogSource<'_>, row: &mut Row) {
    let vehicle = source.vehicle;
    let battery = vehicle.battery();
    let capacity_ah = vehicle.battery_capacity_ah();
    // Its model has no noise to be filtered; readers that ask for both show neither without.
    row.reals([battery.voltage_v(), battery.voltage_v(), battery.current_a(), battery.drawn_ah() * 1e3]);
    row.reals([vehicle.battery_remaining(), battery.time_remaining_s(capacity_ah)]);
    row.bool(true).u8(battery.cells());
}

pub fn wind(source: &LogSource<'_>, row: &mut Row) {
    let wind = source.vehicle.wind_m_s();
    row.reals([wind.x, wind.y]);
}

pub fn vehicle_status(source: &LogSource<'_>, row: &mut Row) {
    const DISARMED: u8 = 1;
    const ARMED: u8 = 2;
    const ROTARY_WING: u8 = 1;
    let vehicle = source.vehicle;
    row.u8(if vehicle.is_armed() { ARMED } else { DISARMED });
    row.u8(nav_state(vehicle.mode())).u8(ROTARY_WING);
    row.u8(source.system_id).u8(source.component_id);
    row.bool(vehicle.failsafe().engaged().is_some());
}

/// PX4's `nav_state` of a mode.
fn nav_state(mode: Mode) -> u8 {
    match mode {
        Mode::Stabilize => 15,
        Mode::Manual => 0,
        Mode::Altitude => 1,
        Mode::Acro => 10,
        Mode::Position | Mode::PositionHold | Mode::ZigZag => 2,
        Mode::Mission | Mode::MissionLanding => 3,
        Mode::Hold => 4,
        Mode::Return => 5,
        Mode::Offboard => 14,
        Mode::Takeoff => 17,
        Mode::Land => 18,
        Mode::Follow => 19,
        Mode::Orbit => 21,
        // PX4 has no such modes; the nearest ones.
        Mode::SmartReturn => 5,
        Mode::Throw => 4,
        Mode::Flip => 10,
        Mode::GuidedAttitude => 14,
    }
}

pub fn land_detected(source: &LogSource<'_>, row: &mut Row) {
    let landed = source.vehicle.landed_state() == LandedState::OnGround;
    row.bool(landed).bool(landed).bool(landed).bool(false);
}

pub fn mission_result(source: &LogSource<'_>, row: &mut Row) {
    let status = source.vehicle.mission_status();
    let sequence = |number: usize| u16::try_from(number).unwrap_or(u16::MAX);
    row.u16(sequence(status.current)).u16(sequence(status.total));
    row.bool(status.state != MissionState::None).bool(status.state == MissionState::Complete);
}

pub fn home_position(source: &LogSource<'_>, row: &mut Row) {
    let vehicle = source.vehicle;
    let home = vehicle.home();
    let place = vehicle.frame().to_geodetic(&home.position_m);
    row.f64(place.latitude_deg).f64(place.longitude_deg).f32(place.altitude_m as f32);
    row.reals(home.position_m.data.0[0]).reals([home.yaw_rad]).bool(true).bool(true).bool(true);
}

/// A status counts optimal, relaxed, at the iteration limit, held; steering counts idle, position, attitude.
pub fn lmpc_status(source: &LogSource<'_>, row: &mut Row) {
    let vehicle = source.vehicle;
    let outputs = vehicle.outputs();
    row.reals(outputs.tracking_error_m.data.0[0]).reals([outputs.yaw_error_rad]);
    row.reals(outputs.tilt_reference_rad).reals([outputs.thrust_n]).reals(outputs.torque_n_m.data.0[0]);
    row.reals(outputs.rotor_speed_rad_s);
    row.reals([outputs.belief.mass_kg]).reals(outputs.belief.drag_n_s_m.data.0[0]);
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
}
