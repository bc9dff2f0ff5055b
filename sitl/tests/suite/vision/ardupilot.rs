//! By ArduPilot's parameters: what its own suite flies by a simulated motion capture system, in our words.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use super::camera::{Camera, never, obstacles, off_m, watch};
use crate::common::Bench;
use crate::common::failsafe_bench::set;
use crate::common::requests::local_target;
use mavlink::dialects::ardupilotmega::*;
use nalgebra::Vector3;
use vehicle::Mode;
use vehicle::identity::Identity;

const ACCEPTED: u8 = 0;

fn started(parameters: &[(&str, f64)]) -> Bench {
    super::camera::started(Identity::ArduPilot, parameters)
}

/// All by vision, without a receiver.
const ALONE: [(&str, f64); 8] = [
    ("GPS1_TYPE", 0.0),
    ("VISO_TYPE", 1.0),
    ("EK3_SRC1_POSXY", 6.0),
    ("EK3_SRC1_VELXY", 6.0),
    ("EK3_SRC1_POSZ", 6.0),
    ("EK3_SRC1_VELZ", 6.0),
    ("EK3_SRC1_YAW", 6.0),
    ("EK3_SRC_OPTIONS", 0.0),
];

fn origin(latitude: i32, longitude: i32) -> MavMessage {
    MavMessage::SET_GPS_GLOBAL_ORIGIN(SET_GPS_GLOBAL_ORIGIN_DATA {
        target_system: 1,
        latitude,
        longitude,
        altitude: 488_000,
        ..SET_GPS_GLOBAL_ORIGIN_DATA::default()
    })
}

fn take_off(bench: &mut Bench, see: impl Fn(&Bench) -> Vec<MavMessage>, height_m: f32) {
    assert_eq!(bench.set_mode(Mode::Offboard), ACCEPTED, "{:?}", bench.texts());
    assert_eq!(obstacles(bench), [] as [&str; 0]);
    bench.arm();
    let parameters = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height_m];
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, parameters), ACCEPTED);
    let up = |bench: &Bench| {
        let vehicle = bench.autopilot.vehicle();
        vehicle.home().position_m.z - vehicle.outputs().position_m.z > f64::from(height_m) - 0.5
    };
    assert!(watch(bench, 30.0, see, up), "{:?}", bench.texts());
}

fn fly_to(bench: &mut Bench, see: impl Fn(&Bench) -> Vec<MavMessage>, place: [f32; 3]) {
    bench.send(local_target(0x0df8, place, [0.0; 3]));
    watch(bench, 15.0, see, never);
}

/// Suite: VisionPosition: an origin is told, and it flies by VISION_POSITION_ESTIMATE and VISION_SPEED_ESTIMATE.
#[test]
fn it_flies_by_vision_alone_once_the_origin_is_told() {
    let mut bench = started(&ALONE);
    bench.set_mode(Mode::Offboard);
    bench.fly(3.0);
    let missing = obstacles(&bench);
    assert!(missing.iter().any(|text| text == "no vision estimates"), "{missing:?}");
    let see = |bench: &Bench| vec![Camera::ALIGNED.estimate(bench), Camera::ALIGNED.speed(bench)];
    watch(&mut bench, 4.0, see, never);
    let missing = obstacles(&bench);
    assert!(missing.iter().any(|text| text.contains("SET_GPS_GLOBAL_ORIGIN")), "{missing:?}");
    // Far from where the simulation takes place: that is what the vehicle is told.
    bench.send(origin(-353_632_610, 1_491_652_300));
    bench.fly(0.1);
    let told = bench.autopilot.vehicle().told_frame().origin();
    assert!((told.latitude_deg + 35.363_261).abs() < 1e-7, "{told:?}");
    watch(&mut bench, 1.0, see, never);
    take_off(&mut bench, see, 5.0);
    fly_to(&mut bench, see, [6.0, -4.0, -5.0]);
    let truth_m = bench.autopilot.vehicle().truth().position_m;
    assert!((truth_m - Vector3::new(6.0, -4.0, -5.0)).norm() < 0.2, "{truth_m:?}");
    assert!(off_m(&bench, truth_m) < 0.15);
    let place = bench.autopilot.vehicle().frame().to_geodetic(&truth_m);
    assert!((place.longitude_deg - 149.165_23).abs() < 1e-3, "{place:?}");
    // An origin is told once.
    bench.heard.clear();
    bench.send(origin(473_979_710, 85_461_637));
    bench.fly(0.1);
    assert!(bench.texts().iter().any(|text| text.contains("Origin refused")), "{:?}", bench.texts());
    // Vision stops: the failsafe of a lost place lands.
    bench.fly_until("Land", 30.0, |bench| bench.mode() == Mode::Land);
    bench.fly_until("disarmed", 60.0, |bench| !bench.autopilot.vehicle().is_armed());
}

