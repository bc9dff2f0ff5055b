//! Commands that navigate at once, by COMMAND_LONG and COMMAND_INT, as PX4 and ArduPilot take them.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use crate::common::mission_flight::{takeoff, waypoint};
use crate::common::plan_client::{result, upload};
use crate::common::{Bench, command_long};
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, PlanKind};
use vehicle::{LandedState, Mode};

const DENIED: u8 = 2;
const UNSUPPORTED: u8 = 3;
const FAILED: u8 = 4;
const BOTH: [Identity; 2] = [Identity::Px4, Identity::ArduPilot];

/// Sends COMMAND_INT and returns the result of its answer.
fn command_int(bench: &mut Bench, command: MavCmd, frame: MavFrame, param1: f32, z: f32) -> u8 {
    bench.heard.clear();
    bench.send(MavMessage::COMMAND_INT(COMMAND_INT_DATA {
        command,
        frame,
        param1,
        z,
        target_system: 1,
        target_component: 1,
        ..COMMAND_INT_DATA::default()
    }));
    bench.acks().last().expect("every command is answered").result
}

/// By either message, in a flight of its own.
fn either(identity: Identity, command: MavCmd, check: impl Fn(&mut Bench, u8)) {
    let mut long = Bench::hovering(identity);
    let result = long.command(command, [0.0; 7]);
    check(&mut long, result);
    let mut int = Bench::hovering(identity);
    let result = command_int(&mut int, command, MavFrame::MAV_FRAME_GLOBAL, 0.0, 0.0);
    check(&mut int, result);
}

#[test]
fn loiter_land_and_return_change_the_mode() {
    for identity in BOTH {
        let loiters = if identity.is_ardupilot() { Mode::Position } else { Mode::Hold };
        for (command, mode) in [
            (MavCmd::MAV_CMD_NAV_LOITER_UNLIM, loiters),
            (MavCmd::MAV_CMD_NAV_LAND, Mode::Land),
            (MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH, Mode::Return),
        ] {
            either(identity, command, |bench, result| {
                assert_eq!((result, bench.mode()), (0, mode), "{identity:?} {command:?}");
            });
        }
    }
}

#[test]
fn go_around_and_a_landing_that_no_mission_has_are_refused() {
    for identity in BOTH {
        either(identity, MavCmd::MAV_CMD_DO_GO_AROUND, |_, result| assert_eq!(result, UNSUPPORTED));
        either(identity, MavCmd::MAV_CMD_DO_LAND_START, |bench, result| {
            assert_eq!(result, FAILED);
            assert!(
                bench.texts().iter().any(|text| text.contains("no DO_LAND_START")),
                "{:?}",
                bench.texts()
            );
        });
    }
}

#[test]
fn ardupilots_takeoff_is_above_home_and_fails_where_it_cannot_be() {
    const TAKEOFF: MavCmd = MavCmd::MAV_CMD_NAV_TAKEOFF;
    let relative = MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT;
    let mut bench = Bench::new(Identity::ArduPilot);
    assert_eq!(command_int(&mut bench, TAKEOFF, relative, 0.0, 5.0), FAILED, "not armed");
    bench.set_mode(Mode::Offboard);
    bench.arm();
    assert_eq!(command_int(&mut bench, TAKEOFF, MavFrame::MAV_FRAME_GLOBAL, 0.0, 5.0), DENIED);
    assert_eq!(command_int(&mut bench, TAKEOFF, relative, 0.0, 5.0), 0);
    bench.fly_until("up", 20.0, |bench| bench.is_near([0.0, 0.0, -5.0]));
    assert_eq!(command_int(&mut bench, TAKEOFF, relative, 0.0, 8.0), FAILED, "it flies");
}

fn with_mission(identity: Identity) -> Bench {
    let mut bench = Bench::new(identity);
    let home = MissionItem::home([0.0; 3]);
    let items = [home, takeoff(), waypoint([10.0, 0.0, -10.0])];
    let items = if identity.is_ardupilot() { &items[..] } else { &items[1..] };
    assert_eq!(result(&upload(&mut bench, PlanKind::Mission, items)), Some(0));
    bench
}

#[test]
fn a_mission_starts_as_its_autopilot_does_it() {
    const START: MavCmd = MavCmd::MAV_CMD_MISSION_START;
    let mut px4 = with_mission(Identity::Px4);
    assert_eq!(px4.command(START, [0.0; 7]), 0);
    assert!(px4.autopilot.vehicle().is_armed() && px4.mode() == Mode::Mission);
    assert_eq!(Bench::new(Identity::ArduPilot).command(START, [0.0; 7]), FAILED, "no mission");
    let mut ardupilot = with_mission(Identity::ArduPilot);
    assert_eq!(ardupilot.command(START, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), DENIED);
    assert_eq!(ardupilot.command(START, [0.0; 7]), 0);
    assert!(!ardupilot.autopilot.vehicle().is_armed() && ardupilot.mode() == Mode::Mission);
    ardupilot.arm();
    ardupilot.fly_until("off the ground", 5.0, |bench| {
        bench.autopilot.vehicle().landed_state() != LandedState::OnGround
    });
}

