//! Missions.

use super::flier::*;
use crate::common::settings;
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage};
use vehicle::identity::Identity;
use vehicle::plan::{PlanKind, command};

const TAKEOFF: u16 = command::NAV_TAKEOFF;
const WAYPOINT: u16 = command::NAV_WAYPOINT;
const AUTO_RTL: u32 = 27;
const RETURN: u16 = command::NAV_RETURN_TO_LAUNCH;

/// Suite: AuxFunctionsInMission.
#[test]
fn a_mission_moves_a_switch() {
    let mut start = settings(Identity::ArduPilot);
    let rows = [
        (TAKEOFF, 0.0, 0.0, 10.0),
        (WAYPOINT, 10.0, 0.0, 10.0),
        (218, 0.0, 0.0, 0.0),
        (WAYPOINT, 20.0, 0.0, 10.0),
        (RETURN, 0.0, 0.0, 0.0),
    ];
    let plan = mission(&start, &rows);
    let mut items = plan.items().to_vec();
    // AltHold, high.
    items[3].parameters = [70.0, 2.0, 0.0, 0.0];
    start.plans.set(PlanKind::Mission, vehicle::plan::Plan::new(items));
    let mut flier = Flier::with(&start);
    flier.change_mode(LOITER);
    flier.arm();
    flier.change_mode(AUTO);
    flier.rc(3, 1500);
    flier.wait_mode(ALT_HOLD, 60.0);
    flier.change_mode(AUTO);
    flier.wait_home();
}

