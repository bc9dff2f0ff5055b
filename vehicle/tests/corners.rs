//! Corners of missions that are passed without stopping, flown in the nonlinear closed loop.

use nalgebra::Vector3;
use proptest::prelude::*;
use quadrotor::{Configuration, Limits, PositionReference};
use vehicle::identity::Identity;
use vehicle::plan::{ChangeSpeed, MissionItem, PlanKind, command, frame};
use vehicle::world::WindSettings;
use vehicle::{MissionState, Mode, Vehicle, VehicleSettings};

const TAKEOFF: [f64; 3] = [0.0, 0.0, -10.0];
/// Ticks between two samples of the track.
const SAMPLE: usize = 10;
/// Samples of the track that are looked ahead: 0.3 s.
const AHEAD: u64 = 30;

fn item(command: u16, parameters: [f64; 4], position: [f64; 3]) -> MissionItem {
    MissionItem { frame: frame::LOCAL_NED, command, parameters, position, autocontinue: true }
}

fn waypoint(position: [f64; 3], radius_m: f64) -> MissionItem {
    item(command::NAV_WAYPOINT, [0.0, radius_m, 0.0, f64::NAN], position)
}

/// A flight from a hover at the place of the takeoff on, and what was seen of it every hundredth of a second.
struct Flight {
    vehicle: Vehicle,
    truth_m: Vec<Vector3<f64>>,
    reference: Vec<PositionReference>,
    /// What was expected of the reference [`AHEAD`] samples before.
    expected: Vec<PositionReference>,
    reached: Vec<(u16, usize)>,
}

impl Flight {
    fn new(speed_m_s: f64, wind: WindSettings, fence: Vec<MissionItem>, ways: Vec<MissionItem>) -> Self {
        let mut configuration = Configuration::default();
        configuration.limits.speed_horizontal_m_s = speed_m_s;
        configuration.airframe.drag_n_s_m = [0.15; 3];
        let settings = VehicleSettings { configuration, wind, ..VehicleSettings::new(Identity::Px4) };
        let mut vehicle = Vehicle::new(&settings).expect("valid settings");
        vehicle.set_plan(PlanKind::Fence, fence).expect("a fence");
        let takeoff = item(command::NAV_TAKEOFF, [0.0, 0.0, 0.0, f64::NAN], TAKEOFF);
        vehicle.set_plan(PlanKind::Mission, [vec![takeoff], ways].concat()).expect("a mission");
        vehicle.arm(false).expect("armed");
        vehicle.set_mode(Mode::Mission).expect("mission mode");
        let mut flight = Self {
            vehicle,
            truth_m: Vec::new(),
            reference: Vec::new(),
            expected: Vec::new(),
            reached: Vec::new(),
        };
        flight.fly_until("takeoff", |flight| !flight.reached.is_empty());
        flight
    }

    fn calm(ways: &[([f64; 3], f64)]) -> Self {
        let ways = ways.iter().map(|(place, radius_m)| waypoint(*place, *radius_m)).collect();
        Self::new(8.0, WindSettings::default(), Vec::new(), ways)
    }

    fn sample(&mut self) {
        for _ in 0..SAMPLE {
            self.vehicle.tick().expect("the flight goes on");
        }
        self.truth_m.push(self.vehicle.truth().position_m);
        self.reference.push(self.vehicle.outputs().setpoint);
        let ahead_us = self.vehicle.time_us() + AHEAD * 10_000;
        self.expected.push(self.vehicle.simulation().control().state().preview(ahead_us));
        let now = self.truth_m.len();
        self.reached.extend(self.vehicle.take_reached_items().into_iter().map(|item| (item, now)));
    }

    fn fly_until(&mut self, what: &str, condition: impl Fn(&Self) -> bool) {
        for _ in 0..40_000 {
            if condition(self) {
                return;
            }
            self.sample();
        }
        panic!("not within 400 s: {what}; {:?} {:?}", self.reached, self.vehicle.truth().position_m);
    }

    fn complete(mut self) -> Self {
        self.fly_until("complete", |flight| flight.vehicle.mission_status().state == MissionState::Complete);
        for _ in 0..200 {
            self.sample();
        }
        self
    }

    fn order(&self) -> Vec<u16> {
        self.reached.iter().map(|(item, _)| *item).collect()
    }

    fn nearest_m(&self, place: [f64; 3]) -> f64 {
        let distance = |at: &Vector3<f64>| (at - Vector3::from(place)).norm();
        self.truth_m.iter().map(distance).fold(f64::INFINITY, f64::min)
    }

