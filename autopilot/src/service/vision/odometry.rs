//! ODOMETRY: a pose in one frame, and a velocity in another.

use nalgebra::Vector3;
use vehicle::estimation::vision::{Measured, VelocityFrame, VisionReading};

use super::pose::{attitude, variances, vector};
use crate::codec::Payload;

/// Frames of MAVLink.
const LOCAL_NED: u8 = 1;
const LOCAL_ENU: u8 = 4;
const BODY_NED: u8 = 8;
const BODY_OFFSET_NED: u8 = 9;
const BODY_FRD: u8 = 12;
const LOCAL_FRD: u8 = 20;
const LOCAL_FLU: u8 = 21;
/// Kinds of estimators: what PX4 takes for vision, and one without covariances.
const NAIVE: u8 = 1;
const VISUAL_INERTIAL: u8 = 3;
const MOTION_CAPTURE: u8 = 6;

/// What PX4 makes of a message.
///
/// # Errors
/// Why it makes nothing of it.
pub fn by_px4(payload: &Payload<'_>, tolerance: f64) -> Result<VisionReading, String> {
    let [frame, child, kind] = [228, 229, 231].map(|at| payload.u8(at));
    match kind {
        0..=VISUAL_INERTIAL => {}
        MOTION_CAPTURE => {
            return Err("PX4's estimator fuses no estimator_type 6 (MOCAP); send 2 (VISION)".to_owned());
        }
        kind => return Err(format!("estimator_type {kind} is not 0 to 3 (UNKNOWN, NAIVE, VISION, VIO)")),
    }
    let knows_variances = kind != NAIVE;
    let (variance, heading_variance) =
        if knows_variances { variances(&payload.reals(60)) } else { (Vector3::repeat(f64::NAN), f64::NAN) };
    let place = match frame {
        LOCAL_NED | LOCAL_FRD => Some(kept as fn(Vector3<f64>) -> Vector3<f64>),
        LOCAL_ENU => Some(from_enu as fn(Vector3<f64>) -> Vector3<f64>),
        LOCAL_FLU => Some(from_flu as fn(Vector3<f64>) -> Vector3<f64>),
        _ => None,
    };
    let motion = match child {
        LOCAL_NED => Some((VelocityFrame::North, kept as fn(Vector3<f64>) -> Vector3<f64>)),
        LOCAL_ENU => Some((VelocityFrame::North, from_enu as fn(Vector3<f64>) -> Vector3<f64>)),
        LOCAL_FRD => Some((VelocityFrame::Free, kept as fn(Vector3<f64>) -> Vector3<f64>)),
        LOCAL_FLU => Some((VelocityFrame::Free, from_flu as fn(Vector3<f64>) -> Vector3<f64>)),
        BODY_NED | BODY_OFFSET_NED | BODY_FRD => {
            Some((VelocityFrame::Body, kept as fn(Vector3<f64>) -> Vector3<f64>))
        }
        _ => None,
    };
    if place.is_none() && motion.is_none() {
        return Err(format!(
            "frame_id {frame} and child_frame_id {child}: PX4 takes LOCAL_FRD (20) and BODY_FRD (12)"
        ));
    }
    // A variance has no direction: axes change their places, but not their signs.
    let rows = |variance: Vector3<f64>, frame: u8| {
        if frame == LOCAL_ENU { Vector3::new(variance.y, variance.x, variance.z) } else { variance }
    };
    let velocity_variance =
        if knows_variances { variances(&payload.reals(144)).0 } else { Vector3::repeat(f64::NAN) };
    let position = place.zip(vector(payload.reals(8)));
    let velocity = motion.zip(vector(payload.reals(36)));
    Ok(VisionReading {
        position: position
            .map(|(ned, value)| Measured { value: ned(value), variance: rows(variance, frame) }),
        velocity: velocity.map(|((axes, ned), value)| {
            (axes, Measured { value: ned(value), variance: rows(velocity_variance, child) })
        }),
        attitude: attitude(payload.reals(20), tolerance).map(|attitude| (attitude, heading_variance)),
        points_north: matches!(frame, LOCAL_NED | LOCAL_ENU),
        resets: payload.u8(230),
        quality: payload.u8(232) as i8,
    })
}

/// What ArduPilot makes of a message: its frames are those of its own, north included.
///
/// # Errors
/// Why it makes nothing of it.
pub fn by_ardupilot(payload: &Payload<'_>, tolerance: f64) -> Result<VisionReading, String> {
    let [frame, child] = [228, 229].map(|at| payload.u8(at));
    if (frame, child) != (LOCAL_FRD, BODY_FRD) {
        return Err(format!(
            "frame_id {frame} and child_frame_id {child}: only LOCAL_FRD (20) and BODY_FRD (12)"
        ));
    }
    let (variance, heading_variance) = variances(&payload.reals(60));
    let velocity_variance = variances(&payload.reals(144)).0;
    let attitude = attitude(payload.reals(20), tolerance);
    let velocity = vector(payload.reals(36)).zip(attitude);
    Ok(VisionReading {
        position: vector(payload.reals(8)).map(|value| Measured { value, variance }),
        velocity: velocity.map(|(value, attitude)| {
            (VelocityFrame::North, Measured { value: attitude * value, variance: velocity_variance })
        }),
        attitude: attitude.map(|attitude| (attitude, heading_variance)),
        points_north: true,
        resets: payload.u8(230),
        quality: payload.u8(232) as i8,
    })
}

