//! PX4's returns along a mission: RTL_TYPE 2 and 4.

use crate::common::failsafe_bench::set;
use crate::common::mission_flight::{Flight, NAN, at, takeoff, waypoint};
use crate::common::plan_client::{result, upload};
use vehicle::Mode;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, PlanKind, command};

/// Three corners of a square.
const CORNERS: [[f64; 3]; 3] = [[40.0, 0.0, -10.0], [40.0, 40.0, -12.0], [0.0, 40.0, -14.0]];

fn square() -> Vec<MissionItem> {
    std::iter::once(takeoff()).chain(CORNERS.map(waypoint)).collect()
}

fn landing() -> MissionItem {
    at(command::NAV_LAND, [0.0, 0.0, 0.0, NAN], [0.0, 60.0, 0.0])
}

/// Returns in a mode of RTL_TYPE once the vehicle is so far along its way; flown to the end.
fn returned(items: &[MissionItem], kind: f64, leaves: impl Fn(&Flight) -> bool) -> Flight {
    let mut flight = Flight::of(Identity::Px4, items);
    set(&mut flight.bench, "RTL_TYPE", kind);
    flight.bench.arm();
    assert_eq!(flight.bench.set_mode(Mode::Mission), 0);
    flight.fly_until("the turn back", 90.0, leaves);
    assert_eq!(flight.bench.set_mode(Mode::Return), 0);
    flight.track.clear();
    for _ in 0..300 {
        flight.step();
        assert_eq!(flight.bench.mode(), Mode::Return);
    }
    flight.fly_until("landed", 200.0, |flight| !flight.bench.autopilot.vehicle().is_armed());
    flight
}

/// Where it ends, north and east, m.
fn end_m(flight: &Flight) -> [f64; 2] {
    let place_m = flight.track.last().expect("flown").1;
    [place_m.x, place_m.y]
}

fn is_near([north_m, east_m]: [f64; 2], place_m: [f64; 2]) -> bool {
    (north_m - place_m[0]).hypot(east_m - place_m[1]) < 0.6
}

fn flies_the_last_side(flight: &Flight) -> bool {
    let [x, y, _] = flight.bench.position();
    y > 38.0 && x < 20.0
}

/// A mission without a landing is flown back, corner by corner, at their heights; by RTL_TYPE 0 the way is straight.
#[test]
fn a_mission_without_a_landing_is_flown_back() {
    for kind in [2.0, 4.0] {
        let flight = returned(&square(), kind, flies_the_last_side);
        assert!(flight.nearest(CORNERS[1]) < 0.6 && flight.nearest(CORNERS[0]) < 0.6, "RTL_TYPE {kind}");
        assert!(is_near(end_m(&flight), [0.0, 0.0]), "{:?}", end_m(&flight));
        let highest_m = flight.track.iter().map(|(_, at, _)| -at.z).fold(0.0, f64::max);
        assert!(highest_m < 16.0, "it climbs to no height of its own: {highest_m} m");
    }
    let straight = returned(&square(), 0.0, flies_the_last_side);
    assert!(straight.nearest(CORNERS[0]) > 10.0 && is_near(end_m(&straight), [0.0, 0.0]));
}

/// With a landing it goes on to that, or by RTL_TYPE 4 back where that passes fewer items.
#[test]
fn a_mission_with_a_landing_is_flown_on_or_back() {
    let items: Vec<_> = square().into_iter().chain([landing()]).collect();
    let on = returned(&items, 2.0, |flight| flight.bench.position()[0] > 15.0);
    assert!(CORNERS.iter().all(|corner| on.nearest(*corner) < 0.6), "each corner");
    assert!(is_near(end_m(&on), [0.0, 60.0]), "{:?}", end_m(&on));
    let back = returned(&items, 4.0, |flight| flight.bench.position()[0] > 15.0);
    assert!(is_near(end_m(&back), [0.0, 0.0]) && back.nearest(CORNERS[1]) > 20.0, "{:?}", end_m(&back));
    let late = returned(&items, 4.0, flies_the_last_side);
    assert!(is_near(end_m(&late), [0.0, 60.0]), "{:?}", end_m(&late));
}

/// Without a mission it returns straight, at its own height.
#[test]
fn without_a_mission_it_returns_straight() {
    let mut flight = Flight::of(Identity::Px4, &square());
    set(&mut flight.bench, "RTL_TYPE", 2.0);
    assert_eq!(result(&upload(&mut flight.bench, PlanKind::Mission, &[])), Some(0));
    flight.bench.arm();
    assert_eq!(flight.bench.set_mode(Mode::Takeoff), 0);
    flight.bench.fly(8.0);
    assert_eq!(flight.bench.set_mode(Mode::Return), 0);
    flight.fly_until("landed", 120.0, |flight| !flight.bench.autopilot.vehicle().is_armed());
    assert!(is_near(end_m(&flight), [0.0, 0.0]));
}
