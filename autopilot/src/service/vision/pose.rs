//! Messages with a position and an attitude, or a velocity, along fixed axes.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use vehicle::estimation::vision::{Measured, VelocityFrame, VisionReading};

use crate::codec::Payload;

/// Places of the variances in the upper right triangle of a matrix of six rows: x, y, z, and the heading.
const DIAGONAL: [usize; 3] = [0, 6, 11];
const HEADING: usize = 20;
/// Errors of velocities that ArduPilot's estimator takes a confidence of 0 and of 100 % for, m/s: EK3_VIS_VERR_MAX and _MIN.
const UNCERTAIN_M_S: f64 = 0.9;
const CERTAIN_M_S: f64 = 0.1;

/// A vector if all of its axes are finite.
pub fn vector(axes: [f64; 3]) -> Option<Vector3<f64>> {
    axes.iter().all(|axis| axis.is_finite()).then(|| Vector3::from(axes))
}

/// An attitude, if the quaternion's length differs from 1 by no more than `tolerance`.
pub fn attitude([w, x, y, z]: [f64; 4], tolerance: f64) -> Option<UnitQuaternion<f64>> {
    let quaternion = Quaternion::new(w, x, y, z);
    let is_unit = (quaternion.norm() - 1.0).abs() <= tolerance;
    is_unit.then(|| UnitQuaternion::new_normalize(quaternion))
}

/// Variances of three axes and of the heading, of a matrix of six rows.
pub fn variances(triangle: &[f64; 21]) -> (Vector3<f64>, f64) {
    let [x, y, z] = DIAGONAL.map(|at| triangle.get(at).copied().unwrap_or(f64::NAN));
    (Vector3::new(x, y, z), triangle.get(HEADING).copied().unwrap_or(f64::NAN))
}

/// VISION_POSITION_ESTIMATE and its like: position and Euler angles.
pub fn pose(payload: &Payload<'_>, has_resets: bool) -> VisionReading {
    let [x, y, z, roll, pitch, yaw]: [f64; 6] = payload.reals(8);
    let (variance, heading_variance) = variances(&payload.reals(32));
    let turned = vector([roll, pitch, yaw]);
    VisionReading {
        position: vector([x, y, z]).map(|value| Measured { value, variance }),
        attitude: turned.map(|angles| {
            (UnitQuaternion::from_euler_angles(angles.x, angles.y, angles.z), heading_variance)
        }),
        resets: if has_resets { payload.u8(116) } else { 0 },
        ..VisionReading::NOTHING
    }
}

/// ATT_POS_MOCAP: a quaternion and a position.
pub fn mocap(payload: &Payload<'_>, tolerance: f64) -> VisionReading {
    let (variance, heading_variance) = variances(&payload.reals(36));
    VisionReading {
        position: vector(payload.reals(24)).map(|value| Measured { value, variance }),
        attitude: attitude(payload.reals(8), tolerance).map(|attitude| (attitude, heading_variance)),
        ..VisionReading::NOTHING
    }
}

/// VISION_SPEED_ESTIMATE: a velocity, NED, with a matrix of three whole rows.
pub fn speed(payload: &Payload<'_>) -> VisionReading {
    let [xx, _, _, _, yy, _, _, _, zz]: [f64; 9] = payload.reals(20);
    let variance = Vector3::new(xx, yy, zz);
    let velocity = vector(payload.reals(8)).map(|value| Measured { value, variance });
    VisionReading {
        velocity: velocity.map(|velocity| (VelocityFrame::North, velocity)),
        resets: payload.u8(56),
        ..VisionReading::NOTHING
    }
}

/// VISION_POSITION_DELTA: a way in the vehicle's frame, and the time for it.
pub fn delta(payload: &Payload<'_>) -> VisionReading {
    let duration_s = payload.u64(8) as f64 / 1e6;
    let share = (f64::from(payload.f32(40)) / 100.0).clamp(0.0, 1.0);
    let deviation_m_s = UNCERTAIN_M_S + share * (CERTAIN_M_S - UNCERTAIN_M_S);
    let variance = Vector3::repeat(deviation_m_s * deviation_m_s);
    let way_m = vector(payload.reals(28)).filter(|_| duration_s > 0.0);
    let velocity = way_m.map(|way_m| Measured { value: way_m / duration_s, variance });
    VisionReading {
        velocity: velocity.map(|velocity| (VelocityFrame::Body, velocity)),
        ..VisionReading::NOTHING
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{attitude, delta, pose, speed, variances};
    use crate::codec::Payload;

    fn reals(numbers: &[f32]) -> Vec<u8> {
        numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
    }

    #[test]
    fn fields_are_where_the_messages_have_them() {
        let mut bytes = vec![0; 8];
        bytes.extend(reals(&[1.0, 2.0, 3.0, 0.0, 0.0, 0.5]));
        let mut triangle = [0.0; 21];
        (triangle[0], triangle[6], triangle[11], triangle[20]) = (0.1, 0.2, 0.3, 0.4);
        bytes.extend(reals(&triangle));
        bytes.push(7);
        let reading = pose(&Payload::new(&bytes), true);
        let position = reading.position.expect("a position");
        assert_eq!(position.value, Vector3::new(1.0, 2.0, 3.0));
        assert!((position.variance - Vector3::new(0.1, 0.2, 0.3)).norm() < 1e-6);
        let (attitude, variance) = reading.attitude.expect("an attitude");
        assert!((attitude.euler_angles().2 - 0.5).abs() < 1e-6 && (variance - 0.4).abs() < 1e-6);
        assert_eq!(reading.resets, 7);
        // 0.1 m in 50 ms, with the best confidence.
        let mut bytes = vec![0; 8];
        bytes.extend(50_000_u64.to_le_bytes());
        bytes.extend(reals(&[0.0, 0.0, 0.0, 0.1, 0.0, -0.05, 100.0]));
        let (_, velocity) = delta(&Payload::new(&bytes)).velocity.expect("a velocity");
        assert!((velocity.value - Vector3::new(2.0, 0.0, -1.0)).norm() < 1e-6);
        assert!((velocity.variance.x - 0.01).abs() < 1e-9);
    }

    #[test]
    fn what_is_no_number_is_left_out() {
        let mut bytes = vec![0; 8];
        bytes.extend(reals(&[1.0, f32::NAN, 3.0, 0.0, f32::INFINITY, 0.5]));
        let reading = pose(&Payload::new(&bytes), true);
        assert!(reading.position.is_none() && reading.attitude.is_none());
        assert!(speed(&Payload::new(&bytes)).velocity.is_none());
        assert!(delta(&Payload::new(&[])).velocity.is_none(), "no time has passed");
        for bad in [[0.0; 4], [0.9, 0.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0, 0.0], [1e200; 4]] {
            assert!(attitude(bad, 1e-2).is_none(), "{bad:?}");
        }
        assert!(attitude([1.0, 0.0, 0.0, 0.0], 1e-5).is_some());
        assert_eq!(variances(&[2.0; 21]), (Vector3::repeat(2.0), 2.0));
    }
}
