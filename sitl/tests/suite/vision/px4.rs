//! By PX4's parameters.

use super::camera::{Camera, never, obstacles, off_m, watch};
use crate::common::Bench;
use crate::common::requests::local_target;
use mavlink::dialects::ardupilotmega::*;
use nalgebra::Vector3;
use vehicle::Mode;
use vehicle::identity::Identity;

fn started(parameters: &[(&str, f64)]) -> Bench {
    super::camera::started(Identity::Px4, parameters)
}

/// Without GPS and compass.
const ALONE: [(&str, f64); 4] =
    [("EKF2_GPS_CTRL", 0.0), ("EKF2_EV_CTRL", 15.0), ("EKF2_HGT_REF", 3.0), ("EKF2_MAG_TYPE", 5.0)];

fn estimate(camera: Camera) -> impl Fn(&Bench) -> Vec<MavMessage> {
    move |bench| vec![camera.estimate(bench)]
}

/// Takes off, and flies to a place as the camera counts, NED, m.
fn fly_to(bench: &mut Bench, see: impl Fn(&Bench) -> Vec<MavMessage>, place: [f32; 3]) {
    bench.arm();
    let parameters = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, f32::NAN];
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, parameters), 0, "{:?}", bench.texts());
    assert!(watch(bench, 20.0, &see, |bench| bench.mode() == Mode::Hold), "{:?}", bench.texts());
    let with_target = |bench: &Bench| {
        let mut messages = see(bench);
        messages.push(local_target(0x0df8, place, [0.0; 3]));
        messages
    };
    watch(bench, 0.5, with_target, never);
    assert_eq!(bench.set_mode(Mode::Offboard), 0, "{:?}", bench.texts());
    watch(bench, 15.0, with_target, never);
}

#[test]
fn it_flies_by_vision_alone_and_its_loss_is_that_of_the_place() {
    let mut bench = started(&ALONE);
    bench.fly(4.0);
    assert!(obstacles(&bench).iter().any(|text| text == "no vision estimates"), "{:?}", obstacles(&bench));
    let see = estimate(Camera::ALIGNED);
    watch(&mut bench, 3.0, &see, never);
    assert_eq!(obstacles(&bench), [] as [&str; 0]);
    fly_to(&mut bench, &see, [4.0, -3.0, -3.0]);
    let truth_m = bench.autopilot.vehicle().truth().position_m;
    assert!((truth_m - Vector3::new(4.0, -3.0, -3.0)).norm() < 0.15, "{truth_m:?}");
    assert!(off_m(&bench, truth_m) < 0.1, "{}", off_m(&bench, truth_m));
    // Nobody sees it any more: after 5 s the place is lost, and it comes down.
    bench.heard.clear();
    bench.stream(8.0, |bench| bench.send(local_target(0x0df8, [4.0, -3.0, -3.0], [0.0; 3])));
    let vehicle = bench.autopilot.vehicle();
    assert!(!vehicle.validity().horizontal_position && !vehicle.instrument_health().vision);
    assert_ne!(bench.mode(), Mode::Offboard, "{:?}", bench.texts());
    bench.fly_until("on the ground", 60.0, |bench| !bench.autopilot.vehicle().is_armed());
}

/// The place is what the camera calls it, wherever its origin and its first axis are.
#[test]
fn odometry_in_a_frame_of_its_own_is_flown_in_that_frame() {
    let camera = Camera { origin_m: [12.0, -7.0, 0.5], turn_rad: 0.7, ..Camera::ALIGNED };
    let mut bench = started(&ALONE);
    bench.fly(3.0);
    let see = |bench: &Bench| vec![camera.odometry(bench)];
    watch(&mut bench, 3.0, see, never);
    assert_eq!(obstacles(&bench), [] as [&str; 0]);
    let heading_rad = bench.autopilot.vehicle().outputs().attitude_rad.z;
    let seen_rad = camera.attitude(&bench).euler_angles().2;
    assert!((heading_rad - seen_rad).abs() < 0.05, "{heading_rad} {seen_rad}");
    let start_m = camera.place_m(&bench);
    let goal_m = start_m + Vector3::new(3.0, 2.0, -3.0);
    fly_to(&mut bench, see, goal_m.data.0[0].map(|axis| axis as f32));
    let there_m = camera.place_m(&bench);
    assert!((there_m - goal_m).norm() < 0.15, "{there_m:?} {goal_m:?}");
    assert!(off_m(&bench, there_m) < 0.1);
}

/// With the compass, a frame that points anywhere is turned to north.
#[test]
fn a_frame_that_points_anywhere_is_turned_by_the_compass() {
    let camera = Camera { turn_rad: -1.2, ..Camera::ALIGNED };
    let mut bench = started(&[("EKF2_GPS_CTRL", 0.0), ("EKF2_EV_CTRL", 7.0), ("EKF2_HGT_REF", 3.0)]);
    bench.fly(3.0);
    let see = |bench: &Bench| vec![camera.odometry(bench)];
    watch(&mut bench, 3.0, see, never);
    fly_to(&mut bench, see, [3.0, 2.0, -3.0]);
    let truth_m = bench.autopilot.vehicle().truth().position_m;
    // The compass is off by a degree or two.
    assert!(off_m(&bench, truth_m) < 0.3, "{}", off_m(&bench, truth_m));
    assert!((truth_m - Vector3::new(3.0, 2.0, -3.0)).norm() < 0.4, "{truth_m:?}");
}

