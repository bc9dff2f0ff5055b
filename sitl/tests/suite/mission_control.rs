//! What decides how a mission goes on: jumps, conditions, speeds, the current item, pauses and the pilot.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use crate::common;
use crate::common::Bench;
use crate::common::mission_flight::{Flight, SQUARE, at, simple, takeoff, waypoint};
use crate::common::plan_client::{count_message, item_message, result, upload};
use crate::common::recording::Recording;
use crate::common::requests::set_parameter;
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::{MISSION_SET_CURRENT_DATA, MavCmd, MavMessage};
use vehicle::identity::Identity;
use vehicle::parameters::FileFormat;
use vehicle::plan::{MissionItem, Plan, PlanKind, command, frame};
use vehicle::{MissionState, Mode};

#[test]
fn speeds_change_and_come_back() {
    let items = [
        takeoff(),
        simple(command::DO_CHANGE_SPEED, [1.0, 3.0, -1.0, 0.0]),
        waypoint([60.0, 0.0, -10.0]),
        simple(command::DO_CHANGE_SPEED, [1.0, 6.0, -1.0, 0.0]),
        waypoint([160.0, 0.0, -10.0]),
    ];
    let flight = Flight::new(&items).complete(120.0);
    assert_eq!(flight.order(), [0, 1, 2, 3, 4]);
    let fastest = |from: u16, to: u16| {
        let places: Vec<_> = flight.between(flight.time_of(from), flight.time_of(to)).collect();
        places.windows(2).map(|pair| (pair[1].1 - pair[0].1).norm() / 0.01).fold(0.0, f64::max)
    };
    assert!((fastest(0, 2) - 3.0).abs() < 0.15, "{}", fastest(0, 2));
    assert!((fastest(2, 4) - 6.0).abs() < 0.3, "{}", fastest(2, 4));
    let limits = flight.bench.autopilot.vehicle().simulation().configuration().limits;
    assert_eq!(limits.speed_horizontal_m_s, 8.0, "the mission's speeds go with it");
}

/// Speeds that hold for a while are none of the parameters: a file that keeps those keeps no mission's.
#[test]
fn speeds_of_a_flight_are_not_kept() {
    let kept = |flight: &mut Flight| flight.bench.autopilot.take_changed_parameters(FileFormat::Plain);
    let flown = |flight: &Flight| flight.bench.autopilot.vehicle().simulation().configuration().limits;
    let change = |flight: &mut Flight, kind: f32, speed_m_s: f32| {
        let parameters = [kind, speed_m_s, -1.0, 0.0, 0.0, 0.0, 0.0];
        flight.bench.command(MavCmd::MAV_CMD_DO_CHANGE_SPEED, parameters)
    };
    let items = [
        takeoff(),
        simple(command::DO_CHANGE_SPEED, [1.0, 3.0, -1.0, 0.0]),
        waypoint([30.0, 0.0, -10.0]),
        at(command::NAV_LAND, [0.0, 0.0, 0.0, f64::NAN], [32.0, 0.0, 0.0]),
    ];
    let mut flight = Flight::new(&items);
    flight.fly_until("on the way", 60.0, |flight| flight.bench.position()[0] > 5.0);
    assert_eq!(flown(&flight).speed_horizontal_m_s, 3.0);
    flight.bench.send(set_parameter("LIM_SPEED_UP", 3.5));
    let text = kept(&mut flight).expect("one has changed");
    assert!(text.contains("LIM_SPEED_HORIZ 8\n") && text.contains("LIM_SPEED_UP 3.5\n"), "{text}");
    assert_eq!(flown(&flight).speed_horizontal_m_s, 3.0);
    // A command goes before the mission's, and one that cannot be changes nothing.
    assert_eq!(change(&mut flight, 1.0, 4.0), 0);
    assert_eq!((change(&mut flight, 1.0, 60.0), change(&mut flight, 7.0, 4.0)), (2, 2));
    assert_eq!((change(&mut flight, 2.0, 2.0), change(&mut flight, 2.0, -1.0)), (0, 0));
    assert_eq!((flown(&flight).speed_horizontal_m_s, flown(&flight).speed_up_m_s), (4.0, 2.0));
    assert_eq!(change(&mut flight, 2.0, -2.0), 0);
    assert_eq!(flown(&flight).speed_up_m_s, 3.5);
    // It holds in the next mode, too, and ends with the flight.
    assert_eq!(flight.bench.set_mode(Mode::Hold), 0);
    assert_eq!(flown(&flight).speed_horizontal_m_s, 4.0);
    assert_eq!(flight.bench.set_mode(Mode::Mission), 0);
    flight.fly_until("landed", 60.0, |flight| !flight.bench.autopilot.vehicle().is_armed());
    assert_eq!(flown(&flight).speed_horizontal_m_s, 8.0);
    assert_eq!(kept(&mut flight), None, "commands and missions set no parameter");
    // The next flight of the mission begins without the speed that this one ended with.
    flight.bench.arm();
    assert_eq!(flight.bench.set_mode(Mode::Mission), 0);
    flight.step();
    assert_eq!(flown(&flight).speed_horizontal_m_s, 8.0);
}

