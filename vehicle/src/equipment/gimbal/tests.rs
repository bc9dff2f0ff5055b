//! Tests of the gimbal.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use super::{Gimbal, GimbalLimits, GimbalMode, MountSettings, Pointing, Surroundings, Vector3};

fn around(yaw_rad: f64) -> Surroundings {
    Surroundings {
        time_us: 0,
        position_m: Vector3::new(0.0, 0.0, -10.0),
        attitude_rad: Vector3::new(0.0, 0.0, yaw_rad),
        region_m: None,
        looks: false,
        home_m: Vector3::zeros(),
        mount: MountSettings::default(),
        deflections: [0.0; 3],
        radio_is_lost: false,
    }
}

fn settle(gimbal: &mut Gimbal, around: &Surroundings) -> [f64; 3] {
    for _ in 0..3_000 {
        gimbal.step(around, 0.001);
    }
    gimbal.angles_rad().data.0[0]
}

fn near(one: [f64; 3], other: [f64; 3]) -> bool {
    one.iter().zip(other).all(|(one, other)| (one - other).abs() < 1e-6)
}

#[test]
fn yaw_follows_the_nose_or_is_kept_from_north() {
    let mut gimbal = Gimbal::default();
    assert!(gimbal.rests(false));
    let down = Pointing { pitch_rad: Some(-FRAC_PI_2), yaw_rad: Some(0.5), ..Pointing::default() };
    gimbal.point(&down, 1.0);
    assert!(near(settle(&mut gimbal, &around(1.0)), [0.0, -FRAC_PI_2, 0.5]));
    assert!(near(settle(&mut gimbal, &around(2.0)), [0.0, -FRAC_PI_2, 0.5]));
    gimbal.point(&Pointing { yaw_lock: true, ..down }, 2.0);
    assert!(near(settle(&mut gimbal, &around(2.0)), [0.0, -FRAC_PI_2, -1.5]));
    assert!(near(settle(&mut gimbal, &around(0.5)), [0.0, -FRAC_PI_2, 0.0]));
    gimbal.centre();
    assert!(near(settle(&mut gimbal, &around(0.5)), [0.0; 3]) && gimbal.rests(false));
}

#[test]
fn it_turns_at_its_rate_and_stops_at_its_limits() {
    let mut gimbal = Gimbal::default();
    let up = Pointing { pitch_rate_rad_s: Some(0.2), yaw_rate_rad_s: Some(-0.3), ..Pointing::default() };
    gimbal.point(&up, 0.0);
    for _ in 0..1_000 {
        gimbal.step(&around(0.0), 0.001);
    }
    assert!(near(gimbal.angles_rad().data.0[0], [0.0, 0.2, -0.3]), "{gimbal:?}");
    assert!((gimbal.rates_rad_s() - Vector3::new(0.0, 0.2, -0.3)).norm() < 1e-6);
    gimbal.point(&Pointing { pitch_rad: Some(FRAC_PI_2), ..Pointing::default() }, 0.0);
    assert_eq!(settle(&mut gimbal, &around(0.0))[1], FRAC_PI_4);
    assert_eq!(gimbal.at_limit(), [false, true, false]);
    gimbal.point(&Pointing { pitch_rad: Some(0.0), ..Pointing::default() }, 0.0);
    gimbal.step(&around(0.0), 0.1);
    assert!((gimbal.rates_rad_s().y + GimbalLimits::OURS.rate_rad_s).abs() < 1e-9, "no faster");
}

#[test]
fn it_tracks_what_is_looked_at() {
    let mut gimbal = Gimbal::default();
    let looking = Surroundings { region_m: Some(Vector3::new(0.0, 10.0, 0.0)), looks: true, ..around(0.25) };
    assert!(!gimbal.rests(true));
    assert!(near(settle(&mut gimbal, &looking), [0.0, -FRAC_PI_4, FRAC_PI_2 - 0.25]));
    // Who points it elsewhere takes it off the place, which then ends for it, too.
    gimbal.point(&Pointing { pitch_rad: Some(0.1), yaw_rad: Some(0.0), ..Pointing::default() }, 0.25);
    assert!(near(settle(&mut gimbal, &looking), [0.0, 0.1, 0.0]));
    assert!(near(settle(&mut gimbal, &around(0.25)), [0.0, 0.1, 0.0]));
    settle(&mut gimbal, &looking);
    assert!(gimbal.tracks());
    assert!(near(settle(&mut gimbal, &around(0.25)), [0.0; 3]), "ahead again");
}

fn servos(radio_rate_rad_s: f64) -> MountSettings {
    let pitch_rad = [-FRAC_PI_2, 10_f64.to_radians()];
    MountSettings { kind: 1, radio_rate_rad_s, pitch_rad, ..MountSettings::default() }
}

/// Angles that ArduPilot's own tests expect of a mount of servos.
#[test]
fn a_channel_points_it_between_its_limits_at_once() {
    let mount = servos(0.0);
    let mut gimbal = Gimbal::mounted(&mount);
    for (deflection, pitch_deg) in [(-1.0, -90.0), (1.0, 10.0), (0.0, -40.0)] {
        let around = Surroundings { mount, deflections: [0.0, deflection, 0.0], ..around(0.3) };
        gimbal.step(&around, 0.001);
        assert!((gimbal.angles_rad().y.to_degrees() - pitch_deg).abs() < 1e-9);
        assert!(!gimbal.rests(false));
    }
}

