//! Items of missions beside waypoints: curves, altitudes, tags, payloads, and what the vehicle does not carry.

use crate::common;
use crate::common::failsafe_bench::set;
use crate::common::mission_flight::{Flight, NAN, at, simple, takeoff, waypoint};
use mavlink::dialects::ardupilotmega::MavCmd;
use nalgebra::Vector3;
use vehicle::Mode;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, command};

fn spline(position: [f64; 3]) -> MissionItem {
    at(command::NAV_SPLINE_WAYPOINT, [0.0; 4], position)
}

/// ArduPilot's spline: through every place without a stop, and with the direction from the place before to the one behind.
#[test]
fn splines_lead_through_their_places_without_a_stop() {
    let places = [[30.0, 0.0, -10.0], [40.0, 30.0, -12.0], [0.0, 40.0, -10.0], [-5.0, 5.0, -10.0]];
    let mut items = vec![takeoff(), waypoint([0.0, 0.0, -10.0])];
    items.extend(places.map(spline));
    let flight = Flight::new(&items).complete(90.0);
    assert_eq!(flight.order(), [0, 1, 2, 3, 4, 5]);
    for place in places {
        assert!(flight.nearest(place) < 0.4, "{place:?}: {}", flight.nearest(place));
    }
    let (first_s, last_s) = (flight.time_of(2), flight.time_of(4));
    let track: Vec<_> = flight.between(first_s, last_s).copied().collect();
    let slowest = track.windows(11).map(|window| (window[10].1 - window[0].1).norm() / 0.1);
    let slowest = slowest.fold(f64::INFINITY, f64::min);
    assert!(slowest > 1.0, "{slowest} m/s");
    // At the second place it flies along the way from the first to the third.
    let passing =
        flight.between(flight.time_of(3) - 0.2, flight.time_of(3) + 0.2).copied().collect::<Vec<_>>();
    let along = (passing[passing.len() - 1].1 - passing[0].1).normalize();
    let expected = (Vector3::from(places[2]) - Vector3::from(places[0])).normalize();
    assert!(along.dot(&expected) > 0.97, "{along} {expected}");
    // The nose follows the curve.
    let heading = Vector3::new(passing[passing.len() / 2].2.cos(), passing[passing.len() / 2].2.sin(), 0.0);
    assert!(heading.dot(&along) > 0.9, "{heading}");
}

#[test]
fn an_altitude_is_come_to_at_its_place() {
    let there = [20.0, 0.0, -16.0];
    let items = [takeoff(), at(command::NAV_LOITER_TO_ALT, [0.0; 4], there), waypoint([0.0, 0.0, -16.0])];
    let flight = Flight::new(&items).complete(60.0);
    let reached = flight.track.iter().find(|(time_s, ..)| *time_s >= flight.time_of(1)).expect("reached").1;
    assert!((reached - Vector3::from(there)).norm() < 0.5, "{reached}");
    // On the way it keeps its height.
    let on_the_way = flight.track.iter().filter(|(_, at, _)| (5.0..18.0).contains(&at.x));
    let highest = on_the_way.take_while(|(time_s, ..)| *time_s < flight.time_of(1)).map(|(_, at, _)| -at.z);
    assert!(highest.fold(0.0, f64::max) < 11.0);
}

