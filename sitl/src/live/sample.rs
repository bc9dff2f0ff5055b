//! A vehicle as a frame has it.

use autopilot::Autopilot;
use quadrotor::{Activity, ControllerActivity};
use vehicle::{LandedState, SteeringKind};
use viewer::{Solver, VehicleState};

use crate::flight_log::LogSource;

/// How a vehicle is now, in truth: what it believes is in its logs. Lost is one whose simulation has ended.
pub fn sample(autopilot: &Autopilot, lost: bool) -> VehicleState {
    let vehicle = autopilot.vehicle();
    let truth = vehicle.truth();
    let source = LogSource::of(autopilot);
    let setpoint = &truth.setpoint;
    // Controllers rest while it is disarmed: what they show is of the last flight.
    let activity = if vehicle.is_armed() { truth.activity } else { Activity::default() };
    VehicleState {
        id: autopilot.system_id(),
        armed: vehicle.is_armed(),
        landed: vehicle.landed_state() == LandedState::OnGround,
        lost,
        failsafe: vehicle.failsafe().engaged().is_some(),
        crashed: vehicle.has_crashed(),
        tracks: vehicle.steering_kind() == SteeringKind::Position,
        solvers: [&activity.altitude, &activity.position, &activity.attitude].map(solver),
        item: u16::try_from(vehicle.mission_status().current).unwrap_or(u16::MAX),
        position_m: truth.position_m.into(),
        velocity_m_s: truth.velocity_m_s.into(),
        quaternion: truth.quaternion,
        body_rate_rad_s: truth.body_rate_rad_s.into(),
        setpoint_m: setpoint.position_m.into(),
        setpoint_yaw_rad: setpoint.yaw_rad,
        thrust_n: truth.thrust_n,
        strongest_n: source.strongest_n(),
        rotors: source.motor_shares(),
        battery: vehicle.battery_remaining(),
        voltage_v: vehicle.battery().voltage_v(),
        tilt_reference_rad: truth.tilt_reference_rad,
        wind_m_s: vehicle.wind_m_s().into(),
    }
}

fn solver(activity: &ControllerActivity) -> Solver {
    Solver {
        status: activity.status.severity(),
        active: u8::try_from(activity.active).unwrap_or(u8::MAX),
        iterations: u16::try_from(activity.iterations).unwrap_or(u16::MAX),
    }
}