#[test]
fn jumps_repeat_what_they_should() {
    let items = [
        takeoff(),
        waypoint([5.0, 0.0, -10.0]),
        waypoint([0.0, 0.0, -10.0]),
        simple(command::DO_JUMP, [1.0, 2.0, 0.0, 0.0]),
        waypoint([0.0, 5.0, -10.0]),
    ];
    let mut flight = Flight::new(&items).complete(120.0);
    assert_eq!(flight.order(), [0, 1, 2, 3, 1, 2, 3, 1, 2, 4]);
    // Started again it jumps again.
    flight.reached.clear();
    assert_eq!(flight.bench.command(MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), 0);
    let flight = flight.complete(120.0);
    assert_eq!(flight.order(), [0, 1, 2, 3, 1, 2, 3, 1, 2, 4]);
}

#[test]
fn conditions_delay_what_follows_them() {
    let items = [
        takeoff(),
        simple(command::CONDITION_DELAY, [2.0, 0.0, 0.0, 0.0]),
        simple(command::DO_SET_HOME, [1.0, 0.0, 0.0, 0.0]),
        simple(command::CONDITION_DISTANCE, [75.0, 0.0, 0.0, 0.0]),
        simple(command::DO_CHANGE_SPEED, [1.0, 2.0, 0.0, 0.0]),
        simple(command::CONDITION_YAW, [90.0, 20.0, -1.0, 0.0]),
        simple(command::CONDITION_DELAY, [600.0, 0.0, 0.0, 0.0]),
        simple(command::DO_CHANGE_SPEED, [1.0, 1.0, 0.0, 0.0]),
        waypoint([120.0, 0.0, -10.0]),
        waypoint([120.0, 10.0, -10.0]),
    ];
    let mut flight = Flight::new(&items);
    flight.fly_until("distance", 60.0, |flight| flight.order().contains(&4));
    assert_eq!(flight.order(), [0, 1, 2, 3, 4]);
    assert!((flight.time_of(1) - flight.time_of(0) - 2.0).abs() < 0.03);
    let [x, ..] = flight.bench.position();
    assert!((x - 45.0).abs() < 0.2, "75 m before the end: {x}");
    let home = flight.bench.autopilot.vehicle().home();
    assert!(home.set_by_user && home.position_m.x > 0.5, "{home:?}");
    flight.fly_until("turned", 60.0, |flight| flight.order().contains(&5));
    // The long way round, as told: over south and west.
    assert!((flight.heading_deg() - 90.0).abs() < 4.0, "{}", flight.heading_deg());
    let (begin_s, end_s) = (flight.time_of(4), flight.time_of(5));
    assert!(flight.between(begin_s, end_s).any(|(_, _, yaw)| (yaw.to_degrees() + 90.0).abs() < 10.0));
    let rate = 270.0 / (end_s - begin_s);
    assert!((14.0..21.0).contains(&rate), "{rate} deg/s");
    // The last condition is not fulfilled when the leg ends: what follows it is dropped.
    let flight = flight.complete(90.0);
    assert_eq!(flight.order(), [0, 1, 2, 3, 4, 5, 8, 9]);
}

