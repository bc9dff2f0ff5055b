//! Ground with heights: stood on, landed on, measured and flown over. The oracles are the formulas of the hills.

use crate::common;
use crate::common::Bench;
use crate::common::failsafe_bench::set;
use crate::common::plan_client::{result, upload};
use autopilot::codec::Message;
use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::*;
use nalgebra::Vector3;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, PlanKind, command, frame};
use vehicle::surroundings::{Hill, Relief, Terrain};
use vehicle::{MissionState, Mode, VehicleSettings};

/// Height of the plateau, m, level within 10 m around 40 m north, and its foot 20 m away from there.
const PLATEAU_M: f64 = 12.0;
const PLATEAU: Hill = Hill { centre_m: [40.0, 0.0], radius_m: 20.0, top_m: 10.0, height_m: PLATEAU_M };

fn settings(identity: Identity, hill: Hill) -> VehicleSettings {
    let mut settings = common::settings(identity);
    settings.surroundings.terrain = Terrain::new(Relief { grid: None, hills: vec![hill] });
    settings
}

fn latest<T>(bench: &Bench, of: impl Fn(&MavMessage) -> Option<T>) -> Option<T> {
    bench.heard.iter().rev().find_map(|message| match message {
        Message::Typed(message) => of(message),
        _ => None,
    })
}

fn asked<T>(bench: &mut Bench, id: u32, of: impl Fn(&MavMessage) -> Option<T>) -> Option<T> {
    bench.heard.clear();
    let asked = [id as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, asked), 0);
    latest(bench, of)
}

/// A place on the map, degrees, and an altitude in a frame, m.
fn global(bench: &Bench, command: u16, frame: u8, place_m: [f64; 2], altitude_m: f64) -> MissionItem {
    let place = bench.autopilot.vehicle().frame().to_geodetic(&Vector3::new(place_m[0], place_m[1], 0.0));
    let position = [place.latitude_deg, place.longitude_deg, altitude_m];
    MissionItem { frame, command, parameters: [0.0; 4], position, autocontinue: true }
}

fn start(bench: &mut Bench, items: &[MissionItem]) {
    assert_eq!(result(&upload(bench, PlanKind::Mission, items)), Some(0));
    bench.arm();
    assert_eq!(bench.set_mode(Mode::Mission), 0);
}

/// It lands 12 m above home, sinks to its feet's 4 mm, disarms, stays, and takes off again from there.
#[test]
fn a_vehicle_lands_on_a_plateau_and_takes_off_from_it() {
    let mut bench = Bench::of(&settings(Identity::Px4, PLATEAU));
    let items = [
        global(&bench, command::NAV_TAKEOFF, frame::GLOBAL_RELATIVE, [0.0, 0.0], 18.0),
        global(&bench, command::NAV_WAYPOINT, frame::GLOBAL_RELATIVE, [40.0, 0.0], 18.0),
        global(&bench, command::NAV_LAND, frame::GLOBAL_RELATIVE, [40.0, 0.0], 0.0),
    ];
    start(&mut bench, &items);
    bench.fly_until("it has landed", 90.0, |bench| !bench.autopilot.vehicle().is_armed());
    bench.fly(2.0);
    let [north_m, _, z_m] = bench.position();
    assert!((north_m - 40.0).abs() < 0.5, "{north_m}");
    assert!((z_m + PLATEAU_M - 9.81 / 2500.0).abs() < 1e-3, "{z_m}");
    bench.arm();
    assert_eq!(bench.set_mode(Mode::Takeoff), 0);
    bench.fly(8.0);
    assert!((bench.position()[2] + PLATEAU_M + 2.5).abs() < 0.2, "home has moved: {:?}", bench.position());
}