    /// It rests at a place, and so does its reference.
    fn rests_at(&self, place: [f64; 3]) -> bool {
        let reference = self.reference.last().expect("flown");
        (reference.position_m - Vector3::from(place)).norm() < 0.1
            && reference.velocity_m_s.norm() < 1e-3
            && (self.truth_m.last().expect("flown") - Vector3::from(place)).norm() < 0.2
    }

    /// The reference moves without jumps and within the limits. Between the samples of the controllers it is carried on with the
    /// jerk of before: by a sample of 50 ms the acceleration may run over its limit.
    fn check_reference(&self, limits: &Limits) -> Result<(), TestCaseError> {
        const SAMPLE_S: f64 = 0.01;
        let over = 1.0 + 1.1 * 0.05 * limits.jerk_horizontal_m_s3 / limits.acceleration_horizontal_m_s2;
        let over_down = 1.0 + 1.1 * 0.05 * limits.jerk_vertical_m_s3 / limits.acceleration_vertical_m_s2;
        for pair in self.reference.windows(2) {
            let (v, a) = (pair[1].velocity_m_s, pair[1].acceleration_m_s2);
            prop_assert!(v.xy().norm() <= limits.speed_horizontal_m_s * 1.01, "{v}");
            prop_assert!(v.z <= limits.speed_down_m_s * 1.01 && v.z >= -limits.speed_up_m_s * 1.01, "{v}");
            prop_assert!(a.xy().norm() <= limits.acceleration_horizontal_m_s2 * over, "{a}");
            prop_assert!(a.z.abs() <= limits.acceleration_vertical_m_s2 * over_down, "{a}");
            let mean = (pair[0].velocity_m_s + v) / 2.0;
            let moved = pair[1].position_m - pair[0].position_m;
            prop_assert!((moved - mean * SAMPLE_S).norm() < 0.002, "a jump: {moved}");
        }
        Ok(())
    }

    /// The largest distance of the reference from the straight legs, m.
    fn beside_m(&self, places: &[[f64; 3]]) -> f64 {
        let off = |at: &Vector3<f64>| {
            let legs = places.windows(2).map(|leg| {
                let (from, to) = (Vector3::from(leg[0]), Vector3::from(leg[1]));
                let (way, along) = (to - from, at - from);
                let share = (along.dot(&way) / way.norm_squared().max(1e-12)).clamp(0.0, 1.0);
                (along - way * share).norm()
            });
            legs.fold(f64::INFINITY, f64::min)
        };
        let begin = self.reached[0].1;
        self.reference[begin..].iter().map(|reference| off(&reference.position_m)).fold(0.0, f64::max)
    }
}

/// Shortest time from 20 m before a right-angled corner to 20 m behind it, cruising at both ends, s: along the legs but for a blend
/// of constant acceleration that comes within a radius of the corner. No jerk limit.
///
/// On the blend the velocity changes by Δv = √2 v in T = Δv/a, its nearest place is Δv T/8 = v²/(4 a) from the corner, and it takes
/// v T/2 of each leg. A numerical optimum over all
/// accelerations within the limits, by scipy's SLSQP, is 0.03 % faster.
fn optimal_time_s(cruise: f64, a: f64, radius: f64) -> f64 {
    let v = cruise.min((4.0 * a * radius).sqrt());
    let blend = 2.0_f64.sqrt() * v / a;
    let (brake, braked) = ((cruise - v) / a, (cruise * cruise - v * v) / (2.0 * a));
    blend + 2.0 * (brake + (20.0 - v * blend / 2.0 - braked) / cruise)
}

/// On its straights, into its corners and out of them a mission flies what it expected 0.3 s before, to the jerk.
#[test]
fn a_mission_flies_what_it_expects() {
    let ways =
        [[30.0, 0.0, -10.0], [30.0, 25.0, -12.0], [0.0, 25.0, -12.0]].map(|place| waypoint(place, 2.0));
    let flight = Flight::new(5.0, WindSettings::default(), Vec::new(), ways.to_vec()).complete();
    let begin = flight.reached[0].1 + 200;
    let mut turning = 0;
    let end = flight.reached.last().expect("reached").1;
    let flown = &flight.reference[begin..end];
    let expected = flight.expected[begin - AHEAD as usize..].iter().zip(flown);
    for (expected, flown) in expected {
        let off_m = (expected.position_m - flown.position_m).norm();
        let off_jerk = (expected.jerk_m_s3 - flown.jerk_m_s3).norm();
        turning += usize::from(flown.acceleration_m_s2.norm() > 0.1);
        assert!(off_m < 1e-6 && off_jerk < 1e-6, "{off_m} {off_jerk} {expected:?} {flown:?}");
        let off_rad = (expected.yaw_rad - flown.yaw_rad).abs();
        assert!(off_rad < 0.02, "{expected:?} {flown:?}");
    }
    assert!(turning > 200, "{turning}");
}

