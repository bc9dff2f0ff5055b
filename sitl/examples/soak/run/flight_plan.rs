//! What a client is going to do: random, and valid.

use std::collections::VecDeque;

use autopilot::codec::command_long;
use autopilot::{Autopilot, COMPONENT};
use mavlink::dialects::ardupilotmega::{
    COMMAND_INT_DATA, MISSION_ITEM_INT_DATA, MavCmd, MavFrame, MavMessage,
};
use nalgebra::Vector3;
use vehicle::{LandedState, Mode};

use super::chance::Chance;
use super::task::Step;

const HOLD: [f32; 3] = [1.0, 4.0, 3.0];
const OFFBOARD: [f32; 3] = [1.0, 6.0, 0.0];
/// Waypoints of a mission that is flown; longer ones are only carried there and back.
const LONGEST_FLOWN: usize = 8;
/// So near to a waypoint, m, the next one begins.
const ACCEPTANCE_M: f32 = 1.0;

/// A flight, or the rest of one that somebody has left.
pub fn pilot(autopilot: &Autopilot, chance: &mut Chance) -> VecDeque<Step> {
    let vehicle = autopilot.vehicle();
    let target = autopilot.system_id();
    let mut steps = VecDeque::new();
    if vehicle.landed_state() == LandedState::OnGround {
        if vehicle.is_armed() {
            return [command(target, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, &[0.0]), pause(2.0)].into();
        }
        // A landing that somebody asked for when it stood already: no mode to be armed in.
        if matches!(vehicle.mode(), Mode::Land | Mode::Return) {
            steps.push_back(command(target, MavCmd::MAV_CMD_DO_SET_MODE, &HOLD));
        }
        if chance.share() < 0.5 {
            let (places, items) = mission(autopilot, chance);
            let short = places.len() <= LONGEST_FLOWN;
            steps.extend([Step::Upload(items), Step::Download]);
            if short {
                steps.push_back(command(target, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, &[1.0]));
                steps.push_back(command(target, MavCmd::MAV_CMD_MISSION_START, &[]));
                steps.extend([Step::Mission { places }, pause(chance.within(1.0, 20.0))]);
                return steps;
            }
        }
        let altitude = vehicle.frame().origin().altitude_m + chance.within(2.0, 12.0);
        let takeoff = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, altitude as f32];
        steps.push_back(command(target, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, &[1.0]));
        steps.extend([command(target, MavCmd::MAV_CMD_NAV_TAKEOFF, &takeoff), Step::Airborne]);
    } else {
        steps.push_back(command(target, MavCmd::MAV_CMD_DO_SET_MODE, &HOLD));
    }
    for _ in 0..chance.one_of(&[1, 2, 3, 5, 8]) {
        steps.extend(in_the_air(autopilot, chance));
    }
    let end = chance.one_of(&[MavCmd::MAV_CMD_NAV_LAND, MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH]);
    steps.extend([command(target, end, &[]), Step::Landed, pause(chance.within(1.0, 20.0))]);
    steps
}

fn in_the_air(autopilot: &Autopilot, chance: &mut Chance) -> Vec<Step> {
    let target = autopilot.system_id();
    let place = [chance.within(-30.0, 30.0), chance.within(-30.0, 30.0), chance.within(-15.0, -3.0)];
    match chance.one_of(&[0, 1, 2, 3, 4, 5]) {
        0 => vec![reposition(autopilot, place), pause(chance.within(5.0, 15.0))],
        1 => {
            let stream = |seconds| Step::Stream { goal: place, for_us: (seconds * 1e6) as u64 };
            let hold = command(target, MavCmd::MAV_CMD_DO_SET_MODE, &HOLD);
            // The command goes out while set-points are recent.
            vec![
                stream(0.1),
                command(target, MavCmd::MAV_CMD_DO_SET_MODE, &OFFBOARD),
                stream(10.0),
                hold,
                pause(8.0),
            ]
        }
        2 => {
            let turn = [chance.within(-180.0, 180.0) as f32, 0.0, 1.0, 0.0];
            vec![command(target, MavCmd::MAV_CMD_CONDITION_YAW, &turn), pause(5.0)]
        }
        3 => {
            let speed = [1.0, chance.within(3.0, 8.0) as f32, -1.0];
            vec![
                command(target, MavCmd::MAV_CMD_DO_CHANGE_SPEED, &speed),
                reposition(autopilot, place),
                pause(6.0),
            ]
        }
        // Long enough to see whether it stays.
        _ => vec![command(target, MavCmd::MAV_CMD_DO_SET_MODE, &HOLD), pause(chance.within(20.0, 45.0))],
    }
}