/// 18 m above home it is 6 m above the plateau: for the rangefinder, ALTITUDE and TERRAIN_REPORT, while TERRAIN_CHECK asks about the
/// slope half-way down, which is half as high.
#[test]
fn heights_above_the_ground_are_told() {
    let mut bench = Bench::hovering_with(&settings(Identity::ArduPilot, PLATEAU));
    let place_m = Vector3::new(40.0, 3.0, 0.0);
    fly_to(&mut bench, MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT, &place_m, 18.0);
    let origin_m = bench.autopilot.vehicle().frame().origin().altitude_m;
    let report = |message: &MavMessage| match message {
        MavMessage::TERRAIN_REPORT(report) => Some(report.clone()),
        _ => None,
    };
    let below = asked(&mut bench, TERRAIN_REPORT_DATA::ID, report).expect("a report");
    assert!((f64::from(below.terrain_height) - origin_m - PLATEAU_M).abs() < 0.01, "{below:?}");
    assert!((below.current_height - 6.0).abs() < 0.15, "{below:?}");
    let altitude = asked(&mut bench, ALTITUDE_DATA::ID, |message| match message {
        MavMessage::ALTITUDE(altitude) => Some(altitude.clone()),
        _ => None,
    });
    let altitude = altitude.expect("asked for");
    for above_m in [altitude.altitude_terrain, altitude.bottom_clearance] {
        assert!((above_m - 6.0).abs() < 0.15, "{altitude:?}");
    }
    assert!((altitude.altitude_relative - 18.0).abs() < 0.15, "{altitude:?}");
    let range = asked(&mut bench, DISTANCE_SENSOR_DATA::ID, |message| match message {
        MavMessage::DISTANCE_SENSOR(range) => Some(range.current_distance),
        _ => None,
    });
    assert!(range.expect("it looks down").abs_diff(600) < 15, "{range:?}");
    let slope = bench.autopilot.vehicle().frame().to_geodetic(&Vector3::new(25.0, 0.0, 0.0));
    let [lat, lon] = [slope.latitude_deg, slope.longitude_deg].map(|degrees| (degrees * 1e7).round() as i32);
    bench.heard.clear();
    bench.send(MavMessage::TERRAIN_CHECK(TERRAIN_CHECK_DATA { lat, lon }));
    bench.fly(0.1);
    let there = latest(&bench, report).expect("an answer");
    assert!((f64::from(there.terrain_height) - origin_m - PLATEAU_M / 2.0).abs() < 0.02, "{there:?}");
}

/// MPC_ALT_MODE: up a hill of 6 m by the stick, it rises with the ground only if it is to follow that on the way.
#[test]
fn position_mode_keeps_the_height_that_it_is_to_keep() {
    let hill = Hill { centre_m: [70.0, 0.0], radius_m: 60.0, top_m: 15.0, height_m: 6.0 };
    for (mode, rises_m) in [(0.0, 0.0), (1.0, hill.height_m), (2.0, 0.0)] {
        let mut bench = Bench::hovering_with(&settings(Identity::Px4, hill));
        set(&mut bench, "MPC_ALT_MODE", mode);
        let mut pulses = [1500; vehicle::radio::CHANNELS];
        bench.autopilot.receive_radio(pulses);
        bench.fly(0.5);
        assert_eq!(bench.set_mode(Mode::Position), 0);
        bench.fly(2.0);
        let from_m = bench.position();
        pulses[1] = 1300;
        bench.autopilot.receive_radio(pulses);
        bench.fly_until("the top", 90.0, |bench| bench.position()[0] > 64.0);
        pulses[1] = 1500;
        bench.autopilot.receive_radio(pulses);
        bench.fly(8.0);
        let risen_m = from_m[2] - bench.position()[2];
        assert!((risen_m - rises_m).abs() < 0.3, "MPC_ALT_MODE {mode}: {risen_m} m, {:?}", bench.texts());
    }
}