#[test]
fn a_right_angle_takes_little_more_than_the_optimal_blend() {
    let ways = [[40.0, 0.0, -10.0], [40.0, 40.0, -10.0]].map(|place| waypoint(place, 2.0));
    let flight = Flight::new(5.0, WindSettings::default(), Vec::new(), ways.to_vec()).complete();
    let passed = |test: &dyn Fn(&Vector3<f64>) -> bool| {
        flight.truth_m.iter().position(test).expect("passed") as f64 * 0.01
    };
    let flown_s = passed(&|at| at.y > 20.0) - passed(&|at| at.x > 20.0);
    let optimal_s = optimal_time_s(5.0, 2.5, 2.0);
    assert!((optimal_s - 8.289).abs() < 1e-3, "{optimal_s}");
    assert!(flown_s < 1.15 * optimal_s, "{flown_s} s of {optimal_s}");
    assert!(flown_s > optimal_s, "the limits are kept: {flown_s}");
    let nearest_m = flight.nearest_m([40.0, 0.0, -10.0]);
    assert!(nearest_m < 2.0 && nearest_m > 1.5, "{nearest_m}");
    flight.check_reference(&flight.vehicle.simulation().configuration().limits).unwrap();
}

/// A straight corner costs nothing, a reversal is flown within the radius, corners nearer than the radius one after the other.
#[test]
fn straight_sharp_and_crowded_corners_are_passed() {
    let straight = [([40.0, 0.0, -10.0], 2.0), ([80.0, 0.0, -10.0], 2.0)];
    let reversal = [([40.0, 0.0, -10.0], 2.0), ([0.0, 0.0, -10.0], 2.0)];
    let crowded: Vec<([f64; 3], f64)> = (0..8)
        .map(|index| ([10.0 + f64::from(index / 2), f64::from((index + 1) / 2 % 2), -10.0], 3.0))
        .chain([([30.0, 10.0, -20.0], 3.0)])
        .collect();
    for ways in [&straight[..], &reversal[..], &crowded[..]] {
        let flight = Flight::calm(ways).complete();
        assert!((0..=ways.len() as u16).eq(flight.order()), "{:?}", flight.order());
        for (place, radius_m) in ways {
            assert!(flight.nearest_m(*place) < *radius_m, "{place:?}: {}", flight.nearest_m(*place));
        }
        assert!(flight.rests_at(ways[ways.len() - 1].0), "{:?}", flight.reference.last());
        flight.check_reference(&Limits::default()).unwrap();
        if ways == straight {
            let at = flight.reached[1].1;
            assert!(flight.reference[at].velocity_m_s.x > 7.99, "{:?}", flight.reference[at]);
        }
    }
}

/// In the middle of a turn: other speeds, a pause, another item, another mode and back. The mission goes on and ends at rest.
#[test]
fn what_happens_in_the_middle_of_a_turn_is_flown_smoothly() {
    let places = [[40.0, 0.0, -10.0], [40.0, 40.0, -10.0], [0.0, 40.0, -15.0]];
    let slower = |vehicle: &mut Vehicle| {
        vehicle.change_speed(&ChangeSpeed::of(1.0, 2.0).expect("a speed")).expect("slower");
    };
    let pause = |vehicle: &mut Vehicle| {
        vehicle.pause().expect("paused");
        vehicle.tick().expect("flies");
        vehicle.continue_mission().expect("continued");
    };
    let back = |vehicle: &mut Vehicle| vehicle.set_mission_item(1, true).expect("item 1");
    let position_mode = |vehicle: &mut Vehicle| {
        vehicle.set_mode(Mode::Hold).expect("holds");
        for _ in 0..700 {
            vehicle.tick().expect("flies");
        }
        vehicle.set_mode(Mode::Mission).expect("goes on");
    };
    type Interference<'a> = (&'a str, &'a dyn Fn(&mut Vehicle));
    let cases: [Interference; 4] =
        [("slower", &slower), ("pause", &pause), ("back", &back), ("mode", &position_mode)];
    for (name, interfere) in cases {
        for late in [0, 60, 110, 170] {
            let mut flight = Flight::calm(&places.map(|place| (place, 2.0)));
            // 6 m before the corner the turn begins.
            flight.fly_until("the turn", |flight| flight.vehicle.truth().position_m.x > 34.0);
            for _ in 0..late {
                flight.sample();
            }
            interfere(&mut flight.vehicle);
            flight.reference.clear();
            let flight = flight.complete();
            assert!(flight.rests_at(places[2]), "{name} {late}: {:?}", flight.reference.last());
            for place in places {
                assert!(flight.nearest_m(place) < 2.0, "{name} {late}: {place:?}");
            }
            flight.check_reference(&Limits::default()).unwrap();
            if name == "slower" {
                let end = flight.reference.len() - 1_000;
                let cruise = flight.reference[end].velocity_m_s.xy().norm();
                assert!(cruise < 2.01, "{late}: {cruise}");
            }
        }
    }
}