/// The same by VICON_POSITION_ESTIMATE, GLOBAL_VISION_POSITION_ESTIMATE, ATT_POS_MOCAP and ODOMETRY.
#[test]
fn other_messages_tell_the_same() {
    for kind in 0..4 {
        let mut bench = started(&ALONE);
        bench.send(origin(473_979_710, 85_461_637));
        let see = move |bench: &Bench| {
            let MavMessage::VISION_POSITION_ESTIMATE(seen) = Camera::ALIGNED.estimate(bench) else {
                return Vec::new();
            };
            let VISION_POSITION_ESTIMATE_DATA { usec, x, y, z, roll, pitch, yaw, .. } = seen;
            let attitude = Camera::ALIGNED.attitude(bench);
            vec![match kind {
                0 => MavMessage::VICON_POSITION_ESTIMATE(VICON_POSITION_ESTIMATE_DATA {
                    usec,
                    x,
                    y,
                    z,
                    roll,
                    pitch,
                    yaw,
                    ..VICON_POSITION_ESTIMATE_DATA::default()
                }),
                1 => MavMessage::GLOBAL_VISION_POSITION_ESTIMATE(GLOBAL_VISION_POSITION_ESTIMATE_DATA {
                    usec,
                    x,
                    y,
                    z,
                    roll,
                    pitch,
                    yaw,
                    ..GLOBAL_VISION_POSITION_ESTIMATE_DATA::default()
                }),
                2 => MavMessage::ATT_POS_MOCAP(ATT_POS_MOCAP_DATA {
                    time_usec: usec,
                    q: [attitude.w as f32, attitude.i as f32, attitude.j as f32, attitude.k as f32],
                    x,
                    y,
                    z,
                    ..ATT_POS_MOCAP_DATA::default()
                }),
                _ => Camera::ALIGNED.odometry(bench),
            }]
        };
        watch(&mut bench, 5.0, see, never);
        bench.send(origin(473_979_710, 85_461_637));
        take_off(&mut bench, see, 3.0);
        fly_to(&mut bench, see, [3.0, 1.0, -3.0]);
        let truth_m = bench.autopilot.vehicle().truth().position_m;
        assert!((truth_m - Vector3::new(3.0, 1.0, -3.0)).norm() < 0.2, "{kind}: {truth_m:?}");
    }
}

/// Suite: BodyFrameOdom: VISION_POSITION_DELTA tells how it moves, and nothing where it is.
#[test]
fn it_flies_by_changes_of_the_place() {
    let mut bench = started(&ALONE);
    for (name, value) in [("EK3_SRC1_POSXY", 0.0), ("EK3_SRC1_POSZ", 1.0), ("EK3_SRC1_YAW", 1.0)] {
        set(&mut bench, name, value);
    }
    let see = |bench: &Bench| {
        let body_m_s = Camera::ALIGNED.attitude(bench).inverse() * Camera::ALIGNED.velocity_m_s(bench);
        vec![MavMessage::VISION_POSITION_DELTA(VISION_POSITION_DELTA_DATA {
            time_usec: bench.autopilot.vehicle().time_us(),
            time_delta_usec: 33_000,
            position_delta: (body_m_s * 0.033).data.0[0].map(|axis| axis as f32),
            confidence: 90.0,
            ..VISION_POSITION_DELTA_DATA::default()
        })]
    };
    watch(&mut bench, 5.0, see, never);
    bench.send(origin(473_979_710, 85_461_637));
    take_off(&mut bench, see, 5.0);
    fly_to(&mut bench, see, [10.0, 5.0, -5.0]);
    let truth_m = bench.autopilot.vehicle().truth().position_m;
    assert!((truth_m - Vector3::new(10.0, 5.0, -5.0)).norm() < 1.5, "{truth_m:?}");
    assert!(bench.autopilot.vehicle().validity().horizontal_position);
}