/// Set-points and DO_REPOSITION above the terrain lead to the height above the ground there.
#[test]
fn targets_above_the_terrain_are_above_the_ground_there() {
    let mut bench = Bench::hovering_with(&settings(Identity::ArduPilot, PLATEAU));
    let place_m = Vector3::new(40.0, 3.0, 0.0);
    fly_to(&mut bench, MavFrame::MAV_FRAME_GLOBAL_TERRAIN_ALT, &place_m, 7.0);
    assert!((bench.position()[2] + PLATEAU_M + 7.0).abs() < 0.1, "{:?}", bench.position());
    let place = bench.autopilot.vehicle().frame().to_geodetic(&Vector3::new(45.0, -2.0, 0.0));
    bench.send(MavMessage::COMMAND_INT(COMMAND_INT_DATA {
        target_system: 1,
        target_component: 1,
        frame: MavFrame::MAV_FRAME_GLOBAL_TERRAIN_ALT,
        command: MavCmd::MAV_CMD_DO_REPOSITION,
        param1: -1.0,
        x: (place.latitude_deg * 1e7).round() as i32,
        y: (place.longitude_deg * 1e7).round() as i32,
        z: 9.0,
        ..COMMAND_INT_DATA::default()
    }));
    bench.fly(12.0);
    assert!(bench.is_near([45.0, -2.0, -PLATEAU_M - 9.0]), "{:?}", bench.position());
}

fn fly_to(bench: &mut Bench, coordinate_frame: MavFrame, place_m: &Vector3<f64>, alt: f32) {
    let target = place_target(bench, coordinate_frame, place_m, alt);
    bench.send(target);
    bench.fly(25.0);
}

fn place_target(bench: &Bench, coordinate_frame: MavFrame, place_m: &Vector3<f64>, alt: f32) -> MavMessage {
    let place = bench.autopilot.vehicle().frame().to_geodetic(place_m);
    MavMessage::SET_POSITION_TARGET_GLOBAL_INT(SET_POSITION_TARGET_GLOBAL_INT_DATA {
        target_system: 1,
        target_component: 1,
        coordinate_frame,
        type_mask: PositionTargetTypemask::from_bits_retain(0x0DF8),
        lat_int: (place.latitude_deg * 1e7).round() as i32,
        lon_int: (place.longitude_deg * 1e7).round() as i32,
        alt,
        ..SET_POSITION_TARGET_GLOBAL_INT_DATA::default()
    })
}

/// Waypoints on a hill, 10 m above the terrain each: it rests at that height over the ground of each of them.
#[test]
fn waypoints_above_the_terrain_are_above_the_ground_there() {
    let hill = Hill { centre_m: [80.0, 0.0], radius_m: 60.0, top_m: 0.0, height_m: 20.0 };
    let places_m = [20.0, 50.0, 80.0, 95.0, 110.0, 150.0];
    let mut bench = Bench::hovering_with(&settings(Identity::ArduPilot, hill));
    let mut items = vec![global(&bench, command::NAV_WAYPOINT, frame::GLOBAL, [0.0, 0.0], 0.0)];
    items.extend(places_m.map(|north_m| {
        let item = global(&bench, command::NAV_WAYPOINT, frame::GLOBAL_TERRAIN, [north_m, 0.0], 10.0);
        MissionItem { parameters: [2.0, 0.0, 0.0, 0.0], ..item }
    }));
    assert_eq!(result(&upload(&mut bench, PlanKind::Mission, &items)), Some(0));
    assert_eq!(bench.set_mode(Mode::Mission), 0);
    for north_m in places_m {
        // Half a wave of a cosine, 20 m high.
        let off = f64::min((north_m - 80.0_f64).abs() / 60.0, 1.0);
        let ground_m = 10.0 * (1.0 + (std::f64::consts::PI * off).cos());
        let there = [north_m, 0.0, -ground_m - 10.0];
        bench.fly_until("it rests there", 60.0, |bench| bench.is_near(there));
    }
    bench.fly_until("the end", 10.0, |bench| {
        bench.autopilot.vehicle().mission_status().state == MissionState::Complete
    });
}