#[test]
fn a_channel_turns_it_until_the_radio_is_lost() {
    let mount = servos(10_f64.to_radians());
    let mut gimbal = Gimbal::mounted(&mount);
    let mut around = Surroundings { mount, deflections: [0.0, -0.5, 0.0], ..around(0.0) };
    assert!(near(settle(&mut gimbal, &around), [0.0, -15_f64.to_radians(), 0.0]));
    around.radio_is_lost = true;
    assert!(near(settle(&mut gimbal, &around), [0.0, -15_f64.to_radians(), 0.0]));
}

/// The place, and the angles to it, are those of a test of ArduPilot: from 10 m up and 45° down to the west, then seen from 100 m
/// north and east, 70 m up, heading north-east.
#[test]
fn it_locks_on_the_place_that_it_sees() {
    let mount = MountSettings { pitch_rad: [-FRAC_PI_4, FRAC_PI_4], ..servos(0.0) };
    let mut gimbal = Gimbal::mounted(&mount);
    let mut around = Surroundings { mount, deflections: [0.0, -1.0, 0.0], ..around(-FRAC_PI_2) };
    gimbal.step(&around, 0.001);
    gimbal.lock_on(&around);
    gimbal.look_off(false);
    (around.position_m, around.attitude_rad.z) = (Vector3::new(100.0, 100.0, -70.0), FRAC_PI_4);
    gimbal.lock_on(&around);
    gimbal.step(&around, 0.001);
    let [_, pitch_deg, yaw_deg] = gimbal.angles_rad().data.0[0].map(f64::to_degrees);
    assert!((pitch_deg + 25.2).abs() < 0.1 && (yaw_deg + 177.3).abs() < 0.1, "{pitch_deg} {yaw_deg}");
    assert!(!gimbal.is_locked(), "told from the nose");
    gimbal.look_off(true);
    gimbal.step(&around, 0.001);
    assert!(near(gimbal.angles_rad().data.0[0], [0.0, -FRAC_PI_4, 0.0]));
    assert_eq!(gimbal.locked_on_m, None);
}

#[test]
fn modes_are_changed_and_nothing_to_look_at_is_the_first_one() {
    let mount = MountSettings { first_mode: GimbalMode::Retracted, ..servos(0.0) };
    let mut gimbal = Gimbal::mounted(&mount);
    assert!(gimbal.is_retracted());
    let looking =
        Surroundings { mount, region_m: Some(Vector3::new(10.0, 0.0, 0.0)), looks: true, ..around(0.0) };
    assert!(near(settle(&mut gimbal, &looking), [0.0, -FRAC_PI_4, 0.0]) && gimbal.tracks());
    gimbal.stay();
    let aside = Surroundings { position_m: Vector3::new(0.0, 50.0, -10.0), ..looking };
    assert!(near(settle(&mut gimbal, &aside), [0.0, -FRAC_PI_4, 0.0]), "it holds the angles");
    gimbal.set_mode(GimbalMode::Home);
    let home = Surroundings { home_m: Vector3::new(0.0, 60.0, 0.0), ..aside };
    assert!(near(settle(&mut gimbal, &home), [0.0, -FRAC_PI_4, FRAC_PI_2]));
    gimbal.set_mode(GimbalMode::Region);
    settle(&mut gimbal, &looking);
    settle(&mut gimbal, &Surroundings { mount, ..around(0.0) });
    assert!(gimbal.is_retracted());
}

#[test]
fn a_gimbal_whose_first_mode_is_the_region_rests_without_one() {
    let mount = MountSettings { first_mode: GimbalMode::Region, ..servos(0.0) };
    let mut gimbal = Gimbal::mounted(&mount);
    let looking =
        Surroundings { mount, region_m: Some(Vector3::new(10.0, 0.0, 0.0)), looks: true, ..around(0.0) };
    settle(&mut gimbal, &looking);
    assert!(gimbal.tracks());
    assert!(near(settle(&mut gimbal, &Surroundings { mount, ..around(0.0) }), [0.0, -FRAC_PI_4, 0.0]));
    assert!(!gimbal.tracks() && gimbal.rests(false));
}

#[test]
fn crossed_ends_are_the_range_between_them() {
    let mount = MountSettings { pitch_rad: [0.5, 0.25], yaw_rad: [1.0, -1.0], ..servos(0.0) };
    let mut gimbal = Gimbal::mounted(&mount);
    for (deflection, pitch_rad) in [(-1.0, 0.25), (1.0, 0.5)] {
        let around = Surroundings { mount, deflections: [0.0, deflection, deflection], ..around(0.0) };
        gimbal.step(&around, 0.001);
        assert!(near(gimbal.angles_rad().data.0[0], [0.0, pitch_rad, deflection]), "{gimbal:?}");
    }
}