#[test]
fn an_outlier_is_not_believed_and_a_reset_is() {
    let mut bench = started(&ALONE);
    let see = estimate(Camera::ALIGNED);
    watch(&mut bench, 5.0, &see, never);
    fly_to(&mut bench, &see, [0.0, 0.0, -3.0]);
    let wrong = Camera { error_m: [8.0, 0.0, 0.0], ..Camera::ALIGNED };
    watch(&mut bench, 0.5, estimate(wrong), never);
    let truth_m = bench.autopilot.vehicle().truth().position_m;
    assert!(off_m(&bench, truth_m) < 0.2, "{}", off_m(&bench, truth_m));
    watch(&mut bench, 1.0, &see, never);
    // The same place under another counter of resets is a new one. Controllers are told by and by.
    let moved = Camera { resets: 1, error_m: [1.0, -0.5, 0.0], ..Camera::ALIGNED };
    watch(&mut bench, 0.2, estimate(moved), never);
    let filter_m =
        bench.autopilot.vehicle().navigation().expect("instruments").estimator().moment().position_m;
    assert!((filter_m - moved.place_m(&bench)).norm() < 0.15, "{filter_m:?}");
    watch(&mut bench, 8.0, estimate(moved), never);
    assert!(off_m(&bench, moved.place_m(&bench)) < 0.15, "{}", off_m(&bench, moved.place_m(&bench)));
}

/// Beside GPS, vision tells changes, and GPS where they add up to.
#[test]
fn beside_gps_the_place_stays_that_of_gps() {
    let camera = Camera { origin_m: [100.0, 50.0, -20.0], ..Camera::ALIGNED };
    let mut bench = started(&[("EKF2_EV_CTRL", 7.0)]);
    let see = |bench: &Bench| vec![camera.odometry(bench)];
    watch(&mut bench, 6.0, see, never);
    assert_eq!(obstacles(&bench), [] as [&str; 0]);
    fly_to(&mut bench, see, [5.0, 0.0, -4.0]);
    let truth_m = bench.autopilot.vehicle().truth().position_m;
    assert!(off_m(&bench, truth_m) < 6.0, "{}", off_m(&bench, truth_m));
    // GPS alone goes on.
    bench.stream(10.0, |bench| bench.send(local_target(0x0df8, [5.0, 0.0, -4.0], [0.0; 3])));
    assert_eq!(bench.mode(), Mode::Offboard);
    assert!(bench.autopilot.vehicle().validity().horizontal_position);
}

/// Estimates that are late, and of a place beside the inertial unit, tell the same once both are known.
#[test]
fn delay_and_place_are_taken_into_account() {
    let mut parameters = ALONE.to_vec();
    parameters.extend([("EKF2_EV_DELAY", 99.0), ("EKF2_EV_POS_X", 0.5), ("EKF2_EVP_NOISE", 0.02)]);
    let mut bench = started(&parameters);
    let sent = std::cell::RefCell::new(std::collections::VecDeque::new());
    let see = |bench: &Bench| {
        let MavMessage::VISION_POSITION_ESTIMATE(mut seen) = Camera::ALIGNED.estimate(bench) else {
            return Vec::new();
        };
        let ahead = Camera::ALIGNED.attitude(bench) * Vector3::new(0.5, 0.0, 0.0);
        (seen.x, seen.y, seen.z) =
            (seen.x + ahead.x as f32, seen.y + ahead.y as f32, seen.z + ahead.z as f32);
        let mut sent = sent.borrow_mut();
        sent.push_back(MavMessage::VISION_POSITION_ESTIMATE(seen));
        // Three looks of 33 ms later.
        if sent.len() > 3 { sent.pop_front().into_iter().collect() } else { Vec::new() }
    };
    watch(&mut bench, 6.0, see, never);
    assert_eq!(obstacles(&bench), [] as [&str; 0]);
    fly_to(&mut bench, see, [0.0, 0.0, -3.0]);
    // On the way, not where it stands.
    let worst_m = std::cell::Cell::new(0.0_f64);
    let with_target = |bench: &Bench| {
        let mut messages = see(bench);
        messages.push(local_target(0x0df8, [20.0, 0.0, -3.0], [0.0; 3]));
        messages
    };
    watch(&mut bench, 4.0, with_target, |bench| {
        worst_m.set(worst_m.get().max(off_m(bench, bench.autopilot.vehicle().truth().position_m)));
        false
    });
    let speed_m_s = bench.autopilot.vehicle().truth().velocity_m_s.norm();
    assert!(speed_m_s > 2.0, "{speed_m_s}");
    assert!(worst_m.get() < 0.15, "{} m", worst_m.get());
}