/// A ridge 20 m high, 120 m wide at its foot, between two places on level ground.
const RIDGE: Hill = Hill { centre_m: [80.0, 0.0], radius_m: 60.0, top_m: 0.0, height_m: 20.0 };

/// Height above the ground of that hill, from its formula, m.
fn above_ridge_m([north_m, east_m, z_m]: [f64; 3]) -> f64 {
    let off = f64::min((north_m - 80.0).hypot(east_m) / 60.0, 1.0);
    -z_m - 10.0 * (1.0 + (std::f64::consts::PI * off).cos())
}

/// Two legs over a hill, 10 and then 10 to 15 m above the ground, through the corner between them without a stop: the height is that
/// all the way, while a straight way would scrape the top at 10 m below it.
#[test]
fn a_way_above_the_terrain_follows_the_ground() {
    let mut bench = Bench::hovering_with(&settings(Identity::ArduPilot, RIDGE));
    let waypoint = |bench: &Bench, place_m, above_m| {
        global(bench, command::NAV_WAYPOINT, frame::GLOBAL_TERRAIN, place_m, above_m)
    };
    let items = [
        global(&bench, command::NAV_WAYPOINT, frame::GLOBAL, [0.0, 0.0], 0.0),
        waypoint(&bench, [0.0, 0.0], 10.0),
        waypoint(&bench, [110.0, 0.0], 10.0),
        waypoint(&bench, [110.0, 80.0], 15.0),
    ];
    assert_eq!(result(&upload(&mut bench, PlanKind::Mission, &items)), Some(0));
    assert_eq!(bench.set_mode(Mode::Mission), 0);
    bench.fly_until("it is above the first place", 30.0, |bench| bench.is_near([0.0, 0.0, -10.0]));
    let (mut slowest_m_s, mut highest_m) = (f64::INFINITY, 0.0_f64);
    for _ in 0..1200 {
        let [north_m, east_m, z_m] = bench.position();
        let expected_m = 10.0 + if north_m > 108.0 { 5.0 * (east_m / 80.0).clamp(0.0, 1.0) } else { 0.0 };
        let above_m = above_ridge_m([north_m, east_m, z_m]);
        assert!((above_m - expected_m).abs() < 0.4, "{above_m} m at {north_m} {east_m}");
        if (20.0..150.0).contains(&(north_m + east_m)) {
            slowest_m_s = slowest_m_s.min(bench.autopilot.vehicle().truth().velocity_m_s.norm());
        }
        highest_m = highest_m.max(-z_m);
        bench.fly(0.1);
    }
    assert!((highest_m - 30.0).abs() < 0.3, "over the top: {highest_m}");
    assert!(slowest_m_s > 0.5, "it does not stop: {slowest_m_s}");
    assert!(bench.is_near([110.0, 80.0, -15.0]), "{:?}", bench.position());
    assert_eq!(bench.autopilot.vehicle().mission_status().state, MissionState::Complete);
}

/// RTL_ALT_TYPE = 1: home over a hill at RTL_ALT, 15 m, above the ground, and down there.
#[test]
fn a_return_follows_the_ground_if_it_is_to() {
    let mut bench = Bench::hovering_with(&settings(Identity::ArduPilot, RIDGE));
    set(&mut bench, "RTL_ALT_TYPE", 1.0);
    let place_m = Vector3::new(150.0, 0.0, 0.0);
    fly_to(&mut bench, MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT, &place_m, 40.0);
    bench.fly(20.0);
    fly_to(&mut bench, MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT, &place_m, 5.0);
    assert!(bench.is_near([150.0, 0.0, -5.0]), "{:?}", bench.position());
    assert_eq!(bench.set_mode(Mode::Return), 0);
    bench.fly_until("it has climbed", 20.0, |bench| bench.position()[0] < 149.9);
    bench.fly_until("it is above home", 120.0, |bench| {
        let position_m = bench.position();
        let above_m = above_ridge_m(position_m);
        assert!((above_m - 15.0).abs() < 0.6, "{above_m} m at {position_m:?}");
        position_m[0].abs() < 0.1
    });
    bench.fly_until("it has landed", 60.0, |bench| !bench.autopilot.vehicle().is_armed());
}

