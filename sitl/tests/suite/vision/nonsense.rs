//! Numbers without meaning: nothing breaks, and the estimate stays one.

use super::camera::{Camera, never, off_m, started, watch};
use crate::common::Bench;
use autopilot::codec::Frame;
use mavlink::Message as _;
use mavlink::dialects::ardupilotmega::MavMessage;
use proptest::prelude::*;
use vehicle::identity::Identity;

/// All messages with estimates, and the lengths of their payloads.
const MESSAGES: [(u32, usize); 7] =
    [(101, 117), (102, 117), (103, 57), (104, 116), (138, 120), (331, 233), (11011, 44)];

fn framed(id: u32, payload: &[u8]) -> Frame {
    let [low, middle, high, _] = id.to_le_bytes();
    let mut bytes = vec![0xfd, payload.len() as u8, 0, 0, 7, 255, 190, low, middle, high];
    bytes.extend(payload);
    let checksum = mavlink::calculate_crc(&bytes[1..], MavMessage::extra_crc(id));
    bytes.extend(checksum.to_le_bytes());
    Frame::parse(&bytes).expect("a frame")
}

/// One that fuses all there is, and has aligned.
fn fused(ardupilot: bool) -> Bench {
    let identity = if ardupilot { Identity::ArduPilot } else { Identity::Px4 };
    let parameters: &[(&str, f64)] = if ardupilot {
        &[
            ("VISO_TYPE", 1.0),
            ("EK3_SRC1_POSXY", 6.0),
            ("EK3_SRC1_VELXY", 6.0),
            ("EK3_SRC1_POSZ", 6.0),
            ("EK3_SRC1_VELZ", 6.0),
            ("EK3_SRC1_YAW", 6.0),
        ]
    } else {
        &[("EKF2_EV_CTRL", 15.0), ("EKF2_GPS_CTRL", 0.0), ("EKF2_HGT_REF", 3.0)]
    };
    let mut bench = started(identity, parameters);
    watch(&mut bench, 3.0, |bench| vec![Camera::ALIGNED.estimate(bench)], never);
    bench
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Any payload, and any numbers where numbers are: all of the estimate stays finite, and sense is believed again.
    #[test]
    fn any_estimate_is_survived(
        messages in prop::collection::vec(
            (prop::sample::select(&MESSAGES[..]), prop::collection::vec(any::<f32>(), 60), any::<[u8; 5]>(), any::<bool>()), 1..40),
        ardupilot in any::<bool>(),
    ) {
        let mut bench = fused(ardupilot);
        for ((id, length), numbers, end, tame) in messages {
            let numbers = numbers.iter().map(|number| if tame && number.is_finite() { number.rem_euclid(50.0) } else { *number });
            let mut payload: Vec<u8> = numbers.flat_map(f32::to_le_bytes).collect();
            payload.truncate(length);
            if id == 331 {
                // Frames that mean something, so that more than their numbers is looked at.
                payload[228..].copy_from_slice(&[if tame { 20 } else { end[0] }, if tame { 12 } else { end[1] }, end[2], end[3] % 4, end[4]]);
            }
            bench.receive(&framed(id, &payload));
            bench.fly(0.01);
        }
        let outputs = bench.autopilot.vehicle().outputs();
        let numbers = outputs.position_m.iter().chain(&outputs.velocity_m_s).chain(&outputs.attitude_rad);
        prop_assert!(numbers.copied().all(f64::is_finite), "{outputs:?}");
        let covariance = bench.autopilot.vehicle().navigation().expect("instruments").estimator().covariance();
        prop_assert!(covariance.to_rows().iter().flatten().all(|entry| entry.is_finite()));
        // After a silence it begins anew.
        bench.fly(1.5);
        watch(&mut bench, 12.0, |bench| vec![Camera::ALIGNED.estimate(bench)], never);
        let truth_m = bench.autopilot.vehicle().truth().position_m;
        prop_assert!(off_m(&bench, truth_m) < 0.5, "{} m off", off_m(&bench, truth_m));
    }
}