#[test]
fn a_pause_goes_on_with_the_same_item() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut items = vec![takeoff(), waypoint([60.0, 0.0, -10.0]), waypoint([60.0, 20.0, -10.0])];
        if identity.is_ardupilot() {
            // Home.
            items.insert(0, waypoint([0.0, 0.0, 0.0]));
        }
        let leg = items.len() - 2;
        let mut flight = Flight::of(identity, &items);
        flight.bench.arm();
        assert_eq!(flight.bench.command(MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), 0);
        flight.fly_until("under way", 60.0, |flight| flight.bench.position()[0] > 20.0);
        assert_eq!((flight.state(), flight.current()), (MissionState::Active, leg));
        let continued = |go_on: f32| [go_on, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(flight.bench.command(MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, continued(0.0)), 0);
        assert_eq!((flight.state(), flight.current()), (MissionState::Paused, leg));
        let mode = if identity.is_ardupilot() { Mode::Mission } else { Mode::Hold };
        assert_eq!(flight.bench.mode(), mode);
        flight.bench.fly(15.0);
        let [x, ..] = flight.bench.position();
        assert!(x < 50.0 && flight.bench.velocity()[0].abs() < 0.1, "{x}");
        assert_eq!(flight.bench.command(MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, continued(1.0)), 0);
        let flight = flight.complete(60.0);
        assert_eq!(flight.order().last(), Some(&(leg as u16 + 1)));
        assert!(flight.nearest([60.0, 0.0, -10.0]) < 2.0);
        assert_eq!(flight.state(), MissionState::Complete);
    }
}

#[test]
fn the_current_item_can_be_set_and_is_told() {
    let mut items = vec![takeoff()];
    items.extend(SQUARE.map(waypoint));
    let mut flight = Flight::new(&items);
    flight.fly_until("under way", 60.0, |flight| flight.current() == 1);
    flight.bench.heard.clear();
    flight.bench.send(MavMessage::MISSION_SET_CURRENT(MISSION_SET_CURRENT_DATA {
        seq: 3,
        target_system: 1,
        target_component: 1,
    }));
    let told = flight.bench.heard.iter().find_map(|message| match message {
        Message::Typed(MavMessage::MISSION_CURRENT(current)) => Some(current.clone()),
        _ => None,
    });
    let told = told.expect("told at once");
    assert_eq!((told.seq, told.total, told.mission_mode), (3, 5, 1));
    assert_eq!(told.mission_state as u32, 3);
    assert_ne!(told.mission_id, 0);
    let seek = |item: f32| [item, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flight.bench.command(MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, seek(4.0)), 0);
    assert_eq!(flight.current(), 4);
    assert_eq!(flight.bench.command(MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, seek(5.0)), 2);
    assert!(
        flight.bench.texts().iter().any(|text| text.contains("item 5 does not exist")),
        "{:?}",
        flight.bench.texts()
    );
    let flight = flight.complete(60.0);
    assert_eq!(flight.order(), [0, 4]);
}