/// CONDITION_YAW on such a way turns the nose to the east, whatever the way's direction.
#[test]
fn the_nose_turns_on_a_way_above_the_terrain() {
    let mut bench = Bench::hovering_with(&settings(Identity::ArduPilot, RIDGE));
    let waypoint =
        |bench: &Bench, place_m| global(bench, command::NAV_WAYPOINT, frame::GLOBAL_TERRAIN, place_m, 10.0);
    let east = MissionItem {
        frame: frame::MISSION,
        command: command::CONDITION_YAW,
        parameters: [90.0, 0.0, 0.0, 0.0],
        position: [0.0; 3],
        autocontinue: true,
    };
    let items = [
        global(&bench, command::NAV_WAYPOINT, frame::GLOBAL, [0.0, 0.0], 0.0),
        waypoint(&bench, [0.0, 0.0]),
        east,
        waypoint(&bench, [110.0, 0.0]),
        waypoint(&bench, [110.0, 80.0]),
    ];
    assert_eq!(result(&upload(&mut bench, PlanKind::Mission, &items)), Some(0));
    assert_eq!(bench.set_mode(Mode::Mission), 0);
    bench.fly_until("it is over the hill", 60.0, |bench| bench.position()[0] > 60.0);
    let mut widest_deg = 0.0_f64;
    while bench.position()[0] < 100.0 {
        bench.fly(0.1);
        let off_deg = bench.autopilot.vehicle().truth().attitude_rad.z.to_degrees() - 90.0;
        widest_deg = widest_deg.max(off_deg.abs());
    }
    assert!(widest_deg < 1.0, "{widest_deg} deg off the east");
}

const TERRAIN: MavFrame = MavFrame::MAV_FRAME_GLOBAL_TERRAIN_ALT;

/// DO_REPOSITION to a place, north and east, m, and a height above the ground there, m.
fn reposition(bench: &mut Bench, place_m: [f64; 2], above_m: f32) {
    let place = bench.autopilot.vehicle().frame().to_geodetic(&Vector3::new(place_m[0], place_m[1], 0.0));
    bench.send(MavMessage::COMMAND_INT(COMMAND_INT_DATA {
        target_system: 1,
        target_component: 1,
        frame: TERRAIN,
        command: MavCmd::MAV_CMD_DO_REPOSITION,
        param1: -1.0,
        param4: f32::NAN,
        x: (place.latitude_deg * 1e7).round() as i32,
        y: (place.longitude_deg * 1e7).round() as i32,
        z: above_m,
        ..COMMAND_INT_DATA::default()
    }));
}

/// The same by ArduPilot's item that is a goal of the guided mode.
fn guided_item(bench: &mut Bench, place_m: [f64; 2], above_m: f32) {
    let place = bench.autopilot.vehicle().frame().to_geodetic(&Vector3::new(place_m[0], place_m[1], 0.0));
    bench.send(MavMessage::MISSION_ITEM_INT(MISSION_ITEM_INT_DATA {
        target_system: 1,
        target_component: 1,
        frame: TERRAIN,
        command: MavCmd::MAV_CMD_NAV_WAYPOINT,
        current: 2,
        x: (place.latitude_deg * 1e7).round() as i32,
        y: (place.longitude_deg * 1e7).round() as i32,
        z: above_m,
        ..MISSION_ITEM_INT_DATA::default()
    }));
}

