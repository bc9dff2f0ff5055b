//! What nothing comes of is said once, with the reason and the remedy.

use super::camera::{Camera, started};
use crate::common::Bench;
use crate::common::failsafe_bench::set;
use mavlink::dialects::ardupilotmega::*;
use vehicle::identity::Identity;

/// How often words are said while a message is sent three times.
fn said(bench: &mut Bench, message: &MavMessage, words: &str) -> usize {
    bench.heard.clear();
    for _ in 0..3 {
        bench.send(message.clone());
        bench.fly(0.1);
    }
    let texts = bench.texts();
    let count = texts.iter().filter(|text| text.contains(words)).count();
    assert!(count > 0, "{words}: {texts:?}");
    count
}

#[test]
fn each_reason_is_said_once() {
    let mut px4 = started(Identity::Px4, &[]);
    let (estimate, speed) = (Camera::ALIGNED.estimate(&px4), Camera::ALIGNED.speed(&px4));
    assert_eq!(said(&mut px4, &estimate, "VISION_POSITION_ESTIMATE is ignored: set EKF2_EV_CTRL"), 1);
    assert_eq!(said(&mut px4, &speed, "VISION_SPEED_ESTIMATE is ignored: as by PX4"), 1);
    set(&mut px4, "EKF2_EV_CTRL", 15.0);
    let MavMessage::ODOMETRY(odometry) = Camera::ALIGNED.odometry(&px4) else { panic!("odometry") };
    let mocap = ODOMETRY_DATA { estimator_type: MavEstimatorType::MAV_ESTIMATOR_TYPE_MOCAP, ..odometry };
    assert_eq!(said(&mut px4, &MavMessage::ODOMETRY(mocap.clone()), "fuses no estimator_type 6"), 1);
    let long = ODOMETRY_DATA {
        q: [1.1, 0.0, 0.0, 0.0],
        estimator_type: MavEstimatorType::MAV_ESTIMATOR_TYPE_VIO,
        ..mocap.clone()
    };
    assert_eq!(
        said(&mut px4, &MavMessage::ODOMETRY(long.clone()), "its quaternion must have the length 1"),
        1
    );
    set(&mut px4, "EKF2_EV_QMIN", 95.0);
    assert_eq!(said(&mut px4, &MavMessage::ODOMETRY(long), "quality 90 % is below EKF2_EV_QMIN = 95 %"), 1);
    let far = VISION_POSITION_ESTIMATE_DATA { x: 1e9, ..VISION_POSITION_ESTIMATE_DATA::default() };
    assert_eq!(said(&mut px4, &MavMessage::VISION_POSITION_ESTIMATE(far), "at most 100 km"), 1);

    let mut ardupilot = started(Identity::ArduPilot, &[]);
    assert_eq!(said(&mut ardupilot, &estimate, "set VISO_TYPE to 1"), 1);
    set(&mut ardupilot, "VISO_TYPE", 1.0);
    assert_eq!(said(&mut ardupilot, &speed, "set EK3_SRC1_POSXY, VELXY"), 1);
    let elsewhere = ODOMETRY_DATA { frame_id: MavFrame::MAV_FRAME_LOCAL_NED, ..mocap };
    assert_eq!(said(&mut ardupilot, &MavMessage::ODOMETRY(elsewhere), "only LOCAL_FRD (20)"), 1);
}

/// Ideal sensors know the truth: parameters of programs that send estimates are taken, and the first estimate is answered by what it needs.
#[test]
fn ideal_sensors_fuse_nothing_and_say_so() {
    for (identity, parameters) in [
        (Identity::Px4, &[("EKF2_EV_CTRL", 15.0)][..]),
        (Identity::ArduPilot, &[("VISO_TYPE", 1.0), ("EK3_SRC1_POSXY", 6.0)][..]),
    ] {
        let mut bench = Bench::new(identity);
        for (name, value) in parameters {
            set(&mut bench, name, *value);
        }
        let estimate = Camera::ALIGNED.estimate(&bench);
        assert_eq!(said(&mut bench, &estimate, "start with --sensors realistic"), 1);
        bench.arm();
    }
}