#[test]
fn without_a_takeoff_item_it_climbs_first_and_without_a_mission_nothing_starts() {
    let mut bench = Bench::new(Identity::Px4);
    assert_eq!(bench.set_mode(Mode::Mission), 1, "there is no mission");
    let flight = Flight::new(&[waypoint([10.0, 0.0, -5.0])]).complete(60.0);
    let low = flight.track.iter().find(|(_, at, _)| at.x > 0.5).unwrap().1;
    assert!((low.z + 5.0).abs() < 0.5, "up, then there: {low}");
    assert!(flight.nearest([10.0, 0.0, -5.0]) < 0.5);
    // The mission is taken away in flight.
    let mut flight = Flight::new(&[takeoff(), waypoint([100.0, 0.0, -10.0])]);
    flight.fly_until("under way", 60.0, |flight| flight.bench.position()[0] > 10.0);
    assert_eq!(result(&upload(&mut flight.bench, PlanKind::Mission, &[])), Some(0));
    assert_eq!((flight.bench.mode(), flight.state()), (Mode::Hold, MissionState::None));
    flight.bench.fly(10.0);
    assert!(flight.bench.velocity()[0].abs() < 0.1);
}

/// An item that does not continue by itself waits for the pilot.
#[test]
fn an_item_can_wait_for_the_pilot() {
    let wait = MissionItem { autocontinue: false, ..waypoint([10.0, 0.0, -10.0]) };
    let mut flight = Flight::new(&[takeoff(), wait, waypoint([20.0, 0.0, -10.0])]);
    flight.fly_until("waits", 60.0, |flight| flight.bench.mode() == Mode::Hold);
    assert_eq!((flight.state(), flight.order()), (MissionState::Paused, vec![0, 1]));
    assert_eq!(flight.bench.set_mode(Mode::Mission), 0);
    assert_eq!(flight.complete(60.0).order(), [0, 1, 2]);
}

/// It is the wall clock's at the start that counts, and a record keeps it.
#[test]
fn a_delay_lasts_until_a_time_of_day() {
    // 2026-11-21 13:45:20.5 UTC, and until half past the next minute.
    const START_US: u64 = 1_795_268_720_500_000;
    let until = |parameters: [f64; 4]| {
        let mut vehicle = common::settings(Identity::Px4);
        let way = waypoint([10.0, 0.0, -10.0]);
        vehicle
            .plans
            .set(PlanKind::Mission, Plan::new(vec![takeoff(), simple(command::NAV_DELAY, parameters), way]));
        let mut recording = Recording::started_at(&vehicle, START_US, START_US);
        recording.send(common::command_long(MavCmd::MAV_CMD_MISSION_START, [0.0; 7], 0));
        let mut over_s = None;
        for millisecond in 1..=80_000_u32 {
            recording.bench.heard.clear();
            recording.step();
            let is_second = |message: &Message| matches!(message, Message::Typed(MavMessage::MISSION_ITEM_REACHED(item)) if item.seq == 1);
            if over_s.is_none() && recording.bench.heard.iter().any(is_second) {
                over_s = Some(f64::from(millisecond) / 1e3);
            }
        }
        recording.finish().assert_same();
        over_s.expect("the delay ends")
    };
    assert!((until([-1.0, 13.0, 46.0, 30.0]) - 69.5).abs() < 0.01);
    assert!((until([-1.0, -1.0, -1.0, 45.0]) - 24.5).abs() < 0.01);
}