/// Flies until it rests at a place, north, at 10 m above the ground, as it is all the way. Whoever sends anything does it before each
/// tenth of a second. Returns the slowest between 20 and 100 m north, m/s.
fn fly_over_ridge(bench: &mut Bench, north_m: f64, mut send: impl FnMut(&mut Bench)) -> f64 {
    let (mut slowest_m_s, mut highest_m) = (f64::INFINITY, 0.0_f64);
    for _ in 0..1200 {
        send(bench);
        bench.fly(0.1);
        let position_m = bench.position();
        let above_m = above_ridge_m(position_m);
        assert!((above_m - 10.0).abs() < 0.4, "{above_m} m at {position_m:?}");
        if (20.0..100.0).contains(&position_m[0]) {
            slowest_m_s = slowest_m_s.min(bench.autopilot.vehicle().truth().velocity_m_s.norm());
        }
        highest_m = highest_m.max(-position_m[2]);
        if bench.is_near([north_m, 0.0, -10.0]) {
            break;
        }
    }
    assert!((highest_m - 30.0).abs() < 0.4, "over the top: {highest_m}");
    assert!(bench.is_near([north_m, 0.0, -10.0]), "{:?}", bench.position());
    slowest_m_s
}

/// A place behind the ridge, 10 m above the ground, that a message names once.
#[test]
fn the_way_to_a_place_above_the_terrain_follows_the_ground() {
    for (identity, ask) in [
        (Identity::Px4, reposition as fn(&mut Bench, [f64; 2], f32)),
        (Identity::ArduPilot, reposition),
        (Identity::ArduPilot, guided_item),
        (Identity::ArduPilot, |bench, [north_m, east_m], above_m| {
            let target = place_target(bench, TERRAIN, &Vector3::new(north_m, east_m, 0.0), above_m);
            bench.send(target);
        }),
    ] {
        let mut bench = Bench::hovering_with(&settings(identity, RIDGE));
        bench.fly(0.1);
        ask(&mut bench, [150.0, 0.0], 10.0);
        bench.fly(0.1);
        let there_m = bench.autopilot.vehicle().destination_m().expect("a place");
        assert!((there_m - Vector3::new(150.0, 0.0, -10.0)).norm() < 0.1, "{there_m}");
        let slowest_m_s = fly_over_ridge(&mut bench, 150.0, |_| {});
        assert!(slowest_m_s > 0.5, "it does not stop: {slowest_m_s}");
    }
}

/// Ten times a second, the same place again, or one that trembles, or one that moves on: it never stops on the way.
#[test]
fn places_that_are_streamed_above_the_terrain_do_not_stop_it() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        for (from_m, speed_m, trembles_m) in [(150.0, 0.0, 0.0), (150.0, 0.0, 0.1), (120.0, 0.2, 0.0)] {
            let mut bench = Bench::hovering_with(&settings(identity, RIDGE));
            let mut sent = 0_u32;
            let mut send = move |bench: &mut Bench| {
                let moved_m = (f64::from(sent) * speed_m).min(150.0 - from_m);
                let off_m = if bench.position()[0] < 140.0 { trembles_m * f64::from(sent % 3) } else { 0.0 };
                let place_m = Vector3::new(from_m + moved_m, off_m, 0.0);
                let target = place_target(bench, TERRAIN, &place_m, 10.0);
                bench.send(target);
                sent += 1;
            };
            if identity == Identity::Px4 {
                send(&mut bench);
                assert_eq!(bench.set_mode(Mode::Offboard), 0);
            }
            let slowest_m_s = fly_over_ridge(&mut bench, 150.0, send);
            assert!(slowest_m_s > 0.5, "{from_m} {speed_m} {trembles_m}: {slowest_m_s}");
        }
    }
}

/// Commands that repeat do not stop it either.
#[test]
fn repositions_above_the_terrain_that_repeat_go_on() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut bench = Bench::hovering_with(&settings(identity, RIDGE));
        let slowest_m_s = fly_over_ridge(&mut bench, 150.0, |bench| reposition(bench, [150.0, 0.0], 10.0));
        assert!(slowest_m_s > 0.5, "{identity:?}: {slowest_m_s}");
    }
}

