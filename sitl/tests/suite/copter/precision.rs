//! Landing and loitering at a target that is seen.

use super::flier::*;
use mavlink::dialects::ardupilotmega::*;

/// From the target to the vehicle over the ground, m.
fn beside_m(flier: &Flier, target_m: [f64; 2]) -> f64 {
    let here_m = flier.vehicle().outputs().position_m;
    (here_m.x - target_m[0]).hypot(here_m.y - target_m[1])
}

/// Suite: PrecisionLanding. The target is 4 m north and 4 m west of the start.
#[test]
fn a_landing_goes_to_a_target_that_is_seen() {
    for sensor in [4.0, 2.0] {
        let mut flier = Flier::new();
        let target_m = [4.0, -4.0];
        let place =
            flier.vehicle().frame().to_geodetic(&nalgebra::Vector3::new(target_m[0], target_m[1], 0.0));
        flier.set_all(&[
            ("PLND_ENABLED", 1.0),
            ("PLND_TYPE", sensor),
            ("SIM_PLD_ENABLE", 1.0),
            ("SIM_PLD_HEIGHT", 0.0),
            ("SIM_PLD_ALT_LMT", 15.0),
            ("SIM_PLD_DIST_LMT", 10.0),
        ]);
        flier.reboot();
        // As the wire has them: single precision is a metre here.
        flier.set_all(&[("SIM_PLD_LAT", place.latitude_deg), ("SIM_PLD_LON", place.longitude_deg)]);
        flier.take_off(10.0, LOITER);
        flier.land();
        assert!(beside_m(&flier, target_m) < 1.5, "{:?}", flier.bench.position());
    }
}

/// A companion computer sees a place on the way from the vehicle, NED, m, in angles and a distance.
fn see(flier: &mut Flier, target_m: [f64; 3]) {
    let outputs = *flier.vehicle().outputs();
    let way_m = nalgebra::Vector3::from(target_m) - outputs.position_m;
    let body_m = outputs.orientation().inverse_transform_vector(&way_m);
    let message = LANDING_TARGET_DATA {
        angle_x: (body_m.y / body_m.z).atan() as f32,
        angle_y: -(body_m.x / body_m.z).atan() as f32,
        distance: body_m.norm() as f32,
        ..LANDING_TARGET_DATA::default()
    };
    flier.bench.send(MavMessage::LANDING_TARGET(message));
}

/// Suite: PrecisionLoiterCompanion.
#[test]
fn loiter_stays_above_what_a_companion_sees_if_a_switch_says_so() {
    let mut flier = Flier::new();
    flier.set_all(&[("PLND_ENABLED", 1.0), ("PLND_TYPE", 1.0), ("RC7_OPTION", 39.0)]);
    flier.rc(7, 1000);
    flier.reboot();
    flier.take_off(12.0, LOITER);
    flier.fly(3.0);
    flier.bench.heard.clear();
    let watch = |flier: &mut Flier, target_m: [f64; 3], seconds: f64| {
        for _ in 0..(seconds * 10.0) as usize {
            see(flier, target_m);
            flier.fly(0.1);
        }
    };
    let (east, west) = ([5.0, 10.0, -5.0], [5.0, -10.0, -5.0]);
    watch(&mut flier, east, 4.0);
    assert!(flier.has_said("PrecLand: Target Found") && flier.has_said("PrecLand: Init Complete"));
    assert!(flier.distance_m() < 0.5, "the switch is off");
    flier.rc(7, 2000);
    for target_m in [east, west] {
        watch(&mut flier, target_m, 15.0);
        for _ in 0..10 {
            watch(&mut flier, target_m, 1.0);
            let beside_m = beside_m(&flier, [target_m[0], target_m[1]]);
            assert!(beside_m < 0.1, "{beside_m} m beside");
        }
    }
    // The sticks go first.
    flier.rc(2, 1300);
    watch(&mut flier, west, 3.0);
    assert!(beside_m(&flier, [west[0], west[1]]) > 3.0);
    flier.rc(2, 1500);
    flier.fly(3.0);
    assert!(flier.has_said("PrecLand: Target Lost"));
}