#[test]
fn a_speed_that_is_none_is_refused_by_ardupilot_and_is_px4s_own() {
    const SPEED: MavCmd = MavCmd::MAV_CMD_DO_CHANGE_SPEED;
    let flown =
        |bench: &Bench| bench.autopilot.vehicle().simulation().configuration().limits.speed_horizontal_m_s;
    for (identity, result, after_m_s) in [(Identity::Px4, 0, 8.0), (Identity::ArduPilot, DENIED, 3.0)] {
        let mut bench = Bench::hovering(identity);
        assert_eq!(command_int(&mut bench, SPEED, MavFrame::MAV_FRAME_GLOBAL, 1.0, 0.0), result);
        assert_eq!(bench.command(SPEED, [1.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 0);
        assert_eq!(flown(&bench), 3.0);
        assert_eq!(bench.command(SPEED, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), result);
        assert_eq!(flown(&bench), after_m_s, "{identity:?}");
    }
}

/// ArduPilot takes the altitude of a COMMAND_LONG above home.
#[test]
fn a_region_of_interest_is_looked_at_wherever_its_altitude_is_from() {
    for identity in BOTH {
        let mut bench = Bench::hovering(identity);
        let place = bench.autopilot.vehicle().frame().to_geodetic(&nalgebra::Vector3::new(0.0, 50.0, 0.0));
        let look = [0.0, 0.0, 0.0, 0.0, place.latitude_deg as f32, place.longitude_deg as f32, 5.0];
        assert_eq!(bench.command(MavCmd::MAV_CMD_DO_SET_ROI, look), 0, "{:?}", bench.texts());
        bench.fly(8.0);
        let heading_deg = bench.autopilot.vehicle().outputs().attitude_rad.z.to_degrees();
        assert!((heading_deg - 90.0).abs() < 3.0, "{identity:?}: {heading_deg}");
        if !identity.is_ardupilot() {
            continue;
        }
        // In ArduPilot the first velocity turns the nose ahead. Looking anew, it keeps looking while velocities lead it past the place.
        let go_north = |bench: &mut Bench| {
            bench.send(MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
                target_system: 1,
                coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
                type_mask: PositionTargetTypemask::from_bits_retain(0x0fc7),
                vx: 2.5,
                ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
            }));
        };
        bench.stream(0.2, go_north);
        assert_eq!(bench.command(MavCmd::MAV_CMD_DO_SET_ROI, look), 0, "{:?}", bench.texts());
        bench.stream(20.0, go_north);
        let heading_deg = bench.autopilot.vehicle().outputs().attitude_rad.z.to_degrees();
        assert!((heading_deg - 135.0).abs() < 6.0, "{heading_deg}");
    }
}

#[test]
fn both_magic_numbers_arm_by_force() {
    const ARM: MavCmd = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM;
    for (number, result) in [(0.0, 4), (2990.0, 4), (2989.0, 0), (21196.0, 0)] {
        let mut bench = Bench::new(Identity::ArduPilot);
        assert_eq!(bench.set_mode(Mode::Return), 0);
        assert_eq!(bench.command(ARM, [1.0, number, 0.0, 0.0, 0.0, 0.0, 0.0]), result, "{number}");
        assert_eq!(bench.autopilot.vehicle().is_armed(), result == 0);
    }
}

/// What it asks for has been undone: it is no retry, though its sender says so.
#[test]
fn a_command_behind_its_opposite_is_carried_out_again() {
    const ARM: MavCmd = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM;
    let arm = |on: f32, confirmation| command_long(ARM, [on, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], confirmation);
    let mut bench = Bench::new(Identity::Px4);
    for (on, confirmation, armed) in [(1.0, 0, true), (0.0, 0, false), (1.0, 1, true), (1.0, 2, true)] {
        bench.send(arm(on, confirmation));
        assert_eq!(bench.autopilot.vehicle().is_armed(), armed, "{on} {confirmation}");
    }
    assert!(bench.acks().iter().all(|ack| ack.result == 0));
    // A real one, with nothing between but a rate, is answered and not carried out.
    bench.send(arm(0.0, 0));
    bench.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [30.0, 1e5, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let said = bench.texts().len();
    bench.send(arm(0.0, 1));
    assert_eq!((bench.texts().len(), bench.acks().last().map(|ack| ack.result)), (said, Some(0)));
}

/// REQUEST_MESSAGE for MESSAGE_INTERVAL names the message that is meant in parameter 2.
#[test]
fn an_interval_can_be_asked_for_as_a_message() {
    let mut bench = Bench::new(Identity::Px4);
    let interval = |bench: &mut Bench, number: f32| {
        assert_eq!(
            bench.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, [244.0, number, 0.0, 0.0, 0.0, 0.0, 0.0]),
            0
        );
        let answer = |message: &Message| match message {
            Message::Typed(MavMessage::MESSAGE_INTERVAL(answer)) => {
                Some((answer.message_id, answer.interval_us))
            }
            _ => None,
        };
        bench.heard.iter().find_map(answer)
    };
    assert_eq!(bench.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [30.0, 2e5, 0.0, 0.0, 0.0, 0.0, 0.0]), 0);
    assert_eq!(interval(&mut bench, 30.0), Some((30, 200_000)));
    assert_eq!(interval(&mut bench, 60000.0), Some((60000, 0)), "there is none");
}