#[test]
fn tags_are_jumped_to_by_items_and_by_commands() {
    let items = [
        takeoff(),
        simple(command::JUMP_TAG, [7.0, 0.0, 0.0, 0.0]),
        waypoint([15.0, 0.0, -10.0]),
        waypoint([15.0, 15.0, -10.0]),
        simple(command::DO_JUMP_TAG, [7.0, 1.0, 0.0, 0.0]),
        waypoint([0.0, 0.0, -10.0]),
    ];
    let flight = Flight::new(&items).complete(90.0);
    assert_eq!(flight.order(), [0, 1, 2, 3, 4, 1, 2, 3, 5], "the jump is made once");
    let mut flight = Flight::new(&items);
    flight.fly_until("the last leg of the first round", 60.0, |flight| flight.order().contains(&2));
    let jump = |flight: &mut Flight, tag: f32| {
        flight.bench.command(MavCmd::MAV_CMD_DO_JUMP_TAG, [tag, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    };
    assert_eq!(jump(&mut flight, 8.0), 4, "there is no such tag");
    assert_eq!((jump(&mut flight, 7.0), flight.current()), (0, 1));
}

#[test]
fn a_landing_begins_at_its_mark() {
    let items = [
        MissionItem::home([47.397_742, 8.545_594, 488.0]),
        takeoff(),
        waypoint([60.0, 0.0, -10.0]),
        at(command::DO_LAND_START, [0.0; 4], [5.0, 0.0, 0.0]),
        waypoint([5.0, 0.0, -8.0]),
        at(command::NAV_LAND, [0.0; 4], [5.0, 5.0, 0.0]),
    ];
    let mut flight = Flight::of(Identity::ArduPilot, &items);
    assert_eq!(flight.bench.set_mode(Mode::Offboard), 0);
    flight.bench.arm();
    assert_eq!(flight.bench.set_mode(Mode::Mission), 0);
    flight.fly_until("on the way", 30.0, |flight| flight.bench.position()[0] > 20.0);
    assert_eq!(flight.bench.command(MavCmd::MAV_CMD_DO_LAND_START, [0.0; 7]), 0);
    flight.fly_until("landed", 60.0, |flight| !flight.bench.autopilot.vehicle().is_armed());
    let [x, y, _] = flight.bench.position();
    assert!((x - 5.0).abs() < 0.5 && (y - 5.0).abs() < 0.5, "{x} {y}");
    assert!(!flight.order().contains(&2), "the far waypoint was left out");
}

#[test]
fn a_payload_is_put_down_and_the_vehicle_comes_back_up() {
    for (descent_m, placed) in [(0.0, true), (3.0, false)] {
        let items = [
            takeoff(),
            at(command::NAV_PAYLOAD_PLACE, [descent_m, 0.0, 0.0, 0.0], [10.0, 0.0, -8.0]),
            waypoint([0.0, 0.0, -8.0]),
        ];
        let mut flight = Flight::new(&items);
        let mut texts = Vec::new();
        for _ in 0..9_000 {
            flight.step();
            texts.extend(flight.bench.texts());
            if flight.order().contains(&2) {
                break;
            }
        }
        assert_eq!(flight.order(), [0, 1, 2], "{texts:?}");
        let lowest = flight.track.iter().filter(|(_, at, _)| at.x > 5.0).map(|(_, at, _)| -at.z);
        let lowest = lowest.fold(f64::INFINITY, f64::min);
        let said = |text: &str| texts.iter().any(|line| line.contains(text));
        assert_eq!(lowest < 0.1, placed, "{lowest} m");
        assert_eq!((said("Payload placed"), said("Gripper load releasing")), (placed, placed), "{texts:?}");
        assert!(placed || said("Payload not placed") && (4.5..7.0).contains(&lowest), "{lowest} {texts:?}");
    }
}

#[test]
fn what_is_not_carried_is_passed_by_and_said() {
    let items = [
        takeoff(),
        simple(command::DO_SET_SERVO, [9.0, 1700.0, 0.0, 0.0]),
        simple(command::DO_PARACHUTE, [2.0, 0.0, 0.0, 0.0]),
        simple(command::DO_GRIPPER, [1.0, 0.0, 0.0, 0.0]),
        simple(command::DO_SET_SERVO, [1.0, 1700.0, 0.0, 0.0]),
        simple(command::DO_MOUNT_CONTROL, [-60.0, 0.0, 0.0, NAN]),
        waypoint([15.0, 0.0, -10.0]),
    ];
    let mut items = items;
    items[5].position[2] = 2.0;
    let mut flight = Flight::new(&items);
    let mut texts = Vec::new();
    while flight.now_s() < 60.0 && !flight.order().contains(&6) {
        flight.step();
        texts.extend(flight.bench.texts());
    }
    assert_eq!(flight.order(), [0, 1, 2, 3, 4, 5, 6]);
    let said = |text: &str| texts.iter().any(|line| line.contains(text));
    assert!(said("Mission: no parachute: skipped") && said("Mission: Servo 1 drives a rotor"), "{texts:?}");
    let equipment = flight.bench.autopilot.vehicle().equipment();
    assert_eq!(equipment.servos().pulse_us(9), 1700);
    assert!((equipment.gimbal().angles_rad().y.to_degrees() + 60.0).abs() < 0.5);
    // Guided control within a mission would have no end here.
    let guided = simple(command::NAV_GUIDED_ENABLE, [1.0, 0.0, 0.0, 0.0]);
    let heard = common::plan_client::upload(
        &mut flight.bench,
        vehicle::plan::PlanKind::Mission,
        &[takeoff(), guided],
    );
    assert_eq!(common::plan_client::result(&heard), Some(6), "MAV_MISSION_INVALID_PARAM1");
}

/// PX4: what stands behind CONDITION_GATE is done when the plane is crossed, and the vehicle flies on without a stop.
#[test]
fn what_is_behind_a_gate_waits_until_it_is_crossed() {
    let gate_m = 20.0;
    let items = [
        takeoff(),
        waypoint([0.0, 0.0, -10.0]),
        at(command::CONDITION_GATE, [0.0; 4], [gate_m, 5.0, -10.0]),
        simple(command::DO_CHANGE_SPEED, [1.0, 2.0, -1.0, 0.0]),
        waypoint([60.0, 0.0, -10.0]),
    ];
    let flight = Flight::new(&items).complete(90.0);
    assert_eq!(flight.order(), [0, 1, 2, 3, 4]);
    let crossed = flight.track.iter().find(|(time_s, ..)| *time_s >= flight.time_of(3)).expect("done").1;
    // It lies beside the way, so that the plane does not stand across it.
    assert!((crossed.x - gate_m).abs() < 1.5, "{crossed}");
    let speed = |from_m: f64| {
        let from = flight.track.iter().position(|(_, at, _)| at.x > from_m).expect("flown");
        (flight.track[from + 10].1 - flight.track[from].1).norm() / 0.1
    };
    assert!(speed(gate_m - 2.0) > 3.0 && (speed(40.0) - 2.0).abs() < 0.2, "{} {}", speed(18.0), speed(40.0));
}

/// PX4 takes NAV_ROI for DO_SET_ROI, which it was called before.
#[test]
fn the_nose_points_to_a_region_by_its_older_name() {
    let region = [20.0, 30.0, 0.0];
    let items = [
        takeoff(),
        at(command::NAV_ROI, [3.0, 0.0, 0.0, 0.0], region),
        waypoint([20.0, 0.0, -10.0]),
        waypoint([40.0, 0.0, -10.0]),
    ];
    let flight = Flight::new(&items).complete(60.0);
    let there = flight.track.iter().find(|(_, at, _)| at.x > 19.5).expect("flown");
    assert!((there.2.to_degrees() - 90.0).abs() < 8.0, "{} deg", there.2.to_degrees());
}

/// MPC_YAW_MODE 4: the nose turns before the vehicle flies; with 0 it does so on the way.
#[test]
fn the_nose_turns_to_a_place_before_it_is_flown_to() {
    let fly = |mode: f64| {
        let items = [takeoff(), waypoint([30.0, 0.0, -10.0]), waypoint([30.0, 30.0, -10.0])];
        let mut flight = Flight::of(Identity::Px4, &items);
        set(&mut flight.bench, "MPC_YAW_MODE", mode);
        flight.bench.arm();
        assert_eq!(flight.bench.set_mode(Mode::Mission), 0);
        let flight = flight.complete(90.0);
        let leaves = flight.track.iter().find(|(_, at, _)| at.y > 1.0).expect("flown");
        (leaves.2.to_degrees(), flight.nearest([30.0, 0.0, -10.0]))
    };
    let (turned_deg, nearest_m) = fly(4.0);
    assert!((turned_deg - 90.0).abs() < 14.0 && nearest_m < 0.3, "{turned_deg} deg, {nearest_m} m");
    let (turned_deg, nearest_m) = fly(0.0);
    assert!(turned_deg < 70.0 && nearest_m > 0.3, "{turned_deg} deg, {nearest_m} m");
}

/// PX4: a waypoint that asks for a heading is left only within MIS_YAW_ERR of it, on a short way by stopping there; with MIS_YAW_TMT
/// nothing is waited for.
#[test]
fn a_waypoint_is_left_with_the_heading_that_it_asks_for() {
    let north_of_home = |north_m: f64, heading_deg: f64| {
        at(command::NAV_WAYPOINT, [0.0, 2.0, 0.0, heading_deg], [north_m, 0.0, -10.0])
    };
    let items = [takeoff(), north_of_home(10.0, 0.0), north_of_home(16.0, 180.0), north_of_home(60.0, 90.0)];
    let off_deg = |parameter: Option<(&str, f64)>| {
        let mut flight = Flight::of(Identity::Px4, &items);
        parameter.into_iter().for_each(|(id, value)| set(&mut flight.bench, id, value));
        flight.bench.arm();
        assert_eq!(flight.bench.set_mode(Mode::Mission), 0);
        [(1, 0.0), (2, 180.0), (3, 90.0)].map(|(item, heading_deg)| {
            flight.fly_until("the waypoint", 60.0, |flight| flight.order().contains(&item));
            ((flight.heading_deg() - heading_deg + 180.0).rem_euclid(360.0) - 180.0).abs()
        })
    };
    let off = off_deg(None);
    assert!(off.iter().all(|off| *off < 12.0), "{off:?}");
    let exactly = off_deg(Some(("MIS_YAW_ERR", 3.0)));
    assert!(exactly.iter().all(|off| *off < 3.0), "{exactly:?}");
    let unheeded = off_deg(Some(("MIS_YAW_TMT", 5.0)));
    assert!(unheeded[1] > 45.0, "{unheeded:?}");
}
