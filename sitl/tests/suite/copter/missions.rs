//! Missions.

use super::flier::*;
use crate::common::settings;
use mavlink::dialects::ardupilotmega::{MISSION_CLEAR_ALL_DATA, MavCmd, MavMessage, MavMissionResult};
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

/// Suite: TakeoffWithLocation: a takeoff goes nowhere, and what follows it without a place or an altitude stays where that ends.
#[test]
fn an_altitude_of_zero_is_the_present_one() {
    let rows = [
        (TAKEOFF, 10.0, 10.0, 20.0),
        (command::NAV_LOITER_TIME, 0.0, 0.0, 0.0),
        (WAYPOINT, 30.0, 0.0, 0.0),
        (RETURN, 0.0, 0.0, 0.0),
    ];
    let mut start = settings(Identity::ArduPilot);
    let mut items = mission(&start, &rows).items().to_vec();
    items[2].parameters[0] = 10.0;
    items[2].position = [0.0; 3];
    start.plans.set(PlanKind::Mission, vehicle::plan::Plan::new(items));
    let mut flier = Flier::with(&start);
    flier.change_mode(LOITER);
    flier.arm();
    flier.change_mode(AUTO);
    let current = |flier: &Flier| flier.vehicle().mission_status().current;
    flier.wait("the top", 60.0, |flier| current(flier) == 2);
    assert!(flier.distance_m() < 1.0, "{} m", flier.distance_m());
    while current(&flier) < 4 {
        flier.fly(0.5);
        assert!((18.0..21.0).contains(&flier.height_m()), "{} m", flier.height_m());
    }
    assert!((flier.distance_m() - 30.0).abs() < 3.0, "{} m", flier.distance_m());
    flier.wait_home();
}

/// Suite: mission_NAV_LOITER_TURNS_direction, mission_NAV_LOITER_TURNS_speed: told where the turns begin, at the edge of the circle.
#[test]
fn turns_are_told_and_go_the_way_that_the_sign_says() {
    for sign in [1.0, -1.0] {
        let mut start = settings(Identity::ArduPilot);
        let rows = [
            (TAKEOFF, 0.0, 0.0, 20.0),
            (command::NAV_LOITER_TURNS, 40.0, 0.0, 20.0),
            (RETURN, 0.0, 0.0, 0.0),
        ];
        let mut items = mission(&start, &rows).items().to_vec();
        items[2].parameters = [1.0, 0.0, 20.0 * sign, 0.0];
        start.plans.set(PlanKind::Mission, vehicle::plan::Plan::new(items));
        let mut flier = Flier::with(&start);
        flier.set("WP_SPD", 5.0);
        flier.change_mode(AUTO);
        flier.arm();
        flier.wait_text("Mission: circling", 120.0);
        assert!((flier.distance_m() - 20.0).abs() < 1.0, "{} m", flier.distance_m());
        let bearing_rad = |flier: &Flier| {
            let place_m = flier.vehicle().outputs().position_m;
            libm::atan2(place_m.y, place_m.x - 40.0)
        };
        let (mut before_rad, mut swept_rad, mut seconds) = (bearing_rad(&flier), 0.0, 0.0);
        while flier.vehicle().mission_status().current == 2 {
            flier.fly(0.1);
            seconds += 0.1;
            let moved_rad = bearing_rad(&flier) - before_rad;
            swept_rad += libm::atan2(libm::sin(moved_rad), libm::cos(moved_rad));
            before_rad += moved_rad;
        }
        assert!((swept_rad * sign).to_degrees() > 340.0, "{swept_rad} rad");
        // A turn of 2 π 20 m at 5 m/s takes 25 s.
        assert!((15.0..50.0).contains(&seconds), "{seconds} s");
    }
}

/// DroneKit's example of a mission file begins so: the takeoff climbs as high as takeoffs without a height do.
#[test]
fn a_takeoff_to_no_height_climbs() {
    let mut start = settings(Identity::ArduPilot);
    let rows = [(TAKEOFF, 0.0, 0.0, 0.0), (WAYPOINT, 10.0, 0.0, 15.0), (RETURN, 0.0, 0.0, 0.0)];
    start.plans.set(PlanKind::Mission, mission(&start, &rows));
    let mut flier = Flier::with(&start);
    flier.change_mode(AUTO);
    flier.arm();
    flier.wait("the waypoint", 60.0, |flier| flier.vehicle().mission_status().current == 3);
    assert!((flier.height_m() - 15.0).abs() < 1.0, "{} m", flier.height_m());
}