#[test]
fn messages_are_those_of_the_identity() {
    for identity in BOTH {
        let mut bench = Bench::new(identity);
        bench.heard.clear();
        bench.fly(1.5);
        let report = |message: &Message| match message {
            Message::Typed(MavMessage::EKF_STATUS_REPORT(report)) => Some(report.clone()),
            _ => None,
        };
        let reports: Vec<_> = bench.heard.iter().filter_map(report).collect();
        let wanted = EkfStatusFlags::EKF_ATTITUDE
            | EkfStatusFlags::EKF_POS_HORIZ_ABS
            | EkfStatusFlags::EKF_PRED_POS_HORIZ_ABS
            | EkfStatusFlags::EKF_VELOCITY_HORIZ;
        assert_eq!(!reports.is_empty(), identity.is_ardupilot());
        assert!(reports.iter().all(|report| report.flags.contains(wanted)), "{reports:?}");
        let ask = [193.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let result = if identity.is_ardupilot() { 0 } else { UNSUPPORTED };
        assert_eq!(bench.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, ask), result);
        bench.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, [245.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let state = |message: &Message| match message {
            Message::Typed(MavMessage::EXTENDED_SYS_STATE(state)) => Some(state.vtol_state),
            _ => None,
        };
        let multicopter = identity.is_ardupilot();
        let expected = if multicopter {
            MavVtolState::MAV_VTOL_STATE_MC
        } else {
            MavVtolState::MAV_VTOL_STATE_UNDEFINED
        };
        assert_eq!(bench.heard.iter().find_map(state), Some(expected));
    }
}

/// The altitude of the tests' home above sea level, m.
const HOME_M: f32 = 488.0;

fn height_m(bench: &Bench) -> f64 {
    -bench.position()[2]
}

/// PX4 climbs from where it flies; below the vehicle it stays.
#[test]
fn px4_takes_off_in_flight_too() {
    let takeoff = |height_m: f32| [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, HOME_M + height_m];
    let mut bench = Bench::hovering(Identity::Px4);
    let before = bench.position();
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, takeoff(18.0)), 0);
    assert_eq!(bench.mode(), Mode::Takeoff);
    bench.fly_until("the height", 30.0, |bench| bench.mode() == Mode::Hold);
    let [x, y, _] = bench.position();
    assert!((height_m(&bench) - 18.0).abs() < 0.3, "{} m", height_m(&bench));
    assert!((x - before[0]).hypot(y - before[1]) < 0.3, "{before:?} {x} {y}");
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, takeoff(5.0)), 0);
    bench.fly(3.0);
    assert!((height_m(&bench) - 18.0).abs() < 0.3, "{} m", height_m(&bench));
    assert!(bench.texts().iter().any(|text| text == "Already higher than takeoff altitude"));
}

/// DO_CHANGE_ALTITUDE is PX4's: it goes to an altitude above sea level where it is, and holds.
#[test]
fn px4_changes_its_altitude() {
    let mut bench = Bench::hovering(Identity::Px4);
    let altitude = [HOME_M + 15.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_CHANGE_ALTITUDE, altitude), 0);
    bench.fly(10.0);
    assert!((height_m(&bench) - 15.0).abs() < 0.2, "{} m", height_m(&bench));
    assert_eq!(bench.mode(), Mode::Hold);
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_CHANGE_ALTITUDE, [f32::NAN; 7]), DENIED);
    let mut ardupilot = Bench::hovering(Identity::ArduPilot);
    assert_eq!(ardupilot.command(MavCmd::MAV_CMD_DO_CHANGE_ALTITUDE, altitude), UNSUPPORTED);
}

/// PX4 touches no storage while it is armed.
#[test]
fn px4_stores_no_parameters_while_armed() {
    const TEMPORARILY_REJECTED: u8 = 1;
    let write = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let mut bench = Bench::hovering(Identity::Px4);
    assert_eq!(bench.command(MavCmd::MAV_CMD_PREFLIGHT_STORAGE, write), TEMPORARILY_REJECTED);
    assert_eq!(Bench::new(Identity::Px4).command(MavCmd::MAV_CMD_PREFLIGHT_STORAGE, write), 0);
}

/// A message that can be streamed has no interval that is no number.
#[test]
fn an_interval_that_is_no_number_is_denied_as_such() {
    let mut bench = Bench::new(Identity::Px4);
    let parameters = [33.0, f32::NAN, 0.0, 0.0, 0.0, 0.0, 0.0];
    let denied = MavResult::MAV_RESULT_DENIED as u8;
    assert_eq!(bench.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, parameters), denied);
    let told = "Message interval denied: NaN; send microseconds, 0 (default) or -1 (never)";
    assert!(bench.texts().contains(&told.to_owned()), "{:?}", bench.texts());
}
