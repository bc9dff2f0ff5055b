//! Commands that do something.

use nalgebra::Vector3;
use vehicle::fault::Fault;
use vehicle::plan::{self, ChangeSpeed, FaultCode, MissionItem, PlanKind, compile};
use vehicle::world::Geodetic;
use vehicle::{Mode, Refusal, Reposition, Severity, Vehicle};

use super::{Outcome, global_frame, told_frame};
use crate::autopilot::Autopilot;
use crate::codec::Command;
use crate::service::{Origin, message_interval, mission, parameter, standard_mode, status_text};

/// MAV_CMD.
mod number {
    pub const NAV_RETURN_TO_LAUNCH: u16 = 20;
    pub const NAV_LAND: u16 = 21;
    pub const NAV_TAKEOFF: u16 = 22;
    pub const NAV_GUIDED_ENABLE: u16 = 92;
    pub const CONDITION_YAW: u16 = 115;
    pub const DO_SET_MODE: u16 = 176;
    pub const DO_CHANGE_SPEED: u16 = 178;
    pub const DO_SET_HOME: u16 = 179;
    pub const DO_FLIGHTTERMINATION: u16 = 185;
    pub const DO_REPOSITION: u16 = 192;
    pub const DO_PAUSE_CONTINUE: u16 = 193;
    pub const DO_SET_ROI_LOCATION: u16 = 195;
    pub const DO_SET_ROI_WPNEXT_OFFSET: u16 = 196;
    pub const DO_SET_ROI_NONE: u16 = 197;
    pub const DO_SET_ROI: u16 = 201;
    pub const DO_FENCE_ENABLE: u16 = 207;
    pub const DO_SET_MISSION_CURRENT: u16 = 224;
    pub const PREFLIGHT_STORAGE: u16 = 245;
    pub const DO_SET_STANDARD_MODE: u16 = 262;
    pub const MISSION_START: u16 = 300;
    pub const COMPONENT_ARM_DISARM: u16 = 400;
    pub const RUN_PREARM_CHECKS: u16 = 401;
    pub const INJECT_FAILURE: u16 = 420;
    pub const SET_MESSAGE_INTERVAL: u16 = 511;
}

/// The number that arms or disarms whatever speaks against it.
const FORCE: f64 = 21196.0;

/// Carries a command out.
pub fn handle(autopilot: &mut Autopilot, origin: &Origin, command: &Command) -> Outcome {
    let vehicle = &mut autopilot.vehicle;
    Some(match command.number {
        number::NAV_RETURN_TO_LAUNCH => vehicle.set_mode(Mode::Return),
        number::NAV_LAND => vehicle.set_mode(Mode::Land),
        number::NAV_TAKEOFF => take_off(autopilot, command),
        number::NAV_GUIDED_ENABLE if command.parameter(1) > 0.5 => vehicle.set_mode(Mode::Offboard),
        number::NAV_GUIDED_ENABLE => vehicle.set_mode(Mode::Hold),
        number::CONDITION_YAW => turn(vehicle, command),
        number::DO_SET_MODE => set_mode(autopilot, command),
        number::DO_CHANGE_SPEED => change_speed(vehicle, command.parameter(1), command.parameter(2)),
        number::DO_SET_HOME => set_home(vehicle, command),
        number::DO_FLIGHTTERMINATION if command.parameter(1) > 0.5 => {
            vehicle.terminate();
            Ok(())
        }
        number::DO_FLIGHTTERMINATION => Ok(()),
        number::DO_REPOSITION => reposition(autopilot, command),
        number::DO_SET_ROI_LOCATION
        | number::DO_SET_ROI_WPNEXT_OFFSET
        | number::DO_SET_ROI_NONE
        | number::DO_SET_ROI => look(vehicle, command),
        number::DO_FENCE_ENABLE => enable_fence(autopilot, command),
        number::DO_PAUSE_CONTINUE if command.parameter(1) == 0.0 => vehicle.pause(),
        number::DO_PAUSE_CONTINUE => vehicle.continue_mission(),
        number::DO_SET_MISSION_CURRENT => mission::set_current_by_command(autopilot, command),
        number::MISSION_START => mission::start(autopilot, command),
        number::PREFLIGHT_STORAGE => storage(autopilot, command),
        number::DO_SET_STANDARD_MODE => match command.whole(1).and_then(standard_mode::mode) {
            Some(mode) => vehicle.set_mode(mode),
            None => Err(Refusal::denied(format!("No standard mode {}", command.parameter(1)))),
        },
        number::COMPONENT_ARM_DISARM => arm(vehicle, command),
        number::RUN_PREARM_CHECKS => {
            check(autopilot);
            Ok(())
        }
        number::INJECT_FAILURE => inject_failure(vehicle, command),
        number::SET_MESSAGE_INTERVAL => set_interval(autopilot, origin, command),
        _ => return None,
    })
}

