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
    let place = bench.autopilot.vehicle().frame().to_geodetic(place_m);
    bench.send(MavMessage::SET_POSITION_TARGET_GLOBAL_INT(SET_POSITION_TARGET_GLOBAL_INT_DATA {
        target_system: 1,
        target_component: 1,
        coordinate_frame,
        type_mask: PositionTargetTypemask::from_bits_retain(0x0DF8),
        lat_int: (place.latitude_deg * 1e7).round() as i32,
        lon_int: (place.longitude_deg * 1e7).round() as i32,
        alt,
        ..SET_POSITION_TARGET_GLOBAL_INT_DATA::default()
    }));
    bench.fly(25.0);
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