/// Asked to go farther on its way over level ground, it begins the way along the ground in flight. A pause on the slope holds it there,
/// and then it goes on along the ground.
#[test]
fn a_way_along_the_ground_begins_in_flight_and_goes_on_after_a_pause() {
    let mut bench = Bench::hovering_with(&settings(Identity::ArduPilot, RIDGE));
    let send = |bench: &mut Bench, north_m| {
        let target = place_target(bench, TERRAIN, &Vector3::new(north_m, 0.0, 0.0), 10.0);
        bench.send(target);
    };
    send(&mut bench, 18.0);
    bench.fly_until("it cruises", 20.0, |bench| bench.position()[0] > 8.0);
    send(&mut bench, 150.0);
    while bench.position()[0] < 50.0 {
        bench.fly(0.01);
        let velocity_m_s = bench.velocity();
        assert!(velocity_m_s[0] > 0.5, "{velocity_m_s:?}");
    }
    let pause = |bench: &mut Bench, goes_on: f32| {
        let asked = [goes_on, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(bench.command(MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, asked), 0);
    };
    pause(&mut bench, 0.0);
    bench.fly(6.0);
    let held_m = bench.position();
    assert!(held_m[0] < 70.0, "{held_m:?}");
    bench.fly(3.0);
    assert!(bench.is_near(held_m), "{held_m:?} {:?}", bench.position());
    pause(&mut bench, 1.0);
    let from_m = above_ridge_m(held_m);
    bench.fly_until("it is there", 90.0, |bench| {
        let position_m = bench.position();
        let above_m = above_ridge_m(position_m);
        let share = (position_m[0] - held_m[0]) / (150.0 - held_m[0]);
        let expected_m = from_m + (10.0 - from_m) * share;
        assert!((above_m - expected_m).abs() < 0.4, "{above_m} m at {position_m:?}");
        bench.is_near([150.0, 0.0, -10.0])
    });
}

/// Set-points lift a vehicle straight up from the ground, and lead it over the ridge.
#[test]
fn places_above_the_terrain_lead_up_from_the_ground() {
    let mut bench = Bench::of(&settings(Identity::Px4, RIDGE));
    let target = place_target(&bench, TERRAIN, &Vector3::new(150.0, 0.0, 0.0), 10.0);
    bench.send(target.clone());
    bench.fly(0.1);
    bench.arm();
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    while bench.position()[2] > -9.7 {
        bench.send(target.clone());
        bench.fly(0.1);
        assert!(bench.position()[0] < 0.1 && bench.autopilot.vehicle().is_armed(), "{:?}", bench.position());
    }
    fly_over_ridge(&mut bench, 150.0, |bench| bench.send(target.clone()));
}

/// Called back on the way up, it stops along the ground, and comes back along it.
#[test]
fn a_place_behind_it_turns_it_back_along_the_ground() {
    let mut bench = Bench::hovering_with(&settings(Identity::ArduPilot, RIDGE));
    reposition(&mut bench, [150.0, 0.0], 10.0);
    bench.fly_until("it is on the slope", 60.0, |bench| bench.position()[0] > 50.0);
    reposition(&mut bench, [-20.0, 0.0], 10.0);
    let reference_m_s = |bench: &Bench| bench.autopilot.vehicle().outputs().setpoint.velocity_m_s;
    let (mut before_m_s, mut ticks) = (reference_m_s(&bench), 0);
    while !bench.is_near([-20.0, 0.0, -10.0]) {
        bench.fly(0.01);
        let now_m_s = reference_m_s(&bench);
        // Faster than 10 m/s² it would jump.
        assert!((now_m_s - before_m_s).norm() < 0.1, "from {before_m_s} to {now_m_s}");
        before_m_s = now_m_s;
        let position_m = bench.position();
        let above_m = above_ridge_m(position_m);
        assert!((above_m - 10.0).abs() < 0.4, "{above_m} m at {position_m:?}");
        ticks += 1;
        assert!(ticks < 12_000, "it is not back: {position_m:?}");
    }
}