/// AP_Mission::clear: a mission that is flown stays.
#[test]
fn a_mission_that_is_flown_cannot_be_cleared() {
    let rows = [(TAKEOFF, 0.0, 0.0, 10.0), (WAYPOINT, 60.0, 0.0, 10.0), (RETURN, 0.0, 0.0, 0.0)];
    let mut flier = with_mission(&rows);
    flier.change_mode(AUTO);
    flier.arm();
    flier.wait("the way", 60.0, |flier| flier.vehicle().mission_status().current == 2);
    let clear = |flier: &mut Flier| {
        flier.bench.heard.clear();
        flier.bench.send(MavMessage::MISSION_CLEAR_ALL(MISSION_CLEAR_ALL_DATA {
            target_system: 1,
            target_component: 1,
            ..MISSION_CLEAR_ALL_DATA::default()
        }));
        let result = |message: &MavMessage| match message {
            MavMessage::MISSION_ACK(ack) => Some(ack.mavtype),
            _ => None,
        };
        flier.latest(result).expect("an answer")
    };
    assert_eq!(clear(&mut flier), MavMissionResult::MAV_MISSION_ERROR);
    assert_eq!(flier.mode(), AUTO);
    flier.change_mode(LOITER);
    assert_eq!(clear(&mut flier), MavMissionResult::MAV_MISSION_ACCEPTED);
}

/// Suite: FlyMissionTwice, FlyMissionTwiceWithReset. Armed in Auto again, the vehicle flies its mission again.
#[test]
fn a_mission_is_flown_twice_without_leaving_its_mode() {
    for resets in [false, true] {
        let mut flier =
            with_mission(&[(TAKEOFF, 0.0, 0.0, 8.0), (WAYPOINT, 20.0, 0.0, 8.0), (RETURN, 0.0, 0.0, 0.0)]);
        flier.change_mode(AUTO);
        for _ in 0..2 {
            if resets {
                let anew = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
                assert_eq!(flier.command(MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, anew), ACCEPTED);
            }
            flier.arm();
            flier.wait("the waypoint", 60.0, |flier| flier.distance_m() > 15.0);
            flier.wait_home();
            flier.fly(1.0);
            assert_eq!(flier.mode(), AUTO);
        }
    }
}

/// Suite: TakeoffAlt. A takeoff below the ground climbs by one metre, and one below the vehicle leaves it where it is.
#[test]
fn a_takeoff_below_the_ground_lifts_off() {
    for (flies, height_m) in [(false, 1.0), (true, 10.0)] {
        let mut flier =
            with_mission(&[(TAKEOFF, 0.0, 0.0, -10.0), (command::NAV_LOITER_UNLIM, 0.0, 0.0, 0.0)]);
        flier.change_mode(GUIDED);
        if flies {
            flier.take_off(10.0, GUIDED);
            flier.fly(5.0);
        } else {
            flier.arm();
        }
        flier.change_mode(AUTO);
        flier.rc(3, 1500);
        flier.wait("the last item", 20.0, |flier| flier.vehicle().mission_status().current == 2);
        flier.fly(3.0);
        assert!((flier.height_m() - height_m).abs() < 0.5, "{} m", flier.height_m());
    }
}

/// Suite: TerrainFailsafe. Armed by force, a mission above a ground that nothing tells of returns.
#[test]
fn a_mission_above_an_unknown_ground_returns() {
    let mut start = settings(Identity::ArduPilot);
    let rows = [(TAKEOFF, 0.0, 0.0, 10.0), (WAYPOINT, 200.0, 0.0, 10.0), (RETURN, 0.0, 0.0, 0.0)];
    let mut items = mission(&start, &rows).items().to_vec();
    items[2].frame = vehicle::plan::frame::GLOBAL_TERRAIN_INT;
    start.plans.set(PlanKind::Mission, vehicle::plan::Plan::new(items));
    let mut flier = Flier::with(&start);
    flier.set("TERRAIN_ENABLE", 0.0);
    flier.change_mode(AUTO);
    let by_force = [1.0, 21196.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, by_force), ACCEPTED);
    flier.wait_text("Failsafe: Terrain", 60.0);
    assert_eq!(flier.mode(), 6);
    flier.wait_home();
}
