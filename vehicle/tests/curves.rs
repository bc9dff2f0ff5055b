//! Curves of missions, flown in the nonlinear closed loop.

use nalgebra::Vector3;
use quadrotor::{Limits, PositionReference};
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, PlanKind, command, frame};
use vehicle::surroundings::{Hill, Relief, Terrain};
use vehicle::{MissionState, Mode, Vehicle, VehicleSettings};

/// Ticks between two samples.
const SAMPLE: usize = 10;
const SAMPLE_S: f64 = 0.01;
const HEIGHT_M: f64 = 10.0;
/// A ridge 20 m high, 120 m wide at its foot.
const RIDGE: Hill = Hill { centre_m: [80.0, 0.0], radius_m: 60.0, top_m: 0.0, height_m: 20.0 };

fn item(frame: u8, command: u16, position: [f64; 3]) -> MissionItem {
    MissionItem { frame, command, parameters: [0.0, 0.0, 0.0, f64::NAN], position, autocontinue: true }
}

fn global(vehicle: &Vehicle, command: u16, frame: u8, [north_m, east_m, height_m]: [f64; 3]) -> MissionItem {
    let place = vehicle.frame().to_geodetic(&Vector3::new(north_m, east_m, 0.0));
    item(frame, command, [place.latitude_deg, place.longitude_deg, height_m])
}

/// The ground below a place north, m: half a wave of a cosine.
fn ridge_m(north_m: f64) -> f64 {
    let off = f64::min((north_m - 80.0).abs() / 60.0, 1.0);
    10.0 * (1.0 + (core::f64::consts::PI * off).cos())
}

/// What was seen of a flight every hundredth of a second, from the place of the takeoff on.
struct Flight {
    reference: Vec<PositionReference>,
    truth_m: Vec<Vector3<f64>>,
    attitude_rad: Vec<Vector3<f64>>,
    limits: Limits,
}

impl Flight {
    fn new(settings: &VehicleSettings, ways: impl Fn(&Vehicle) -> Vec<MissionItem>) -> Self {
        let mut vehicle = Vehicle::new(settings).expect("valid settings");
        let takeoff = item(frame::LOCAL_NED, command::NAV_TAKEOFF, [0.0, 0.0, -HEIGHT_M]);
        let items = [vec![takeoff], ways(&vehicle)].concat();
        vehicle.set_plan(PlanKind::Mission, items).expect("a mission");
        vehicle.arm(false).expect("armed");
        vehicle.set_mode(Mode::Mission).expect("mission mode");
        let mut flight = Self {
            reference: Vec::new(),
            truth_m: Vec::new(),
            attitude_rad: Vec::new(),
            limits: vehicle.simulation().configuration().limits,
        };
        for _ in 0..20_000 {
            (0..SAMPLE).for_each(|_| {
                vehicle.tick().expect("the flight goes on");
            });
            if vehicle.take_reached_items().contains(&0) || !flight.reference.is_empty() {
                flight.reference.push(vehicle.outputs().setpoint);
                flight.truth_m.push(vehicle.truth().position_m);
                flight.attitude_rad.push(vehicle.truth().attitude_rad);
            }
            if vehicle.mission_status().state == MissionState::Complete {
                return flight;
            }
        }
        panic!("it takes longer than 200 s: {:?}", vehicle.outputs());
    }

    /// From its beginning to its end, s.
    fn time_s(&self) -> f64 {
        self.reference.len() as f64 * SAMPLE_S
    }

    /// Largest distance of the vehicle from the reference, m, and largest angle of the heading and of the lean, rad.
    fn worst(&self) -> [f64; 3] {
        let off = self.reference.iter().zip(&self.truth_m).map(|(now, truth_m)| now.position_m - truth_m);
        let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        [
            most(&mut off.map(|off| off.norm())),
            most(&mut self.attitude_rad.iter().map(|attitude| attitude.z.abs())),
            most(&mut self.attitude_rad.iter().map(|attitude| attitude.xy().amax())),
        ]
    }