fn arm(vehicle: &mut Vehicle, command: &Command) -> Result<(), Refusal> {
    let force = command.parameter(2) == FORCE;
    match command.parameter(1) {
        1.0 => vehicle.arm(force),
        0.0 => vehicle.disarm(force),
        other => Err(Refusal::denied(format!("{other} neither arms (1) nor disarms (0)"))),
    }
}

fn enable_fence(autopilot: &mut Autopilot, command: &Command) -> Result<(), Refusal> {
    let vehicle = &mut autopilot.vehicle;
    match command.parameter(1) {
        0.0 => vehicle.enable_fence(false),
        1.0 => vehicle.enable_fence(true),
        other => {
            return Err(Refusal::denied(format!("{other} neither enables (1) nor disables (0) the fence")));
        }
    }
    parameter::tell(autopilot, "FENCE_ENABLE");
    Ok(())
}

/// Tells what speaks against arming.
fn check(autopilot: &mut Autopilot) {
    let obstacles = autopilot.vehicle.arming_obstacles();
    if obstacles.is_empty() {
        status_text::send(autopilot, Severity::Info, "Ready to arm");
    }
    for obstacle in obstacles {
        status_text::send(autopilot, Severity::Warning, &format!("Preflight: {obstacle}"));
    }
}

/// PX4's altitude is above sea level, ArduPilot's above home; NaN stands for the parameter.
fn take_off(autopilot: &mut Autopilot, command: &Command) -> Result<(), Refusal> {
    let vehicle = &mut autopilot.vehicle;
    if command.z.is_nan() {
        return vehicle.take_off(None);
    }
    if vehicle.identity().is_ardupilot() {
        return vehicle.take_off(Some(command.z));
    }
    let down_m = vehicle.site().down_m(global_frame(command)?, command.z);
    let height_m = vehicle.home().position_m.z - down_m;
    // PX4 takes an altitude below the ground for one above home of its parameter.
    const LEAST_M: f64 = 0.5;
    if height_m < LEAST_M {
        let text = format!("Takeoff altitude {:.1} m is not above home: using the parameter", command.z);
        status_text::send(autopilot, Severity::Warning, &text);
        return autopilot.vehicle.take_off(None);
    }
    vehicle.take_off(Some(height_m))
}

/// To an angle, degrees, from north or (parameter 4) from the present heading, in a direction if there is one.
fn turn(vehicle: &mut Vehicle, command: &Command) -> Result<(), Refusal> {
    let angle_rad = command.parameter(1).to_radians();
    if !angle_rad.is_finite() {
        return Err(Refusal::denied("CONDITION_YAW needs an angle"));
    }
    let direction = if command.parameter(3) < 0.0 { -1.0 } else { 1.0 };
    let relative = command.parameter(4) == 1.0;
    let goal = if relative { vehicle.outputs().attitude_rad.z + direction * angle_rad } else { angle_rad };
    vehicle.turn_to(goal)
}

fn set_mode(autopilot: &mut Autopilot, command: &Command) -> Result<(), Refusal> {
    const CUSTOM_MODE_ENABLED: u32 = 1;
    let (base, main, sub) = (command.whole(1), command.whole(2), command.whole(3).unwrap_or(0));
    let (Some(base), Some(main)) = (base, main) else {
        return Err(Refusal::denied("DO_SET_MODE needs a mode"));
    };
    if base & CUSTOM_MODE_ENABLED == 0 {
        return Err(Refusal::Unsupported("Only custom modes are supported".to_owned()));
    }
    let custom_mode = if autopilot.identity().is_ardupilot() {
        main
    } else if main <= 0xff && sub <= 0xff {
        main << 16 | sub << 24
    } else {
        return Err(Refusal::denied(format!("No mode {main}, {sub}")));
    };
    set_custom_mode(autopilot, custom_mode)
}

/// Changes to a mode by its number in HEARTBEAT.
pub fn set_custom_mode(autopilot: &mut Autopilot, custom_mode: u32) -> Result<(), Refusal> {
    let identity = autopilot.identity();
    let Some(mode) = identity.mode(custom_mode) else {
        let names: Vec<_> =
            identity.selectable_modes().iter().map(|known| identity.mode_name(*known)).collect();
        // PX4's main and sub-modes are bytes of the number.
        let number =
            if identity.is_ardupilot() { custom_mode.to_string() } else { format!("{custom_mode:#x}") };
        let there_are = names.join(", ");
        return Err(Refusal::Unsupported(format!("Mode {number} is not available, only {there_are}")));
    };
    autopilot.vehicle.set_mode(mode)
}

fn place(command: &Command, vehicle: &Vehicle) -> Result<Vector3<f64>, Refusal> {
    let altitude_m = vehicle.frame().origin().altitude_m;
    let place = Geodetic { latitude_deg: command.x, longitude_deg: command.y, altitude_m };
    if !place.is_valid() {
        return Err(Refusal::denied(format!("No place at latitude {}, longitude {}", command.x, command.y)));
    }
    Ok(vehicle.frame().to_local_m(&place))
}

