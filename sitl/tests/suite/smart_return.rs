//! The ways home: back along the trail, and as the parameters of both autopilots say.

use crate::common::requests::local_target;
use crate::common::{Bench, settings};
use nalgebra::Vector3;
use vehicle::identity::Identity;
use vehicle::{HeadingPolicy, LandedState, Mode, TrailSettings, VehicleSettings, wrapped};

fn go_to(bench: &mut Bench, [x, y, z]: [f64; 3]) {
    bench.send(local_target(0xdf8, [x as f32, y as f32, z as f32], [0.0; 3]));
    bench.fly_until("the place", 60.0, |bench| bench.is_near([x, y, z]));
}

/// The farthest from a way of straight pieces, m.
fn off_way(place: &Vector3<f64>, corners: &[[f64; 3]]) -> f64 {
    let off = |ends: &[[f64; 3]]| {
        let (from, to) = (Vector3::from(ends[0]), Vector3::from(ends[1]));
        let way = to - from;
        let share = ((place - from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
        (from + way * share - place).norm()
    };
    corners.windows(2).map(off).fold(f64::INFINITY, f64::min)
}

/// Out around two corners, and back the same way.
#[test]
fn smart_rtl_flies_back_along_its_own_way() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    let way =
        [[0.0, 0.0, 0.0], [0.0, 0.0, -10.0], [40.0, 0.0, -10.0], [40.0, 30.0, -16.0], [70.0, 30.0, -16.0]];
    way[2..].iter().for_each(|place| go_to(&mut bench, *place));
    assert_eq!(bench.set_mode(Mode::SmartReturn), 0);
    assert_eq!(bench.autopilot.identity().custom_mode(bench.mode()), 21);
    let (mut worst, mut nearest_corner): (f64, f64) = (0.0, f64::INFINITY);
    while bench.autopilot.vehicle().landed_state() == LandedState::InAir {
        bench.fly(0.05);
        let place = Vector3::from(bench.position());
        worst = worst.max(off_way(&place, &way));
        nearest_corner = nearest_corner.min((place - Vector3::from(way[3])).norm());
        assert!(bench.autopilot.vehicle().time_us() < 200_000_000, "{place}");
    }
    // The accuracy of the trail, and the acceptance radius of its corners.
    assert!(worst < 3.0, "{worst} m beside its way");
    assert!(nearest_corner < 3.5, "{nearest_corner} m from the corner");
    bench.fly_until("landed", 40.0, |bench| !bench.autopilot.vehicle().is_armed());
    let [x, y, _] = bench.position();
    assert!(x.hypot(y) < 0.5, "{x} {y}");
}

/// A mode between two parts of the way back does not lose the rest of the trail.
#[test]
fn smart_rtl_goes_on_after_another_mode() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    for place in [[30.0, 0.0, -10.0], [30.0, 30.0, -10.0]] {
        go_to(&mut bench, place);
    }
    assert_eq!(bench.set_mode(Mode::SmartReturn), 0);
    bench.fly_until("the corner", 30.0, |bench| bench.position()[1] < 1.0);
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    bench.fly(4.0);
    assert_eq!(bench.set_mode(Mode::SmartReturn), 0);
    let mut widest: f64 = 0.0;
    while bench.autopilot.vehicle().landed_state() == LandedState::InAir {
        bench.fly(0.05);
        widest = widest.max(bench.position()[1].abs());
        assert!(bench.autopilot.vehicle().time_us() < 150_000_000);
    }
    let [x, y, _] = bench.position();
    assert!(x.hypot(y) < 0.5 && widest < 2.5, "{x} {y} {widest}");
}

/// Without a trail the mode is refused; what enters it whatever speaks against it returns as always.
#[test]
fn without_a_trail_smart_rtl_is_refused() {
    const FAILED: u8 = 4;
    let mut settings = settings(Identity::ArduPilot);
    settings.conduct.trail = TrailSettings { most_places: 0, ..TrailSettings::default() };
    let mut bench = Bench::hovering_with(&settings);
    assert_eq!(bench.set_mode(Mode::SmartReturn), FAILED);
    assert!(bench.texts().iter().any(|text| text.contains("use RTL")), "{:?}", bench.texts());
}