/// Suite: PAUSE_CONTINUE.
#[test]
fn a_mission_pauses_and_goes_on_however_often_it_is_asked() {
    let rows = [
        (TAKEOFF, 0.0, 0.0, 10.0),
        (WAYPOINT, 60.0, 0.0, 10.0),
        (WAYPOINT, 60.0, 60.0, 10.0),
        (RETURN, 0.0, 0.0, 0.0),
    ];
    let mut flier = with_mission(&rows);
    flier.change_mode(AUTO);
    flier.arm();
    for item in [2, 3] {
        flier.wait("its item", 90.0, |flier| flier.vehicle().mission_status().current == item);
        flier.fly(2.0);
        for continues in [0.0, 0.0, 1.0, 1.0] {
            let parameters = [continues, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            assert_eq!(
                flier.command(MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, parameters),
                ACCEPTED,
                "{item} {continues}"
            );
            flier.fly(if continues == 0.0 { 5.0 } else { 0.1 });
            assert!(continues == 1.0 || flier.speed_m_s() < 1.0, "{}", flier.speed_m_s());
        }
    }
    flier.wait_home();
}

/// The current item, as MISSION_CURRENT tells it.
fn current(flier: &mut Flier) -> u16 {
    flier.bench.heard.clear();
    flier.fly(1.2);
    let told = flier.latest(|message| match message {
        MavMessage::MISSION_CURRENT(current) => Some(current.seq),
        _ => None,
    });
    told.expect("it is told each second")
}

fn go_on(flier: &mut Flier, command: MavCmd) -> u8 {
    flier.command(command, [0.0; 7])
}

/// Suite: AutoRTL. The way back is joined where it is nearest, but not behind the beginning of the landing; what follows DO_LAND_START is a
/// way of its own. Here all is a tenth as far.
#[test]
fn a_mission_has_a_way_back_and_a_landing() {
    let (back, landing) = (MavCmd::MAV_CMD_DO_RETURN_PATH_START, MavCmd::MAV_CMD_DO_LAND_START);
    let rows = [
        (WAYPOINT, 125.0, 0.0, 50.0),
        (command::DO_RETURN_PATH_START, 0.0, 0.0, 0.0),
        (WAYPOINT, 90.0, 0.0, 50.0),
        (WAYPOINT, 75.0, 0.0, 50.0),
        (WAYPOINT, 55.0, 0.0, 50.0),
        (WAYPOINT, 50.0, 0.0, 50.0),
        (command::DO_LAND_START, 0.0, 0.0, 0.0),
        (WAYPOINT, 25.0, 0.0, 50.0),
        (WAYPOINT, -25.0, 0.0, 50.0),
    ];
    let mut flier = with_mission(&rows);
    flier.take_off(50.0, GUIDED);
    assert_eq!((go_on(&mut flier, back), current(&mut flier)), (ACCEPTED, 6), "above home");
    assert_eq!((go_on(&mut flier, landing), current(&mut flier)), (ACCEPTED, 8));
    assert_eq!(flier.vehicle().shown_mode(), vehicle::Mode::MissionLanding);
    flier.change_mode(GUIDED);
    fly_north(&mut flier, 100.0);
    assert_eq!((go_on(&mut flier, back), current(&mut flier)), (ACCEPTED, 3));
    flier.change_mode(GUIDED);
    fly_north(&mut flier, 60.0);
    assert_eq!(flier.ask_mode(AUTO_RTL), ACCEPTED);
    assert_eq!(current(&mut flier), 5);
}

/// Flies to a place north of home, m, 50 m up.
fn fly_north(flier: &mut Flier, north_m: f32) {
    let target = crate::common::requests::local_target(0b1101_1111_1000, [north_m, 0.0, -50.0], [0.0; 3]);
    flier.bench.send(target);
    flier.wait("the place", 60.0, |flier| (flier.distance_m() - f64::from(north_m)).abs() < 1.0);
}

/// Without a mission neither is there.
#[test]
fn without_a_mission_there_is_no_way_back() {
    let mut flier = Flier::new();
    flier.take_off(10.0, GUIDED);
    let wanted = [
        (
            MavCmd::MAV_CMD_DO_RETURN_PATH_START,
            "Return path rejected: the mission has no DO_RETURN_PATH_START",
        ),
        (MavCmd::MAV_CMD_DO_LAND_START, "Landing rejected: the mission has no DO_LAND_START"),
    ];
    for (command, reason) in wanted {
        assert_eq!(go_on(&mut flier, command), FAILED);
        assert!(flier.has_said(reason), "{:?}", flier.bench.texts());
    }
    assert_eq!(flier.ask_mode(AUTO_RTL), FAILED);
    let reason = "Auto RTL rejected: the mission has neither DO_RETURN_PATH_START nor DO_LAND_START";
    assert!(flier.has_said(reason), "{:?}", flier.bench.texts());
}

/// Suite: MISSION_OPTION_CLEAR_MISSION_AT_BOOT.
#[test]
fn a_boot_clears_the_mission_if_it_is_to() {
    let mut flier = with_mission(&[(TAKEOFF, 0.0, 0.0, 20.0), (RETURN, 0.0, 0.0, 0.0)]);
    let count = |flier: &Flier| flier.vehicle().plans().get(PlanKind::Mission).items().len();
    flier.reboot();
    assert_eq!(count(&flier), 3);
    flier.set("MIS_OPTIONS", 1.0);
    flier.reboot();
    assert_eq!(count(&flier), 0);
}

/// Suite: MissionIndexValidity, InvalidJumpTags.
#[test]
fn items_and_tags_that_there_are_not_are_refused() {
    let rows = [(TAKEOFF, 0.0, 0.0, 20.0), (WAYPOINT, 20.0, 0.0, 20.0), (RETURN, 0.0, 0.0, 0.0)];
    let mut flier = with_mission(&rows);
    let chosen = |flier: &mut Flier, item: f32| {
        flier.command(MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, [item, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    };
    assert_eq!([0.0, 1.0, 3.0].map(|item| chosen(&mut flier, item)), [ACCEPTED; 3]);
    assert_eq!(chosen(&mut flier, 4.0), 2, "denied");
    let no_such_tag = [65_535.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_JUMP_TAG, no_such_tag), FAILED);
    let no_tag = [65_536.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_JUMP_TAG, no_tag), 2, "denied");
}
