//! Commands that make the vehicle do something at once.

use mavlink::dialects::ardupilotmega::{MavCmd, MavProtocolCapability};
use vehicle::fault::Fault;
use vehicle::fence::FenceSwitch;
use vehicle::identity::Identity;
use vehicle::plan::{self, ChangeSpeed, FaultCode, MissionItem, PlanKind, compile};
use vehicle::{Mode, Refusal, Reposition, Severity, Vehicle};

use super::command::{as_told_by, global_frame, told_frame, told_place};
use super::{CommandEntry, Outcome, Progress, Service, parameter};
use crate::codec::{Command, CommandKind, command_name};
use crate::context::Context;
use crate::envelope::Origin;

/// How a command is carried out.
type CarryOut = fn(&mut Context, &Command) -> Result<(), Refusal>;

/// Commands, and how they are carried out.
const ACTIONS: [(MavCmd, CarryOut); 20] = [
    (MavCmd::MAV_CMD_NAV_LOITER_UNLIM, loiter),
    (MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH, |context, _| context.vehicle.set_mode(Mode::Return)),
    (MavCmd::MAV_CMD_NAV_LAND, land),
    (MavCmd::MAV_CMD_NAV_VTOL_LAND, land),
    (MavCmd::MAV_CMD_NAV_TAKEOFF, take_off),
    (MavCmd::MAV_CMD_CONDITION_YAW, turn),
    (MavCmd::MAV_CMD_DO_CHANGE_SPEED, change_speed),
    (MavCmd::MAV_CMD_DO_SET_HOME, set_home),
    (MavCmd::MAV_CMD_DO_FLIGHTTERMINATION, terminate),
    (MavCmd::MAV_CMD_DO_REPOSITION, reposition),
    (MavCmd::MAV_CMD_DO_CHANGE_ALTITUDE, change_altitude),
    (MavCmd::MAV_CMD_DO_SET_ROI_LOCATION, look),
    (MavCmd::MAV_CMD_DO_SET_ROI_WPNEXT_OFFSET, look),
    (MavCmd::MAV_CMD_DO_SET_ROI_NONE, look),
    (MavCmd::MAV_CMD_DO_SET_ROI, look),
    (MavCmd::MAV_CMD_DO_FENCE_ENABLE, switch_fence),
    (MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, pause),
    (MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm),
    (MavCmd::MAV_CMD_INJECT_FAILURE, inject_failure),
    (MavCmd::MAV_CMD_BATTERY_RESET, reset_battery),
];

const COMMANDS: [CommandEntry; ACTIONS.len()] = {
    let mut commands = [CommandEntry::action(0); ACTIONS.len()];
    let mut index = 0;
    while index < ACTIONS.len() {
        commands[index] = CommandEntry::action(ACTIONS[index].0 as u16);
        index += 1;
    }
    commands
};

/// The number that arms or disarms whatever speaks against it, and another one of ArduPilot's that only arms.
const FORCE: f64 = 21196.0;
const FORCE_ARMING: f64 = 2989.0;

/// Hands commands on to the vehicle.
#[derive(Clone, Copy, Debug)]
pub struct Actions;

impl Service for Actions {
    fn summary(&self) -> &'static str {
        "What the vehicle does at once"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        &COMMANDS
    }

    fn capabilities(&self, _identity: Identity) -> MavProtocolCapability {
        MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_FLIGHT_TERMINATION
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        let action = ACTIONS.into_iter().find(|(number, _)| *number as u16 == command.number);
        let unknown = || Refusal::Unsupported(format!("Command {} is not supported", command.number));
        let (_, carry_out) = action.ok_or_else(unknown)?;
        let identity = context.identity();
        carry_out(context, command).map_err(|refusal| as_told_by(identity, refusal))?;
        Ok(Progress::Done)
    }
}

/// Holds where it is: ArduPilot in its loiter mode.
fn loiter(context: &mut Context, _command: &Command) -> Result<(), Refusal> {
    let mode = if context.identity().is_ardupilot() { Mode::Position } else { Mode::Hold };
    context.vehicle.set_mode(mode)
}

