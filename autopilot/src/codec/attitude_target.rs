//! SET_ATTITUDE_TARGET.

use nalgebra::Vector3;

use super::{Frame, id};

/// A set-point as it was sent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetAttitudeTarget {
    /// ATTITUDE_TARGET_TYPEMASK: a set bit ignores its value.
    pub type_mask: u8,
    /// Quaternion, scalar first, FRD into NED.
    pub quaternion: [f64; 4],
    /// Body rates, FRD, rad/s.
    pub body_rate_rad_s: Vector3<f64>,
    /// Share of the largest thrust, 0 to 1.
    pub thrust: f64,
}

impl SetAttitudeTarget {
    /// Reads the message.
    pub fn read(frame: &Frame) -> Option<Self> {
        let payload = frame.payload();
        (frame.message_id() == id::SET_ATTITUDE_TARGET).then(|| Self {
            type_mask: payload.u8(38),
            quaternion: payload.reals(4),
            body_rate_rad_s: payload.reals(20).into(),
            thrust: f64::from(payload.f32(32)),
        })
    }
}