    /// Speeds, accelerations and jerks of its reference are within the limits.
    fn keeps_limits(&self) {
        let limits = &self.limits;
        for pair in self.reference.windows(2) {
            let [before, now] = pair else { continue };
            let [v, a] = [now.velocity_m_s, now.acceleration_m_s2];
            let jerk = (a - before.acceleration_m_s2) / SAMPLE_S;
            let gained = (v - before.velocity_m_s) / SAMPLE_S;
            assert!(gained.xy().norm() < limits.acceleration_horizontal_m_s2, "{gained} {now:?}");
            assert!(gained.z.abs() < limits.acceleration_vertical_m_s2, "{gained} {now:?}");
            assert!(v.xy().norm() < limits.speed_horizontal_m_s * 1.001, "{now:?}");
            assert!((-1.001 * limits.speed_up_m_s..1.001 * limits.speed_down_m_s).contains(&v.z), "{now:?}");
            assert!(a.xy().norm() < limits.acceleration_horizontal_m_s2, "{now:?}");
            assert!(a.z.abs() < limits.acceleration_vertical_m_s2, "{now:?}");
            assert!(jerk.xy().norm() < 1.01 * limits.jerk_horizontal_m_s3, "{jerk} {now:?}");
            assert!(jerk.z.abs() < 1.01 * limits.jerk_vertical_m_s3, "{jerk} {now:?}");
        }
    }
}

/// 10 m above a hill of 20 m. Steps of the acceleration, of 1 m/s² in a tick, once took the vehicle 2 m off its way, leaning by 33
/// degrees, in 39.0 s from the takeoff on.
#[test]
fn over_the_crest_of_a_hill_it_keeps_to_its_way() {
    let mut settings = VehicleSettings::new(Identity::Px4);
    settings.surroundings.terrain = Terrain::new(Relief { grid: None, hills: vec![RIDGE] });
    let flight = Flight::new(&settings, |vehicle| {
        let place_m = [160.0, 0.0, HEIGHT_M];
        vec![global(vehicle, command::NAV_WAYPOINT, frame::GLOBAL_TERRAIN, place_m)]
    });
    flight.keeps_limits();
    let [off_m, heading_rad, lean_rad] = flight.worst();
    assert!(off_m < 0.02, "{off_m} m off");
    assert!(heading_rad < 0.001 && lean_rad < 0.12, "{heading_rad} {lean_rad} rad");
    assert!(flight.time_s() < 39.5, "{} s", flight.time_s());
    for now in flight.reference.iter().filter(|now| now.position_m.x > 0.0) {
        let above_m = -now.position_m.z - ridge_m(now.position_m.x);
        assert!((above_m - HEIGHT_M).abs() < 0.03, "{above_m} m above the ground at {}", now.position_m);
    }
}

/// Through places that lie at different distances, with bends to both sides.
#[test]
fn a_spline_is_flown_under_a_jerk_within_the_limit() {
    let settings = VehicleSettings::new(Identity::Px4);
    let places_m = [[30.0, 0.0, -10.0], [45.0, 20.0, -12.0], [80.0, 20.0, -10.0], [90.0, 60.0, -8.0]];
    let flight = Flight::new(&settings, |_| {
        places_m.map(|place_m| item(frame::LOCAL_NED, command::NAV_SPLINE_WAYPOINT, place_m)).to_vec()
    });
    flight.keeps_limits();
    let [off_m, _, lean_rad] = flight.worst();
    assert!(off_m < 0.03, "{off_m} m off");
    assert!(lean_rad < 0.2, "{lean_rad} rad");
    for place_m in places_m.map(Vector3::from) {
        let past_m = flight.reference.iter().map(|now| (now.position_m - place_m).norm());
        let past_m = past_m.fold(f64::INFINITY, f64::min);
        assert!(past_m < 0.05, "{past_m} m past {place_m}");
    }
}

