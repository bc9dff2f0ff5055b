//! The way that a mission is planned to take, as pages draw it. The oracle is the flight.

use crate::common;
use crate::common::Bench;
use crate::common::plan_client::{result, upload};
use nalgebra::Vector3;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, PlanKind, command, frame};
use vehicle::surroundings::{Hill, Relief, Terrain};
use vehicle::{MissionState, Mode, PlannedLeg};

type Place = Vector3<f64>;

/// 15 m high and 100 m wide.
const HILL: Hill = Hill { centre_m: [60.0, 0.0], radius_m: 50.0, top_m: 0.0, height_m: 15.0 };

fn bench(identity: Identity, flies: bool) -> Bench {
    let mut settings = common::settings(identity);
    settings.surroundings.terrain = Terrain::new(Relief { grid: None, hills: vec![HILL] });
    if flies { Bench::hovering_with(&settings) } else { Bench::of(&settings) }
}

fn item(bench: &Bench, command: u16, frame: u8, [x, y, height_m]: [f64; 3], hold_s: f64) -> MissionItem {
    let place = bench.autopilot.vehicle().frame().to_geodetic(&Vector3::new(x, y, 0.0));
    let position = [place.latitude_deg, place.longitude_deg, height_m];
    MissionItem { frame, command, parameters: [hold_s, 0.0, 0.0, 0.0], position, autocontinue: true }
}

fn line_m(start_m: Place, legs: &[PlannedLeg]) -> Vec<Place> {
    let places = legs.iter().flat_map(|leg| leg.through_m.iter().chain([&leg.place_m]));
    [start_m].into_iter().chain(places.copied()).collect()
}

/// How far a place is from a line through places, m.
fn off_m(place_m: &Place, line_m: &[Place]) -> f64 {
    let from_side = |side: &[Place]| {
        let way = side[1] - side[0];
        let share = ((place_m - side[0]).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
        (side[0] + way * if share.is_finite() { share } else { 0.0 } - place_m).norm()
    };
    line_m.windows(2).map(from_side).fold(f64::INFINITY, f64::min)
}

/// Flies until the end; where it was, each 0.05 s.
fn flown_m(bench: &mut Bench, is_over: impl Fn(&Bench) -> bool) -> Vec<Place> {
    let mut places_m = Vec::new();
    for _ in 0..4_000 {
        places_m.push(Place::from(bench.position()));
        if is_over(bench) {
            return places_m;
        }
        bench.fly(0.05);
    }
    panic!("it does not arrive: {:?}", bench.position());
}

/// Neither leaves the plan by more, m, nor misses a place of it by more.
fn assert_same(flown_m: &[Place], planned_m: &[Place], within_m: f64) {
    for place_m in flown_m {
        let off_m = off_m(place_m, planned_m);
        assert!(off_m < within_m, "flown {off_m} m off the plan at {place_m:?}");
    }
    for place_m in planned_m {
        let off_m = off_m(place_m, flown_m);
        assert!(off_m < within_m, "planned {off_m} m off the flight at {place_m:?}");
    }
}

/// A mission that begins and ends on the ground is flown along its planned legs.
fn flies_from_the_ground(bench: &mut Bench, legs: &[PlannedLeg]) {
    bench.arm();
    assert_eq!(bench.set_mode(Mode::Mission), 0);
    bench.fly_until("it climbs", 5.0, |bench| {
        bench.autopilot.vehicle().is_armed() && bench.position()[2] < -0.1
    });
    let flown_m = flown_m(bench, |bench| !bench.autopilot.vehicle().is_armed());
    assert_same(&flown_m, &line_m(Vector3::zeros(), legs), 0.4);
}

/// Up to the height of a takeoff that no item asks for, over the hill 8 m above the ground, to another height at a place, and down on its slope.
#[test]
fn a_way_over_a_hill_is_flown_as_planned() {
    let mut bench = bench(Identity::Px4, false);
    let items = [
        item(&bench, command::NAV_WAYPOINT, frame::GLOBAL_TERRAIN, [100.0, 0.0, 8.0], 1.0),
        item(&bench, command::NAV_LOITER_TO_ALT, frame::GLOBAL_RELATIVE, [100.0, 30.0, 20.0], 0.0),
        item(&bench, command::NAV_LAND, frame::GLOBAL_RELATIVE, [60.0, 30.0, 0.0], 0.0),
    ];
    assert_eq!(result(&upload(&mut bench, PlanKind::Mission, &items)), Some(0));
    let legs = bench.autopilot.vehicle().planned_way();
    assert_eq!(legs.iter().map(|leg| leg.item).collect::<Vec<_>>(), [0, 1, 2]);
    assert!(legs[0].through_m.len() > 20, "the first way follows the ground: {:?}", legs[0].through_m);
    flies_from_the_ground(&mut bench, &legs);
}

/// A first step that changes the height only at its place is flown at the height of a takeoff, and turns are flown around theirs.
#[test]
fn a_height_that_comes_later_and_turns_are_flown_as_planned() {
    let mut bench = bench(Identity::Px4, false);
    let turns = item(&bench, command::NAV_LOITER_TURNS, frame::GLOBAL_RELATIVE, [-60.0, 20.0, 30.0], 1.25);
    let items = [
        item(&bench, command::NAV_LOITER_TO_ALT, frame::GLOBAL_RELATIVE, [-30.0, 20.0, 30.0], 0.0),
        MissionItem { parameters: [1.25, 0.0, 8.0, 0.0], ..turns },
        item(&bench, command::NAV_LAND, frame::GLOBAL_RELATIVE, [-60.0, 40.0, 0.0], 0.0),
    ];
    assert_eq!(result(&upload(&mut bench, PlanKind::Mission, &items)), Some(0));
    let legs = bench.autopilot.vehicle().planned_way();
    flies_from_the_ground(&mut bench, &legs);
}

/// A place that is named twice, and a way back over the same ground: each item has its leg.
#[test]
fn a_curve_that_rests_and_turns_back_is_flown_as_planned() {
    let mut bench = bench(Identity::Px4, true);
    let begin = item(&bench, command::NAV_WAYPOINT, frame::GLOBAL_RELATIVE, [0.0, 0.0, 25.0], 1.0);
    let places_m = [
        [-30.0, 0.0, 25.0],
        [-30.0, 0.0, 25.0],
        [-50.0, 20.0, 25.0],
        [-28.0, 2.0, 25.0],
        [-20.0, 30.0, 25.0],
    ];
    let curve = places_m
        .map(|place_m| item(&bench, command::NAV_SPLINE_WAYPOINT, frame::GLOBAL_RELATIVE, place_m, 0.0));
    let items = [[begin].as_slice(), &curve].concat();
    assert_eq!(result(&upload(&mut bench, PlanKind::Mission, &items)), Some(0));
    let legs = bench.autopilot.vehicle().planned_way();
    assert_eq!(legs.iter().map(|leg| leg.item).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5]);
    let (begin_m, line_m) = (legs[0].place_m, line_m(legs[0].place_m, &legs[1..]));
    assert_eq!(bench.set_mode(Mode::Mission), 0);
    bench.fly_until("it is where the curve begins", 30.0, |bench| bench.is_near(begin_m.into()));
    let over = |bench: &Bench| bench.autopilot.vehicle().mission_status().state == MissionState::Complete;
    let flown_m = flown_m(&mut bench, over);
    assert_same(&flown_m, &line_m, 0.3);
}

