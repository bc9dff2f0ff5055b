//! The height above a surface that the rangefinder sees.

use super::flier::*;
use vehicle::identity::Identity;
use vehicle::surroundings::{Hill, Obstacle, Relief, Shape, Terrain};

/// Its slope is 0.2 at most; its top is level.
const HILL: Hill = Hill { centre_m: [120.0, 0.0], radius_m: 100.0, top_m: 20.0, height_m: 10.0 };

fn before_a_hill() -> Flier {
    let mut settings = crate::common::settings(Identity::ArduPilot);
    settings.surroundings.terrain = Terrain::new(Relief { grid: None, hills: vec![HILL] });
    Flier::with(&settings)
}

/// Height above the ground below, m, by the formula of the hill.
fn clearance_m(flier: &Flier) -> f64 {
    let [north_m, east_m, z_m]: [f64; 3] = flier.vehicle().truth().position_m.into();
    let off_m = (north_m - HILL.centre_m[0]).hypot(east_m - HILL.centre_m[1]);
    let down = ((off_m - HILL.top_m) / (HILL.radius_m - HILL.top_m)).clamp(0.0, 1.0);
    let hill_m = HILL.height_m * (1.0 + (std::f64::consts::PI * down).cos()) / 2.0;
    -z_m - hill_m
}

/// Flies north by the stick up to the middle of the hill, and stops; the smallest and the largest clearance on the way, m.
fn fly_up(flier: &mut Flier) -> [f64; 2] {
    let mut range_m = [f64::INFINITY, 0.0_f64];
    flier.rc(2, 1350);
    while flier.vehicle().truth().position_m.x < HILL.centre_m[0] - 5.0 {
        flier.fly(0.1);
        let now_m = clearance_m(flier);
        range_m = [range_m[0].min(now_m), range_m[1].max(now_m)];
    }
    flier.rc(2, 1500);
    flier.wait("a stop", 30.0, |flier| flier.speed_m_s() < 0.1);
    flier.fly(5.0);
    range_m
}

/// Suite: SurfaceTracking, uphill.
#[test]
fn loiter_keeps_the_height_above_the_ground() {
    let mut flier = before_a_hill();
    flier.take_off(10.0, LOITER);
    flier.fly(3.0);
    let before_m = clearance_m(&flier);
    let [least_m, most_m] = fly_up(&mut flier);
    assert!(before_m - least_m < 1.0 && most_m - before_m < 1.0, "{before_m}: {least_m} to {most_m}");
    let north_m = flier.vehicle().truth().position_m.x;
    assert!((north_m - HILL.centre_m[0]).abs() < HILL.top_m, "{north_m}");
    assert!((clearance_m(&flier) - before_m).abs() < 0.3, "{before_m}: {}", clearance_m(&flier));
    assert!((flier.height_m() - before_m - HILL.height_m).abs() < 0.3, "{}", flier.height_m());
    // A climb adds to the height that is kept.
    flier.rc(3, 1900);
    flier.fly(3.0);
    flier.rc(3, 1500);
    flier.fly(4.0);
    let height_m = flier.height_m();
    flier.fly(4.0);
    assert!((flier.height_m() - height_m).abs() < 0.05, "{height_m} m, now {}", flier.height_m());
    assert!(clearance_m(&flier) > before_m + 3.0);
}

#[test]
fn altitude_hold_keeps_it_too() {
    let mut flier = before_a_hill();
    flier.take_off(10.0, LOITER);
    flier.fly(3.0);
    flier.change_mode(ALT_HOLD);
    let before_m = clearance_m(&flier);
    flier.rc(2, 1470);
    flier.wait("the top", 90.0, |flier| flier.vehicle().truth().position_m.x > HILL.centre_m[0] + 10.0);
    assert!((clearance_m(&flier) - before_m).abs() < 0.7, "{before_m}: {}", clearance_m(&flier));
}

/// Without tracking the altitude is kept: by parameter, by its switch, and with a rangefinder that is switched off.
#[test]
fn nothing_is_tracked_if_it_is_not_to_be() {
    for case in 0..3 {
        let mut flier = before_a_hill();
        match case {
            0 => flier.set("SURFTRAK_MODE", 0.0),
            1 => flier.set("RC7_OPTION", 75.0),
            _ => flier.set("RC7_OPTION", 10.0),
        }
        flier.rc(7, 1900);
        flier.fly(0.5);
        if case == 1 {
            flier.rc(7, 1500);
        } else {
            flier.rc(7, 1000);
        }
        flier.fly(0.5);
        flier.take_off(20.0, LOITER);
        flier.fly(3.0);
        let height_m = flier.height_m();
        fly_up(&mut flier);
        assert!((flier.height_m() - height_m).abs() < 0.1, "case {case}: {height_m}, {}", flier.height_m());
    }
}

/// What is found to be as high as a house from one moment to the next is no ground to follow.
#[test]
fn a_wall_is_not_climbed() {
    let mut settings = crate::common::settings(Identity::ArduPilot);
    let shape = Shape::Box { centre_m: [30.0, 0.0], size_m: [20.0, 20.0], heading_rad: 0.0 };
    settings.surroundings.obstacles =
        vec![Obstacle { name: "house".to_owned(), shape, bottom_m: 0.0, top_m: 6.0 }];
    let mut flier = Flier::with(&settings);
    flier.take_off(12.0, LOITER);
    flier.fly(3.0);
    let height_m = flier.height_m();
    flier.rc(2, 1350);
    flier.wait("above the house", 30.0, |flier| flier.vehicle().truth().position_m.x > 30.0);
    flier.rc(2, 1500);
    flier.fly(6.0);
    assert!((flier.height_m() - height_m).abs() < 0.3, "{height_m}, {}", flier.height_m());
}