/// Out to a place and back: there the way has no direction.
#[test]
fn on_ways_that_turn_back_it_comes_to_rest_between_them() {
    type Ways = fn(&Vehicle) -> Vec<MissionItem>;
    let spline: Ways = |_| {
        let places_m =
            [[30.0, 0.0, -HEIGHT_M], [0.0, 0.0, -HEIGHT_M], [20.0, 20.0, -HEIGHT_M], [-5.0, -4.0, -HEIGHT_M]];
        places_m.map(|place_m| item(frame::LOCAL_NED, command::NAV_SPLINE_WAYPOINT, place_m)).to_vec()
    };
    let above_ground: Ways = |vehicle| {
        let places_m = [[60.0, 0.0, HEIGHT_M], [0.0, 0.0, HEIGHT_M], [60.0, 10.0, HEIGHT_M]];
        places_m
            .map(|place_m| global(vehicle, command::NAV_WAYPOINT, frame::GLOBAL_TERRAIN, place_m))
            .to_vec()
    };
    for (ways, turns_m) in [(spline, 30.0), (above_ground, 60.0)] {
        let mut settings = VehicleSettings::new(Identity::Px4);
        settings.surroundings.terrain = Terrain::new(Relief { grid: None, hills: vec![RIDGE] });
        let flight = Flight::new(&settings, ways);
        flight.keeps_limits();
        let [off_m, ..] = flight.worst();
        assert!(off_m < 0.05, "{off_m} m off");
        let rests = |now: &&PositionReference| now.velocity_m_s.norm() < 0.02;
        let resting = flight.reference.iter().filter(rests);
        let nearest_m = resting.map(|now| (now.position_m.x - turns_m).abs()).fold(f64::INFINITY, f64::min);
        assert!(nearest_m < 0.05, "it turns back {nearest_m} m beside its place");
    }
}

/// A place that is named twice is passed as if it were named once, without a look to the north.
#[test]
fn a_place_that_follows_itself_does_not_disturb_the_curve() {
    let fly = |count: usize, kind: u16| {
        let mut settings = VehicleSettings::new(Identity::Px4);
        settings.surroundings.terrain = Terrain::new(Relief { grid: None, hills: vec![RIDGE] });
        Flight::new(&settings, |vehicle| {
            let places_m = [[0.0, 30.0, HEIGHT_M], [10.0, 60.0, HEIGHT_M], [10.0, 90.0, HEIGHT_M]];
            let one = |place_m| global(vehicle, kind, frame::GLOBAL_TERRAIN, place_m);
            [vec![one(places_m[0])], vec![one(places_m[1]); count], vec![one(places_m[2])]].concat()
        })
    };
    for kind in [command::NAV_SPLINE_WAYPOINT, command::NAV_WAYPOINT] {
        let (once, thrice) = (fly(1, kind), fly(3, kind));
        thrice.keeps_limits();
        assert_eq!(once.reference.len(), thrice.reference.len());
        for (once, thrice) in once.reference.iter().zip(&thrice.reference) {
            assert!((once.position_m - thrice.position_m).norm() < 1e-9, "{once:?} {thrice:?}");
            assert!((once.yaw_rad - thrice.yaw_rad).abs() < 1e-9, "{once:?} {thrice:?}");
        }
    }
}

/// The other side of the Earth is refused when the mission is to be flown; until then it is drawn and checked in bounded time.
#[test]
fn a_way_along_the_ground_to_the_other_side_of_the_earth_is_drawn_in_bounded_memory() {
    let mut settings = VehicleSettings::new(Identity::Px4);
    settings.surroundings.terrain = Terrain::new(Relief { grid: None, hills: vec![RIDGE] });
    settings.conduct.failsafe.fence_enabled = true;
    settings.conduct.failsafe.fence_height_m = 200.0;
    let mut vehicle = Vehicle::new(&settings).expect("valid settings");
    let far = item(frame::GLOBAL_TERRAIN, command::NAV_WAYPOINT, [0.0, 60.0, HEIGHT_M]);
    vehicle.set_plan(PlanKind::Mission, vec![far]).expect("it is taken");
    let legs = vehicle.planned_way();
    assert!(legs[0].place_m.norm() > 1e6 && legs[0].through_m.len() <= 2000, "{:?}", legs[0].place_m);
    let refusal = vehicle.start_mission(None).expect_err("it is too far away").to_string();
    assert!(refusal.contains("km away"), "{refusal}");
}