/// A curve through four places, which leaves the straight lines between them by metres.
#[test]
fn a_curve_is_flown_as_planned() {
    let mut bench = bench(Identity::ArduPilot, true);
    let home = item(&bench, command::NAV_WAYPOINT, frame::GLOBAL, [0.0; 3], 0.0);
    let begin = item(&bench, command::NAV_WAYPOINT, frame::GLOBAL_RELATIVE, [0.0, 0.0, 25.0], 1.0);
    let places_m = [[30.0, 0.0, 25.0], [40.0, 30.0, 28.0], [0.0, 40.0, 25.0], [-5.0, 5.0, 22.0]];
    let curve = places_m
        .map(|place_m| item(&bench, command::NAV_SPLINE_WAYPOINT, frame::GLOBAL_RELATIVE, place_m, 0.0));
    let items = [[home, begin].as_slice(), &curve].concat();
    assert_eq!(result(&upload(&mut bench, PlanKind::Mission, &items)), Some(0));
    let legs = bench.autopilot.vehicle().planned_way();
    assert_eq!(legs.len(), 5);
    let (begin_m, line_m) = (legs[0].place_m, line_m(legs[0].place_m, &legs[1..]));
    assert_eq!(bench.set_mode(Mode::Mission), 0);
    bench.fly_until("it is where the curve begins", 30.0, |bench| bench.is_near(begin_m.into()));
    let over = |bench: &Bench| bench.autopilot.vehicle().mission_status().state == MissionState::Complete;
    let flown_m = flown_m(&mut bench, over);
    assert_same(&flown_m, &line_m, 0.3);
    let straight_m: Vec<_> = legs.iter().map(|leg| leg.place_m).collect();
    let widest_m = flown_m.iter().map(|place_m| off_m(place_m, &straight_m)).fold(0.0, f64::max);
    assert!(widest_m > 2.0, "the curve is straight: {widest_m}");
}