/// An area to stay out of on the inner side of a corner: the corner is cut less, and the fence is not heard of.
#[test]
fn corners_keep_out_of_the_fence() {
    let circle = |x: f64, y: f64, radius: f64| {
        item(command::NAV_FENCE_CIRCLE_EXCLUSION, [radius, 0.0, 0.0, 0.0], [x, y, 0.0])
    };
    for (fence, radius_m) in
        [(circle(37.0, 3.0, 2.0), 2.0), (circle(30.0, 10.0, 9.0), 6.0), (circle(43.0, -2.0, 1.2), 2.0)]
    {
        let places = [[40.0, 0.0, -10.0], [40.0, 40.0, -10.0]];
        let ways = places.map(|place| waypoint(place, radius_m)).to_vec();
        let flight = Flight::new(8.0, WindSettings::default(), vec![fence], ways).complete();
        let [x, y, _] = fence.position;
        let gap = |at: &Vector3<f64>| (at.x - x).hypot(at.y - y) - fence.parameters[0];
        let least = flight.truth_m.iter().map(gap).fold(f64::INFINITY, f64::min);
        assert!(least > 0.1, "{fence:?}: {least}");
        assert_eq!(flight.vehicle.fence_record().count, 0, "{fence:?}");
        assert!(flight.rests_at(places[1]));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    /// Whatever the way is, in whatever wind: every place is passed within its radius and in order, the reference stays within the
    /// largest radius of the legs and within its limits, and the vehicle rests at the end.
    #[test]
    fn any_way_keeps_to_its_corridor(
        places in proptest::collection::vec(([-40.0..40.0_f64, -40.0..40.0, -30.0..-4.0], 0.3..6.0_f64), 2..7),
        close in 0.02..1.0_f64, speed in 2.0..8.0_f64, wind_m_s in 0.0..5.0_f64,
    ) {
        let wind = WindSettings { speed_m_s: wind_m_s, from_rad: 0.7, gusts_m_s: 0.0, seed: 3 };
        // From far apart to nearer than their radii.
        let scaled = |[x, y, z]: [f64; 3]| [x * close, y * close, -10.0 + (z + 10.0) * close];
        let places: Vec<([f64; 3], f64)> = places.into_iter().map(|(place, radius)| (scaled(place), radius)).collect();
        let ways = places.iter().map(|(place, radius_m)| waypoint(*place, *radius_m)).collect();
        let flight = Flight::new(speed, wind, Vec::new(), ways).complete();
        prop_assert!((0..=places.len() as u16).eq(flight.order()), "{:?}", flight.order());
        flight.check_reference(&flight.vehicle.simulation().configuration().limits)?;
        for (place, radius_m) in &places {
            prop_assert!(flight.nearest_m(*place) <= *radius_m, "{place:?}: {}", flight.nearest_m(*place));
        }
        let legs: Vec<[f64; 3]> = [TAKEOFF].into_iter().chain(places.iter().map(|(place, _)| *place)).collect();
        let widest = places.iter().map(|(_, radius_m)| *radius_m).fold(0.0, f64::max);
        prop_assert!(flight.beside_m(&legs) <= widest, "{} {widest}", flight.beside_m(&legs));
        prop_assert!(flight.rests_at(places[places.len() - 1].0), "{:?}", flight.reference.last());
    }
}