fn kept(vector: Vector3<f64>) -> Vector3<f64> {
    vector
}

fn from_enu(vector: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(vector.y, vector.x, -vector.z)
}

fn from_flu(vector: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(vector.x, -vector.y, -vector.z)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use vehicle::estimation::vision::VelocityFrame;

    use super::{by_ardupilot, by_px4};
    use crate::codec::Payload;

    /// 1, 2, 3 m, a quarter turn to the right, 4, 5, 6 m/s.
    fn message(frame: u8, child: u8, kind: u8) -> Vec<u8> {
        let half = core::f32::consts::FRAC_1_SQRT_2;
        let numbers = [1.0, 2.0, 3.0, half, 0.0, 0.0, half, 4.0, 5.0, 6.0, 0.0, 0.0, 0.0];
        let mut bytes = vec![0; 8];
        bytes.extend(numbers.iter().flat_map(|number: &f32| number.to_le_bytes()));
        for row in 1..=2 {
            let triangle = (0..21).map(|at| (row * 100 + at) as f32);
            bytes.extend(triangle.flat_map(f32::to_le_bytes));
        }
        bytes.extend([frame, child, 9, kind, 80]);
        bytes
    }

    #[test]
    fn frames_are_turned_to_ours() {
        let frames = [
            (1, [1.0, 2.0, 3.0], true, [100.0, 106.0, 111.0]),
            (4, [2.0, 1.0, -3.0], true, [106.0, 100.0, 111.0]),
            (20, [1.0, 2.0, 3.0], false, [100.0, 106.0, 111.0]),
            (21, [1.0, -2.0, -3.0], false, [100.0, 106.0, 111.0]),
        ];
        for (frame, place, north, variance) in frames {
            let reading = by_px4(&Payload::new(&message(frame, 12, 2)), 1e-5).expect("taken");
            let position = reading.position.expect("a position");
            assert_eq!(position.value, Vector3::from(place), "frame {frame}");
            assert_eq!(position.variance, Vector3::from(variance), "frame {frame}");
            assert_eq!((reading.points_north, reading.resets, reading.quality), (north, 9, 80));
        }
        let children = [
            (1, VelocityFrame::North, [4.0, 5.0, 6.0]),
            (4, VelocityFrame::North, [5.0, 4.0, -6.0]),
            (20, VelocityFrame::Free, [4.0, 5.0, 6.0]),
            (21, VelocityFrame::Free, [4.0, -5.0, -6.0]),
            (8, VelocityFrame::Body, [4.0, 5.0, 6.0]),
            (12, VelocityFrame::Body, [4.0, 5.0, 6.0]),
        ];
        for (child, axes, motion) in children {
            let reading = by_px4(&Payload::new(&message(20, child, 3)), 1e-5).expect("taken");
            let (frame, velocity) = reading.velocity.expect("a velocity");
            assert_eq!((frame, velocity.value), (axes, Vector3::from(motion)), "child frame {child}");
        }
        // A naive estimator knows no covariances.
        let reading = by_px4(&Payload::new(&message(1, 12, 1)), 1e-5).expect("taken");
        assert!(reading.position.expect("a position").variance.x.is_nan());
    }

    #[test]
    fn what_an_autopilot_does_not_take_is_refused_with_the_reason() {
        let refused = |frame, child, kind| {
            by_px4(&Payload::new(&message(frame, child, kind)), 1e-5).expect_err("refused")
        };
        assert!(refused(20, 12, 6).contains("MOCAP"));
        assert!(refused(20, 12, 8).contains("estimator_type 8"));
        assert!(refused(0, 0, 2).contains("frame_id 0"));
        let of_ardupilot = |frame, child| by_ardupilot(&Payload::new(&message(frame, child, 6)), 1e-2);
        assert!(of_ardupilot(1, 12).expect_err("refused").contains("only LOCAL_FRD"));
        // It turns the velocity by the attitude: forwards is east.
        let reading = of_ardupilot(20, 12).expect("taken");
        let (frame, velocity) = reading.velocity.expect("a velocity");
        assert_eq!(frame, VelocityFrame::North);
        assert!((velocity.value - Vector3::new(-5.0, 4.0, 6.0)).norm() < 1e-5);
        assert!(reading.points_north);
    }
}