/// On the ground a mission without a takeoff climbs to the height of one, in the air it does not, and without a way it flies nothing.
#[test]
fn a_climb_that_is_not_flown_is_not_held_against_the_fence() {
    let mut settings = VehicleSettings::new(Identity::Px4);
    settings.conduct.failsafe.fence_enabled = true;
    settings.conduct.failsafe.fence_height_m = 8.0;
    settings.conduct.takeoff_height_m = 5.0;
    let mut vehicle = Vehicle::new(&settings).expect("valid settings");
    vehicle.arm(false).expect("armed");
    vehicle.set_mode(Mode::Takeoff).expect("it takes off");
    for _ in 0..10_000 {
        vehicle.tick().expect("the flight goes on");
    }
    assert!(vehicle.outputs().position_m.z < -4.0, "{:?}", vehicle.outputs().position_m);
    let mut higher = settings.clone();
    higher.conduct.takeoff_height_m = 10.0;
    let mut grounded = Vehicle::new(&higher).expect("valid settings");
    let kept = vehicle.kept_configuration();
    vehicle.adopt(&kept, &higher.conduct).expect("a parameter");
    let waypoint = vec![item(frame::LOCAL_NED, command::NAV_WAYPOINT, [20.0, 0.0, -6.0])];
    let land = vec![item(frame::LOCAL_NED, command::NAV_LAND, [20.0, 0.0, 0.0])];
    vehicle.set_plan(PlanKind::Mission, waypoint.clone()).expect("a mission in the air");
    grounded.set_plan(PlanKind::Mission, waypoint).expect_err("it would climb through the fence");
    grounded.set_plan(PlanKind::Mission, land).expect("it flies nothing");
}

/// Both places are 10 m above home, the top of the hill between them is 20 m above it: the way leads up to 30 m.
#[test]
fn a_way_along_the_ground_that_leads_above_the_fence_is_refused() {
    for (height_m, is_refused) in [(28.0, true), (32.0, false)] {
        let mut settings = VehicleSettings::new(Identity::Px4);
        settings.surroundings.terrain = Terrain::new(Relief { grid: None, hills: vec![RIDGE] });
        settings.conduct.failsafe.fence_enabled = true;
        settings.conduct.failsafe.fence_height_m = height_m;
        let mut vehicle = Vehicle::new(&settings).expect("valid settings");
        let items = [5.0, 160.0].map(|north_m| {
            let place_m = [north_m, 0.0, HEIGHT_M];
            global(&vehicle, command::NAV_WAYPOINT, frame::GLOBAL_TERRAIN, place_m)
        });
        let taken = vehicle.set_plan(PlanKind::Mission, items.to_vec());
        assert_eq!(taken.is_err(), is_refused, "{height_m} m: {taken:?}");
    }
}

/// The curve through a corner leads 4 m beside the straight way.
#[test]
fn a_spline_that_leads_through_a_zone_beside_the_straight_way_is_refused() {
    for (north_m, is_refused) in [(33.75, true), (27.0, false)] {
        let mut settings = VehicleSettings::new(Identity::Px4);
        settings.conduct.failsafe.fence_enabled = true;
        let mut vehicle = Vehicle::new(&settings).expect("valid settings");
        let zone = global(&vehicle, command::NAV_FENCE_CIRCLE_EXCLUSION, frame::GLOBAL, [north_m, 15.0, 0.0]);
        let zone = MissionItem { parameters: [1.0, 0.0, 0.0, 0.0], ..zone };
        vehicle.set_plan(PlanKind::Fence, vec![zone]).expect("a fence");
        let places_m = [[30.0, 0.0, -10.0], [30.0, 30.0, -10.0]];
        let items = places_m.map(|place_m| item(frame::LOCAL_NED, command::NAV_SPLINE_WAYPOINT, place_m));
        let taken = vehicle.set_plan(PlanKind::Mission, items.to_vec());
        assert_eq!(taken.is_err(), is_refused, "a zone at {north_m} m: {taken:?}");
    }
}