/// Suite: GPSViconSwitching and EKFSource: sets are changed in flight, by command and by switch 90.
#[test]
fn sets_of_sources_are_changed_in_flight() {
    let mut bench = started(&[
        ("VISO_TYPE", 1.0),
        ("EK3_SRC2_POSXY", 6.0),
        ("EK3_SRC2_VELXY", 6.0),
        ("EK3_SRC2_POSZ", 1.0),
        ("EK3_SRC2_VELZ", 6.0),
        ("EK3_SRC2_YAW", 1.0),
        ("EK3_SRC_OPTIONS", 0.0),
    ]);
    let camera = Camera { error_m: [4.0, 0.0, 0.0], ..Camera::ALIGNED };
    let see = |bench: &Bench| vec![camera.estimate(bench), camera.speed(bench)];
    watch(&mut bench, 5.0, see, never);
    take_off(&mut bench, see, 5.0);
    // By GPS the camera's error counts for nothing; by vision it is the truth.
    let of_camera = |bench: &Bench| off_m(bench, camera.place_m(bench));
    watch(&mut bench, 2.0, see, never);
    let set_source = |bench: &mut Bench, set: f32| {
        bench.command(MavCmd::MAV_CMD_SET_EKF_SOURCE_SET, [set, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    };
    // What the place leaps by is told by and by.
    assert_eq!(set_source(&mut bench, 2.0), ACCEPTED);
    watch(&mut bench, 25.0, see, never);
    assert!(of_camera(&bench) < 1.0, "{}", of_camera(&bench));
    let horizontal_m = (bench.autopilot.vehicle().outputs().position_m - camera.place_m(&bench)).xy().norm();
    assert!(horizontal_m < 0.15, "{horizontal_m}");
    // Jamming is no matter now, and neither is the receiver.
    set(&mut bench, "SIM_GPS1_ENABLE", 0.0);
    watch(&mut bench, 8.0, see, never);
    assert_eq!(bench.mode(), Mode::Offboard, "{:?}", bench.texts());
    set(&mut bench, "SIM_GPS1_ENABLE", 1.0);
    watch(&mut bench, 3.0, see, never);
    assert_eq!(
        bench.command(MavCmd::MAV_CMD_DO_AUX_FUNCTION, [90.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        ACCEPTED
    );
    watch(&mut bench, 15.0, see, never);
    let truth_m = bench.autopilot.vehicle().truth().position_m;
    // GPS is off by metres, but not by what the camera is.
    let gps_m = bench.autopilot.vehicle().readings().gps.expect("a fix").position_m;
    assert!(
        (bench.autopilot.vehicle().outputs().position_m - gps_m).xy().norm() < 2.5,
        "{truth_m:?} {gps_m:?}"
    );
    assert_eq!(set_source(&mut bench, 4.0), 2, "there is no fourth set");
    // A set of nothing: the place is lost.
    assert_eq!(set_source(&mut bench, 3.0), ACCEPTED);
    bench.fly_until("Land", 30.0, |bench| bench.mode() == Mode::Land);
}

/// Sources that there are not keep it from arming.
#[test]
fn sources_without_visual_odometry_keep_it_from_arming() {
    let mut bench = started(&[("EK3_SRC2_POSXY", 6.0)]);
    bench.fly(4.0);
    let missing = obstacles(&bench);
    assert!(missing.iter().any(|text| text.contains("EK3 sources require VisualOdom")), "{missing:?}");
    set(&mut bench, "VISO_TYPE", 1.0);
    bench.fly(1.0);
    assert_eq!(obstacles(&bench), [] as [&str; 0]);
}

/// VISO_SCALE: a camera that counts in half metres.
#[test]
fn positions_have_the_scale_that_is_said() {
    let mut bench = started(&ALONE);
    set(&mut bench, "VISO_SCALE", 0.5);
    bench.send(origin(473_977_420, 85_455_940));
    let see = |bench: &Bench| {
        let MavMessage::VISION_POSITION_ESTIMATE(mut estimate) = Camera::ALIGNED.estimate(bench) else {
            unreachable!("that is what it sends")
        };
        (estimate.x, estimate.y, estimate.z) = (2.0 * estimate.x, 2.0 * estimate.y, 2.0 * estimate.z);
        vec![MavMessage::VISION_POSITION_ESTIMATE(estimate), Camera::ALIGNED.speed(bench)]
    };
    watch(&mut bench, 4.0, see, never);
    take_off(&mut bench, see, 5.0);
    fly_to(&mut bench, see, [6.0, -4.0, -5.0]);
    let truth = bench.autopilot.vehicle().truth().position_m;
    assert!((truth - Vector3::new(6.0, -4.0, -5.0)).norm() < 0.5, "{truth}");
}