/// Lands where it is: what a vehicle with wings would land as, too.
fn land(context: &mut Context, _command: &Command) -> Result<(), Refusal> {
    context.vehicle.set_mode(Mode::Land)
}

/// ArduPilot takes no speed that is not above zero; PX4 returns to the parameter's by it, and −1 keeps what there is.
fn change_speed(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    const KEEP: f64 = -1.0;
    const BY_PARAMETER: f64 = -2.0;
    let (kind, speed_m_s) = (command.parameter(1), command.parameter(2));
    if speed_m_s > 0.0 || speed_m_s == KEEP && !context.identity().is_ardupilot() {
        return use_speed(&mut context.vehicle, kind, speed_m_s);
    }
    if context.identity().is_ardupilot() {
        return Err(Refusal::denied(format!("Speed {speed_m_s} m/s rejected: it must be above 0")));
    }
    use_speed(&mut context.vehicle, kind, BY_PARAMETER)
}

/// SPEED_TYPE, and a speed.
fn use_speed(vehicle: &mut Vehicle, kind: f64, speed_m_s: f64) -> Result<(), Refusal> {
    let change = ChangeSpeed::of(kind, speed_m_s)
        .ok_or_else(|| Refusal::denied(format!("Unknown speed type {kind}")))?;
    vehicle.change_speed(&change)
}

fn terminate(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    if command.parameter(1) > 0.5 {
        context.vehicle.terminate();
    }
    Ok(())
}

fn pause(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let vehicle = &mut context.vehicle;
    match command.parameter(1) {
        0.0 => vehicle.pause(),
        1.0 => vehicle.continue_mission(),
        other => Err(Refusal::denied(format!("Invalid value {other}: 0 pauses, 1 continues"))),
    }
}

/// A command as an item of a mission.
fn item_of(command: &Command, frame: u8) -> MissionItem {
    MissionItem {
        frame,
        command: command.number,
        parameters: command.parameters,
        position: [command.x, command.y, command.z],
        autocontinue: true,
    }
}

/// The same as an item of a mission.
fn look(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let vehicle = &mut context.vehicle;
    // A COMMAND_LONG has no frame: ArduPilot means it above home. PX4 means altitudes above sea level whatever the frame says, and MAVSDK
    // sends them so in a frame that is relative.
    let frame = match (vehicle.identity(), &command.kind) {
        (Identity::ArduPilot, CommandKind::Long { .. }) => plan::frame::GLOBAL_RELATIVE,
        (Identity::Px4, _) if global_frame(command).is_ok() => plan::frame::GLOBAL,
        _ => told_frame(command),
    };
    // ArduPilot looks ahead again when it is told to look at zero, zero and zero.
    let at_place = command.number == MavCmd::MAV_CMD_DO_SET_ROI_LOCATION as u16;
    if at_place && vehicle.identity().is_ardupilot() && [command.x, command.y, command.z] == [0.0; 3] {
        vehicle.look(None);
        return Ok(());
    }
    let item = item_of(command, frame);
    let items = vehicle.plans().get(PlanKind::Mission).items();
    let look = compile::look(&item, items, &vehicle.site()).map_err(|fault| match fault.code {
        FaultCode::Unsupported => {
            Refusal::Unsupported(format!("{}: {}", command_name(command.number), fault.reason))
        }
        FaultCode::UnsupportedFrame => Refusal::UnsupportedFrame(fault.reason),
        _ => Refusal::denied(format!("Region of interest: {}", fault.reason)),
    })?;
    vehicle.look(look.as_ref());
    Ok(())
}

fn arm(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let vehicle = &mut context.vehicle;
    let force = command.parameter(2) == FORCE;
    match command.parameter(1) {
        1.0 => vehicle.arm(force || command.parameter(2) == FORCE_ARMING),
        0.0 => vehicle.disarm(force),
        other => Err(Refusal::denied(format!("Invalid value {other}: 1 arms, 0 disarms"))),
    }
}