/// Somebody who looks on and changes what does not disturb the flight.
pub fn observer(autopilot: &Autopilot, chance: &mut Chance) -> VecDeque<Step> {
    let target = autopilot.system_id();
    let message = chance.one_of(&[30.0, 32.0, 33.0, 105.0, 331.0]);
    let interval = chance.one_of(&[-1.0, 0.0, 20_000.0, 200_000.0]);
    let step = match chance.one_of(&[0, 1, 2, 3, 4]) {
        0 => Step::ReadParameters,
        1 => Step::SetParameter { name: "MIS_TAKEOFF_ALT", value: chance.one_of(&[2.0, 3.0, 4.5]) },
        2 => Step::SetParameter { name: "LIM_JERK_HORIZ", value: chance.one_of(&[3.0, 4.0, 5.0]) },
        3 => command(target, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, &[message, interval]),
        _ => command(target, MavCmd::MAV_CMD_REQUEST_MESSAGE, &[148.0]),
    };
    [step, pause(chance.within(0.5, 10.0))].into()
}

fn pause(seconds: f64) -> Step {
    Step::Pause { for_us: (seconds * 1e6) as u64 }
}

fn command(target_system: u8, number: MavCmd, parameters: &[f32]) -> Step {
    let mut all = [0.0; 7];
    all[..parameters.len()].copy_from_slice(parameters);
    let message = MavMessage::COMMAND_LONG(command_long((target_system, COMPONENT), number, all));
    Step::Command { number: number as u16, message: Box::new(message) }
}

fn scaled(autopilot: &Autopilot, place: [f64; 3]) -> (i32, i32, f32) {
    let place = autopilot.vehicle().frame().to_geodetic(&Vector3::from(place));
    let scale = |degrees: f64| (degrees * 1e7).round() as i32;
    (scale(place.latitude_deg), scale(place.longitude_deg), place.altitude_m as f32)
}

fn reposition(autopilot: &Autopilot, place: [f64; 3]) -> Step {
    let (x, y, z) = scaled(autopilot, place);
    Step::Command {
        number: MavCmd::MAV_CMD_DO_REPOSITION as u16,
        message: Box::new(MavMessage::COMMAND_INT(COMMAND_INT_DATA {
            param1: -1.0,
            param4: f32::NAN,
            x,
            y,
            z,
            command: MavCmd::MAV_CMD_DO_REPOSITION,
            target_system: autopilot.system_id(),
            target_component: 1,
            frame: MavFrame::MAV_FRAME_GLOBAL,
            ..COMMAND_INT_DATA::default()
        })),
    }
}

/// A takeoff, some waypoints and a landing; and where the waypoints are.
fn mission(autopilot: &Autopilot, chance: &mut Chance) -> (Vec<[f64; 3]>, Vec<MISSION_ITEM_INT_DATA>) {
    let waypoints = chance.one_of(&[1_u16, 3, 5, 8, 60]);
    let item = |seq: u16, command, place| {
        let (x, y, _) = scaled(autopilot, place);
        MISSION_ITEM_INT_DATA {
            x,
            y,
            z: -place[2] as f32,
            seq,
            command,
            target_system: autopilot.system_id(),
            target_component: 1,
            frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
            autocontinue: 1,
            ..MISSION_ITEM_INT_DATA::default()
        }
    };
    let mut items = vec![item(0, MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, -5.0])];
    let mut places = Vec::new();
    for seq in 1..=waypoints {
        let place = [chance.within(-50.0, 50.0), chance.within(-50.0, 50.0), chance.within(-20.0, -3.0)];
        places.push(place);
        items.push(MISSION_ITEM_INT_DATA {
            param2: ACCEPTANCE_M,
            ..item(seq, MavCmd::MAV_CMD_NAV_WAYPOINT, place)
        });
    }
    items.push(item(waypoints + 1, MavCmd::MAV_CMD_NAV_LAND, [0.0; 3]));
    (places, items)
}
