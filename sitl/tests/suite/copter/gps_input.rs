//! Fixes of a receiver from outside: GPS_INPUT.

use super::flier::*;
use crate::common::{Bench, settings};
use mavlink::dialects::ardupilotmega::*;
use nalgebra::Vector3;
use vehicle::estimation::{SensorModel, SensorSettings};
use vehicle::identity::Identity;

/// With instruments, and a receiver whose fixes come from outside.
fn fed() -> Flier {
    let mut start = settings(Identity::ArduPilot);
    start.sensors = SensorSettings { model: SensorModel::Realistic, seed: 1 };
    let mut flier = Flier::with(&start);
    flier.set_all(&[("GPS1_TYPE", 14.0), ("SIM_GPS1_ENABLE", 0.0)]);
    flier
}

/// The truth, moved on the map, m.
fn truth(flier: &Flier, moved_m: [f64; 2]) -> GPS_INPUT_DATA {
    let (vehicle, truth) = (flier.vehicle(), flier.vehicle().truth());
    let place = vehicle.frame().to_geodetic(&(truth.position_m + Vector3::new(moved_m[0], moved_m[1], 0.0)));
    let [vn, ve, vd] = truth.velocity_m_s.data.0[0].map(|axis| axis as f32);
    GPS_INPUT_DATA {
        time_usec: vehicle.time_us(),
        lat: (place.latitude_deg * 1e7).round() as i32,
        lon: (place.longitude_deg * 1e7).round() as i32,
        alt: place.altitude_m as f32,
        vn,
        ve,
        vd,
        speed_accuracy: 0.2,
        horiz_accuracy: 0.5,
        vert_accuracy: 0.8,
        fix_type: GpsFixType::GPS_FIX_TYPE_3D_FIX,
        satellites_visible: 15,
        ..GPS_INPUT_DATA::default()
    }
}

/// Ten fixes a second for a time, until a condition holds; whether it did.
fn feed(
    flier: &mut Flier,
    seconds: f64,
    fix: impl Fn(&Flier) -> GPS_INPUT_DATA,
    until: impl Fn(&Flier) -> bool,
) -> bool {
    for _ in 0..(seconds * 10.0) as usize {
        let fix = fix(flier);
        flier.bench.send(MavMessage::GPS_INPUT(fix));
        flier.fly(0.1);
        if until(flier) {
            return true;
        }
    }
    false
}

fn receiver(flier: &mut Flier) -> GPS_RAW_INT_DATA {
    let parameters = [24.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, parameters), ACCEPTED);
    let told = flier.latest(|message| match message {
        MavMessage::GPS_RAW_INT(receiver) => Some(receiver.clone()),
        _ => None,
    });
    told.expect("GPS_RAW_INT")
}

/// By how much the place that is known differs from the truth, north and east, m.
fn off_m(flier: &Flier) -> [f64; 2] {
    let off_m = flier.vehicle().outputs().position_m - flier.vehicle().truth().position_m;
    [off_m.x, off_m.y]
}

/// Suite: GPS_INPUT: nothing is known without the messages, and it flies by them.
#[test]
fn it_flies_by_fixes_from_outside() {
    let mut flier = fed();
    flier.change_mode(GUIDED);
    flier.fly(4.0);
    assert_eq!(receiver(&mut flier).fix_type, GpsFixType::GPS_FIX_TYPE_NO_FIX);
    assert!(flier.obstacles().iter().any(|text| text.contains("no GPS fix")), "{:?}", flier.bench.texts());
    let here = |flier: &Flier| truth(flier, [0.0; 2]);
    feed(&mut flier, 6.0, here, |_| false);
    let told = receiver(&mut flier);
    assert_eq!(
        (told.fix_type, told.satellites_visible, told.h_acc),
        (GpsFixType::GPS_FIX_TYPE_3D_FIX, 15, 500)
    );
    assert_eq!(flier.obstacles(), [] as [&str; 0]);
    flier.arm();
    let parameters = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 10.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_NAV_TAKEOFF, parameters), ACCEPTED);
    assert!(feed(&mut flier, 30.0, here, |flier| flier.height_m() > 9.0));
    flier.bench.send(crate::common::requests::local_target(0x0df8, [20.0, 0.0, -10.0], [0.0; 3]));
    let there =
        |flier: &Flier| (flier.vehicle().truth().position_m - Vector3::new(20.0, 0.0, -10.0)).norm() < 1.0;
    assert!(feed(&mut flier, 30.0, here, there));

    // What it is told counts, not where it is: a place 15 m to the east, without velocities or heights.
    let beside = |flier: &Flier| GPS_INPUT_DATA {
        ignore_flags: GpsInputIgnoreFlags::from_bits_truncate(1 | 8 | 16),
        alt: f32::NAN,
        vn: f32::NAN,
        ve: 9.0,
        vd: -9.0,
        ..truth(flier, [0.0, 15.0])
    };
    feed(&mut flier, 40.0, beside, |flier| (off_m(flier)[1] - 15.0).abs() < 1.0);
    assert!((off_m(&flier)[1] - 15.0).abs() < 1.0 && off_m(&flier)[0].abs() < 1.5, "{:?}", off_m(&flier));
    assert!((flier.height_m() - 10.0).abs() < 2.0, "{} m", flier.height_m());
    assert_eq!(receiver(&mut flier).vel, u16::MAX);
    // Without them the place is lost.
    flier.wait_mode(LAND, 60.0);
}

/// What nothing comes of is said once.
#[test]
fn fixes_that_are_not_used_are_told() {
    let said = |bench: &Bench, words: &str| bench.texts().iter().filter(|text| text.contains(words)).count();
    for (identity, gps_id, words) in [
        (Identity::ArduPilot, 0, "set GPS1_TYPE to 14"),
        (Identity::ArduPilot, 1, "gps_id must be 0"),
        (Identity::Px4, 0, "needs --autopilot ardupilot"),
    ] {
        let mut bench = Bench::new(identity);
        let place =
            GPS_INPUT_DATA { fix_type: GpsFixType::GPS_FIX_TYPE_3D_FIX, gps_id, ..GPS_INPUT_DATA::default() };
        for _ in 0..3 {
            bench.send(MavMessage::GPS_INPUT(place.clone()));
            bench.fly(0.1);
        }
        assert_eq!(said(&bench, words), 1, "{:?}", bench.texts());
    }
    // Ideal sensors know the truth.
    let mut flier = Flier::new();
    flier.bench.send(crate::common::requests::set_parameter("GPS1_TYPE", 14.0));
    flier.fly(0.1);
    assert!(flier.has_said("start with --sensors realistic"), "{:?}", flier.bench.texts());
}