fn switch_fence(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let number = command.parameter(1);
    let is_ardupilot = context.vehicle.identity().is_ardupilot();
    // PX4's is switched as a whole.
    let parts = if is_ardupilot { Some(command.parameter(2)).filter(|parts| !parts.is_nan()) } else { None };
    let known = FenceSwitch::of_numbers(number, parts.unwrap_or(0.0));
    // PX4's fence has no floor.
    let Some(switch) = known.filter(|switch| is_ardupilot || *switch != FenceSwitch::FloorOff) else {
        let floor = if is_ardupilot { ", 2 disables its floor" } else { "" };
        let values = format!("1 enables the fence, 0 disables it{floor}");
        return Err(Refusal::denied(match parts {
            Some(parts) => {
                let mask = "parameter 2 is a sum of FENCE_TYPE values, 0 to 15 (0: all parts)";
                format!("Invalid values {number}, {parts}: {values}; {mask}")
            }
            None => format!("Invalid value {number}: {values}"),
        }));
    };
    context.vehicle.switch_fence(switch);
    parameter::tell(context, "FENCE_ENABLE");
    Ok(())
}

/// A mask of batteries, of which there is one, and the charge in percent that it is said to have.
fn reset_battery(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let (batteries, percent) = (command.parameter(1), command.parameter(2));
    if batteries as u32 & 1 == 0 {
        return Err(Refusal::denied("Battery reset denied: there is only the first battery, bit 0"));
    }
    if !(0.0..=100.0).contains(&percent) {
        return Err(Refusal::denied(format!("Battery reset denied: {percent} %; allowed 0 to 100")));
    }
    context.vehicle.refill_battery(percent / 100.0)
}

/// ArduPilot answers whatever it does not take off for by a failure.
fn failed(refusal: Refusal) -> Refusal {
    Refusal::Failed(refusal.to_string())
}

/// PX4's altitude is above sea level, ArduPilot's above home; NaN stands for the parameter.
fn take_off(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let vehicle = &mut context.vehicle;
    if command.z.is_nan() && !vehicle.identity().is_ardupilot() {
        return vehicle.take_off(None);
    }
    if vehicle.identity().is_ardupilot() {
        let frame =
            if let CommandKind::Int { frame } = command.kind { frame } else { plan::frame::GLOBAL_RELATIVE };
        if !matches!(frame, plan::frame::GLOBAL_RELATIVE | plan::frame::GLOBAL_RELATIVE_INT) {
            return Err(Refusal::denied(format!(
                "Takeoff denied: frame {frame}; allowed 3 and 6, above home"
            )));
        }
        let height_m = Some(command.z).filter(|height| !height.is_nan());
        // A third parameter lets the pilot hold the place.
        return vehicle.take_off_in_mode(height_m, command.parameter(3) == 0.0).map_err(failed);
    }
    let frame = global_frame(command)?;
    let down_m = vehicle.site().down_m(frame, command.z, vehicle.horizontal_m());
    let height_m = vehicle.home().position_m.z - down_m;
    // PX4 takes an altitude below the ground for one above home of its parameter.
    const LEAST_M: f64 = 0.5;
    if height_m < LEAST_M {
        let counts_from = if matches!(frame, plan::frame::GLOBAL | plan::frame::GLOBAL_INT) {
            let home_m = vehicle.place_of(&vehicle.home().position_m).altitude_m;
            format!("above sea level, home is at {home_m:.1} m")
        } else {
            "not above home".to_owned()
        };
        let text = format!("Takeoff altitude {:.1} m {counts_from}: using default", command.z);
        context.say(Severity::Warning, &text);
        return context.vehicle.take_off(None);
    }
    vehicle.take_off(Some(height_m))
}

/// The same as an item of a mission: angle, rate, direction, relative or not.
fn turn(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let vehicle = &mut context.vehicle;
    let turn = compile::turn(&item_of(command, plan::frame::MISSION), &vehicle.site())
        .map_err(|fault| Refusal::denied(format!("Turn denied: {}", fault.reason)))?;
    vehicle.turn(&turn)
}