fn set_home(vehicle: &mut Vehicle, command: &Command) -> Result<(), Refusal> {
    if command.parameter(1) == 1.0 {
        return vehicle.set_home(vehicle.outputs().position_m, None);
    }
    let frame = global_frame(command)?;
    let mut position_m = place(command, vehicle)?;
    if !command.z.is_finite() {
        return Err(Refusal::denied("Home needs an altitude"));
    }
    position_m.z = vehicle.site().down_m(frame, command.z);
    let yaw_rad = Some(command.parameter(4).to_radians()).filter(|yaw| yaw.is_finite());
    vehicle.set_home(position_m, yaw_rad)
}

/// NaN keeps what it stands for; nothing but NaN is a pause.
fn reposition(autopilot: &mut Autopilot, command: &Command) -> Result<(), Refusal> {
    let vehicle = &autopilot.vehicle;
    // Without a place it has no frame.
    let nowhere = command.x.is_nan() && command.y.is_nan() && !command.z.is_finite();
    let frame = if nowhere { plan::frame::GLOBAL } else { global_frame(command)? };
    let horizontal_m = if command.x.is_nan() && command.y.is_nan() {
        None
    } else {
        let position_m = place(command, vehicle)?;
        Some([position_m.x, position_m.y])
    };
    let down_m = Some(command.z)
        .filter(|altitude| altitude.is_finite())
        .map(|altitude| vehicle.site().down_m(frame, altitude));
    let yaw_rad = Some(command.parameter(4)).filter(|yaw| yaw.is_finite());
    autopilot.vehicle.reposition(&Reposition { horizontal_m, down_m, yaw_rad })?;
    let speed_m_s = command.parameter(1);
    if speed_m_s > 0.0 { change_speed(&mut autopilot.vehicle, 1.0, speed_m_s) } else { Ok(()) }
}

/// SPEED_TYPE, and a speed.
fn change_speed(vehicle: &mut Vehicle, kind: f64, speed_m_s: f64) -> Result<(), Refusal> {
    let change = ChangeSpeed::of(kind, speed_m_s)
        .ok_or_else(|| Refusal::denied(format!("No speed of type {kind}")))?;
    vehicle.change_speed(&change)
}

/// DO_SET_ROI and its successors.
fn look(vehicle: &mut Vehicle, command: &Command) -> Result<(), Refusal> {
    let items = vehicle.plans().get(PlanKind::Mission).items();
    let look =
        compile::look(&as_item(command), items, &vehicle.site()).map_err(|fault| match fault.code {
            FaultCode::Unsupported => Refusal::Unsupported(fault.reason),
            FaultCode::UnsupportedFrame => Refusal::UnsupportedFrame(fault.reason),
            _ => Refusal::denied(format!("Region of interest: {}", fault.reason)),
        })?;
    vehicle.look(look.as_ref());
    Ok(())
}

/// The same as an item of a mission.
fn as_item(command: &Command) -> MissionItem {
    MissionItem {
        frame: told_frame(command),
        command: command.number,
        parameters: command.parameters,
        position: [command.x, command.y, command.z],
        autocontinue: true,
    }
}

/// 0 reads, 1 writes, 2 resets the parameters.
fn storage(autopilot: &mut Autopilot, command: &Command) -> Result<(), Refusal> {
    match command.parameter(1) {
        // They are read at the start, and always written when one changes.
        0.0 | 1.0 => Ok(()),
        2.0 => autopilot.reset_parameters(),
        other => Err(Refusal::denied(format!("Parameter storage has no action {other}"))),
    }
}

/// FAILURE_UNIT, FAILURE_TYPE, instance.
fn inject_failure(vehicle: &mut Vehicle, command: &Command) -> Result<(), Refusal> {
    // Nothing may be named instead of every instance.
    let instance = if command.parameter(3).is_nan() { Some(0) } else { command.whole(3) };
    let (Some(unit), Some(kind), Some(instance)) = (command.whole(1), command.whole(2), instance) else {
        return Err(Refusal::denied("INJECT_FAILURE needs a unit, a failure type and an instance"));
    };
    let fault = Fault::of_numbers(unit, kind, instance)
        .map_err(|error| Refusal::Unsupported(format!("Failure injection: {error}")))?;
    vehicle.inject(&fault)
}

fn set_interval(autopilot: &mut Autopilot, origin: &Origin, command: &Command) -> Result<(), Refusal> {
    let Some(message_id) = command.whole(1) else { return Err(Refusal::denied("A message has a number")) };
    if message_interval::set(autopilot, origin, message_id, command.parameter(2)) {
        Ok(())
    } else {
        Err(Refusal::Unsupported(format!("There is no message {message_id} to be streamed")))
    }
}
