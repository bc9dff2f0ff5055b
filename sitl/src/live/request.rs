//! What a pilot asks for, as the messages that a ground station would send.

use autopilot::codec::command_long;
use autopilot::{Autopilot, COMPONENT};
use mavlink::dialects::ardupilotmega::{
    COMMAND_INT_DATA, MavCmd, MavFrame, MavMessage, MavParamType, PARAM_SET_DATA,
};
use nalgebra::Vector3;
use vehicle::Mode;
use vehicle::fault::Fault;
use vehicle::parameters::SPEED_PARAMETER;
use viewer::Action;

/// Farthest place that the page sends a vehicle to, m.
const FARTHEST_M: f64 = 100_000.0;
/// What is left to the vehicle.
const OPEN: f32 = f32::NAN;

/// Messages that are sent one after the other, until one is refused.
#[derive(Debug)]
pub struct Request {
    /// The messages.
    pub messages: Vec<MavMessage>,
}

impl Request {
    /// What is asked of a vehicle.
    ///
    /// # Errors
    /// What of it makes no sense, and what would.
    pub fn of(action: &Action, autopilot: &Autopilot) -> Result<Self, String> {
        let system = autopilot.system_id();
        let long = |command, parameters| to_autopilot(system, command, parameters);
        let simple = |command| vec![long(command, [0.0; 7])];
        let messages = match action {
            Action::Arm {} => vec![arm(system, true)],
            Action::Disarm {} => vec![arm(system, false)],
            Action::TakeOff { height_m } => {
                take_off(within(*height_m, 0.5, 1000.0, "height", "m")?, autopilot)
            }
            Action::Land {} => simple(MavCmd::MAV_CMD_NAV_LAND),
            Action::Return {} => simple(MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH),
            Action::Hold {} => simple(MavCmd::MAV_CMD_NAV_LOITER_UNLIM),
            Action::StartMission {} => start_mission(autopilot),
            Action::FlyTo { place_m, height_m } => vec![fly_to(*place_m, *height_m, autopilot)?],
            Action::Fault { fault } => {
                let fault: Fault = fault.parse().map_err(|error| format!("{error}"))?;
                let [unit, kind, instance] = fault.numbers().map(|number| number as f32);
                vec![
                    parameter(system, "SYS_FAILURE_EN", 1.0),
                    long(MavCmd::MAV_CMD_INJECT_FAILURE, [unit, kind, instance, 0.0, 0.0, 0.0, 0.0]),
                ]
            }
            Action::Wind { speed_m_s, from_deg } => wind(*speed_m_s, *from_deg, autopilot)?,
            Action::Speed { factor } => vec![parameter(system, SPEED_PARAMETER, *factor)],
            // Clocks know of it, vehicles do not.
            Action::Step { .. } => Vec::new(),
        };
        Ok(Self { messages })
    }
}

fn within(value: f64, least: f64, most: f64, what: &str, unit: &str) -> Result<f64, String> {
    let is_fine = (least..=most).contains(&value);
    if is_fine { Ok(value) } else { Err(format!("{what} {value} {unit}; use {least} to {most} {unit}")) }
}

fn wind(speed_m_s: f64, from_deg: f64, autopilot: &Autopilot) -> Result<Vec<MavMessage>, String> {
    let system = autopilot.system_id();
    let from_deg = within(from_deg, -360.0, 360.0, "direction", "degrees")?;
    let speed_m_s = within(speed_m_s, 0.0, 50.0, "wind", "m/s")?;
    Ok(vec![parameter(system, "SIM_WIND_DIR", from_deg), parameter(system, "SIM_WIND_SPD", speed_m_s)])
}

/// PX4 is told how high above sea level and may be armed afterwards, ArduPilot how high above home and is armed before.
fn take_off(height_m: f64, autopilot: &Autopilot) -> Vec<MavMessage> {
    let vehicle = autopilot.vehicle();
    let system = autopilot.system_id();
    let takeoff = |altitude_m: f64| {
        let parameters = [0.0, 0.0, 0.0, OPEN, OPEN, OPEN, altitude_m as f32];
        to_autopilot(system, MavCmd::MAV_CMD_NAV_TAKEOFF, parameters)
    };
    if autopilot.identity().is_ardupilot() {
        return vec![guided(autopilot), arm(system, true), takeoff(height_m)];
    }
    let place = vehicle.frame().to_geodetic(&(vehicle.home().position_m - Vector3::z() * height_m));
    let mut messages = vec![takeoff(place.altitude_m)];
    if !vehicle.is_armed() {
        messages.push(arm(system, true));
    }
    messages
}

fn start_mission(autopilot: &Autopilot) -> Vec<MavMessage> {
    let system = autopilot.system_id();
    let start = to_autopilot(system, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]);
    if autopilot.vehicle().is_armed() {
        return vec![start];
    }
    // ArduPilot arms in another mode than that of the mission.
    let guided = autopilot.identity().is_ardupilot() && autopilot.vehicle().mode() == Mode::Mission;
    let custom = autopilot.identity().custom_mode(Mode::Offboard) as f32;
    let mode = to_autopilot(system, MavCmd::MAV_CMD_DO_SET_MODE, [1.0, custom, 0.0, 0.0, 0.0, 0.0, 0.0]);
    guided.then_some(mode).into_iter().chain([arm(system, true), start]).collect()
}

fn fly_to(place_m: [f64; 2], height_m: f64, autopilot: &Autopilot) -> Result<MavMessage, String> {
    for metres in place_m {
        within(metres, -FARTHEST_M, FARTHEST_M, "place", "m")?;
    }
    within(height_m, -FARTHEST_M, FARTHEST_M, "height", "m")?;
    let vehicle = autopilot.vehicle();
    let [north_m, east_m] = place_m;
    let place = vehicle.frame().to_geodetic(&Vector3::new(
        north_m,
        east_m,
        vehicle.terrain().z_m(place_m) - height_m,
    ));
    let degrees = |degrees: f64| (degrees * 1e7).round() as i32;
    // MAV_DO_REPOSITION_FLAGS_CHANGE_MODE: whatever it does now.
    Ok(MavMessage::COMMAND_INT(COMMAND_INT_DATA {
        param1: -1.0,
        param2: 1.0,
        param3: 0.0,
        param4: OPEN,
        x: degrees(place.latitude_deg),
        y: degrees(place.longitude_deg),
        z: place.altitude_m as f32,
        command: MavCmd::MAV_CMD_DO_REPOSITION,
        target_system: autopilot.system_id(),
        target_component: COMPONENT,
        frame: MavFrame::MAV_FRAME_GLOBAL,
        current: 0,
        autocontinue: 0,
    }))
}

/// ArduPilot takes off in its guided mode.
fn guided(autopilot: &Autopilot) -> MavMessage {
    let mode = autopilot.identity().custom_mode(Mode::Offboard) as f32;
    to_autopilot(autopilot.system_id(), MavCmd::MAV_CMD_DO_SET_MODE, [1.0, mode, 0.0, 0.0, 0.0, 0.0, 0.0])
}

fn arm(system: u8, on: bool) -> MavMessage {
    let parameters = [f32::from(u8::from(on)), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    to_autopilot(system, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, parameters)
}

fn to_autopilot(system: u8, command: MavCmd, parameters: [f32; 7]) -> MavMessage {
    MavMessage::COMMAND_LONG(command_long((system, COMPONENT), command, parameters))
}

/// Only real parameters: both autopilots write their values alike.
fn parameter(system: u8, name: &str, value: f64) -> MavMessage {
    MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value: value as f32,
        target_system: system,
        target_component: COMPONENT,
        param_id: name.into(),
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
    })
}