/// A plan of the start, one of the messages and a pause: replayed it is the same flight, and it depends on the plan.
#[test]
fn a_mission_replays_bit_for_bit() {
    let mut vehicle = common::settings(Identity::Px4);
    vehicle.wind = vehicle::world::WindSettings { speed_m_s: 3.0, from_rad: 1.0, gusts_m_s: 1.0, seed: 5 };
    vehicle.configuration.airframe.drag_n_s_m = [0.15; 3];
    let roi = at(command::DO_SET_ROI_LOCATION, [0.0; 4], [20.0, 20.0, 0.0]);
    vehicle.plans.set(
        PlanKind::Mission,
        Plan::new(vec![takeoff(), roi, waypoint([30.0, 0.0, -12.0]), waypoint([30.0, 30.0, -8.0])]),
    );
    let mut recording = Recording::of(&vehicle);
    let changed = [waypoint([10.0, -10.0, -10.0]), simple(command::NAV_RETURN_TO_LAUNCH, [0.0; 4])];
    for millisecond in 0..40_000_u32 {
        let messages: Vec<Message> = match millisecond {
            500 => vec![common::command_long(MavCmd::MAV_CMD_MISSION_START, [0.0; 7], 0).into()],
            12_000 => vec![common::command_long(MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, [0.0; 7], 0).into()],
            15_000 => vec![
                common::command_long(
                    MavCmd::MAV_CMD_DO_PAUSE_CONTINUE,
                    [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
                    0,
                )
                .into(),
            ],
            17_000 => vec![count_message(PlanKind::Mission, 2).into()],
            // The second request is waited for, and the item comes late.
            17_020 => vec![item_message(PlanKind::Mission, 0, changed[0], true)],
            17_900 => vec![item_message(PlanKind::Mission, 1, changed[1], true)],
            _ => Vec::new(),
        };
        for message in messages {
            recording.send(message);
        }
        recording.step();
    }
    assert_eq!(recording.bench.mode(), Mode::Return, "{:?}", recording.bench.texts());
    let record = recording.finish();
    record.assert_same();
    // Another place in the plan of the start is another flight.
    record.assert_depends_on("[30.0,0.0,-12.0]", "[30.0,0.0,-12.5]");
}

/// PX4's suite (missed waypoint): home comes to be 5 m lower just before a waypoint, whose altitude is above home. The vehicle goes on to
/// where it is then, and passes it. ArduPilot takes home for the next leg.
#[test]
fn a_leg_follows_the_height_of_home_with_px4() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let relative = |command: u16, north_m: f64, height_m: f64| MissionItem {
            frame: frame::GLOBAL_RELATIVE_INT,
            command,
            parameters: [0.0, if command == command::NAV_WAYPOINT { 2.0 } else { 0.0 }, 0.0, 0.0],
            position: [47.397_742 + north_m / 111_194.9, 8.545_594, height_m],
            autocontinue: true,
        };
        let mut items = vec![
            relative(command::NAV_TAKEOFF, 0.0, 20.0),
            relative(command::NAV_WAYPOINT, 60.0, 20.0),
            relative(command::NAV_WAYPOINT, 100.0, 20.0),
            relative(command::NAV_WAYPOINT, 140.0, 20.0),
        ];
        if identity.is_ardupilot() {
            items.insert(0, relative(command::NAV_WAYPOINT, 0.0, 0.0));
        }
        let second = items.len() - 2;
        let mut flight = Flight::of(identity, &items);
        if identity.is_ardupilot() {
            assert_eq!(flight.bench.set_mode(Mode::Offboard), 0);
        }
        flight.bench.arm();
        assert_eq!(flight.bench.command(MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), 0);
        flight.bench.fly_until("near the waypoint", 120.0, |bench| {
            let vehicle = bench.autopilot.vehicle();
            vehicle.mission_status().current == second && vehicle.outputs().position_m.x > 90.0
        });
        let vehicle = flight.bench.autopilot.vehicle();
        let home_m = vehicle.home().position_m;
        let altitude_m = (vehicle.frame().origin().altitude_m - home_m.z - 5.0) as f32;
        let place = [0.0, 0.0, 0.0, f32::NAN, 47.397_742, 8.545_594, altitude_m];
        assert_eq!(flight.bench.command(MavCmd::MAV_CMD_DO_SET_HOME, place), 0, "{:?}", flight.bench.texts());
        flight.bench.fly_until("the waypoint", 60.0, |bench| {
            bench.autopilot.vehicle().mission_status().current > second
        });
        let height_m = home_m.z - flight.bench.autopilot.vehicle().outputs().position_m.z;
        let expected_m = if identity.is_ardupilot() { 20.0 } else { 15.0 };
        assert!((height_m - expected_m).abs() < 2.0, "{identity:?}: {height_m}");
        flight.bench.fly(25.0);
        let height_m = home_m.z - flight.bench.autopilot.vehicle().outputs().position_m.z;
        assert!((height_m - 15.0).abs() < 0.5, "{identity:?}: {height_m}");
    }
}