fn returning(settings: &VehicleSettings, place: [f64; 3]) -> Bench {
    let mut bench = Bench::hovering_with(settings);
    let guided = settings.identity.is_ardupilot();
    assert!(guided, "guided flights only");
    go_to(&mut bench, place);
    assert_eq!(bench.set_mode(Mode::Return), 0);
    bench
}

/// RTL_SPEED, RTL_LOIT_TIME and RTL_ALT_FINAL in one flight.
#[test]
fn ardupilot_returns_at_its_speed_waits_and_stays_at_its_final_height() {
    let mut settings = settings(Identity::ArduPilot);
    let home = &mut settings.conduct.return_home;
    (home.speed_m_s, home.wait_s, home.final_height_m) = (3.0, 4.0, 5.0);
    let mut bench = returning(&settings, [50.0, 0.0, -10.0]);
    let mut fastest: f64 = 0.0;
    bench.fly_until("above home", 60.0, |bench| {
        let outputs = bench.autopilot.vehicle().outputs();
        outputs.position_m.xy().norm() < 0.5 && outputs.velocity_m_s.norm() < 0.5
    });
    let arrived_s = bench.autopilot.vehicle().time_us() as f64 / 1e6;
    assert!((bench.position()[2] + 15.0).abs() < 0.3, "{:?}", bench.position());
    bench.fly_until("lower", 20.0, |bench| bench.position()[2] > -14.5);
    let waited_s = bench.autopilot.vehicle().time_us() as f64 / 1e6 - arrived_s;
    assert!((4.0..6.5).contains(&waited_s), "{waited_s}");
    bench.fly(12.0);
    assert!((bench.position()[2] + 5.0).abs() < 0.1 && bench.autopilot.vehicle().is_armed());
    // The speed of the way home ends with it.
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    go_to(&mut bench, [5.0, 0.0, -10.0]);
    go_to(&mut bench, [60.0, 0.0, -10.0]);
    assert_eq!(bench.set_mode(Mode::Return), 0);
    for _ in 0..300 {
        bench.fly(0.1);
        fastest = fastest.max(Vector3::from(bench.velocity()).xy().norm());
    }
    assert!((2.8..3.2).contains(&fastest), "{fastest}");
}

/// WP_YAW_BEHAVIOR: to the next place, as it is, along the way; and back to the heading of arming above home.
#[test]
fn the_nose_points_on_the_way_home_as_the_parameter_says() {
    for (policy, expected_deg) in [
        (HeadingPolicy::NextPlace, 180.0),
        (HeadingPolicy::NextPlaceExceptReturn, 0.0),
        (HeadingPolicy::Hold, 0.0),
        (HeadingPolicy::Travel, 180.0),
    ] {
        let mut settings = settings(Identity::ArduPilot);
        settings.conduct.heading_policy = policy;
        let mut bench = returning(&settings, [80.0, 0.0, -14.0]);
        bench.fly_until("on the way", 40.0, |bench| bench.position()[0] < 30.0);
        let heading = bench.autopilot.vehicle().outputs().attitude_rad.z;
        assert!(wrapped(heading - f64::to_radians(expected_deg)).abs() < 0.1, "{policy:?}: {heading}");
        bench.fly_until("landing", 60.0, |bench| {
            bench.autopilot.vehicle().landed_state() == LandedState::Landing
        });
        let heading = bench.autopilot.vehicle().outputs().attitude_rad.z;
        let home = !matches!(policy, HeadingPolicy::Hold | HeadingPolicy::NextPlaceExceptReturn);
        assert!(!home || heading.abs() < 0.05, "{policy:?}: {heading}");
    }
}