fn set_home(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let vehicle = &mut context.vehicle;
    // ArduPilot takes zeros for no place, too.
    let no_place = vehicle.identity().is_ardupilot() && command.x == 0.0 && command.y == 0.0;
    if command.parameter(1) == 1.0 || no_place {
        return vehicle.set_home(vehicle.outputs().position_m, None);
    }
    let frame = global_frame(command)?;
    let mut position_m = told_place(command, vehicle)?;
    if !command.z.is_finite() {
        return Err(Refusal::denied("DO_SET_HOME requires an altitude"));
    }
    position_m.z = vehicle.site().down_m(frame, command.z, [position_m.x, position_m.y]);
    let yaw_rad = Some(command.parameter(4).to_radians()).filter(|yaw| yaw.is_finite());
    vehicle.set_home(position_m, yaw_rad)
}

/// MAV_DO_REPOSITION_FLAGS_CHANGE_MODE: ArduPilot leaves other modes than its guided ones for no repositioning without it.
const CHANGE_MODE: u32 = 1;

/// NaN keeps what it stands for; nothing but NaN is a pause.
fn reposition(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let vehicle = &mut context.vehicle;
    let changes_mode = command.whole(2).is_some_and(|flags| flags & CHANGE_MODE != 0);
    if vehicle.identity().is_ardupilot() && !changes_mode && !vehicle.is_guided() {
        return Err(Refusal::denied(
            "Reposition rejected: not in Guided mode, and the flag CHANGE_MODE is not set",
        ));
    }
    // Without a place it has no frame.
    let nowhere = command.x.is_nan() && command.y.is_nan() && !command.z.is_finite();
    let frame = if nowhere { plan::frame::GLOBAL } else { global_frame(command)? };
    let horizontal_m = if command.x.is_nan() && command.y.is_nan() {
        None
    } else {
        let position_m = told_place(command, vehicle)?;
        Some([position_m.x, position_m.y])
    };
    let place_m = horizontal_m.unwrap_or(vehicle.horizontal_m());
    let down_m = Some(command.z)
        .filter(|altitude| altitude.is_finite())
        .map(|altitude| vehicle.site().down_m(frame, altitude, place_m));
    // As in ArduPilot's guided mode, the nose then points where the vehicle flies.
    let turns = !vehicle.identity().is_ardupilot();
    let yaw_rad = Some(command.parameter(4)).filter(|yaw| turns && yaw.is_finite());
    let is_above_ground = down_m.is_some() && plan::is_above_ground(frame);
    vehicle.reposition(&Reposition { horizontal_m, down_m, yaw_rad, is_above_ground })?;
    let speed_m_s = command.parameter(1);
    if speed_m_s > 0.0 { use_speed(vehicle, 1.0, speed_m_s) } else { Ok(()) }
}

/// PX4's: an altitude above sea level, whatever the frame says. It holds there.
fn change_altitude(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let vehicle = &mut context.vehicle;
    if vehicle.identity().is_ardupilot() {
        return Err(Refusal::Unsupported(
            "DO_CHANGE_ALTITUDE is not supported: use DO_REPOSITION".to_owned(),
        ));
    }
    let altitude_m = command.parameter(1);
    if !altitude_m.is_finite() {
        return Err(Refusal::denied("DO_CHANGE_ALTITUDE requires an altitude"));
    }
    let down_m = vehicle.site().down_m(plan::frame::GLOBAL, altitude_m, vehicle.horizontal_m());
    vehicle.reposition(&Reposition { down_m: Some(down_m), ..Reposition::default() })
}

/// FAILURE_UNIT, FAILURE_TYPE, instance.
fn inject_failure(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let vehicle = &mut context.vehicle;
    // Nothing may be named instead of every instance.
    let instance = if command.parameter(3).is_nan() { Some(0) } else { command.whole(3) };
    let (Some(unit), Some(kind), Some(instance)) = (command.whole(1), command.whole(2), instance) else {
        return Err(Refusal::denied("INJECT_FAILURE requires unit, type and instance"));
    };
    let fault = Fault::of_numbers(unit, kind, instance)
        .map_err(|error| Refusal::Unsupported(format!("Failure injection: {error}")))?;
    vehicle.inject(&fault)
}
