//! SET_POSITION_TARGET_LOCAL_NED and SET_POSITION_TARGET_GLOBAL_INT.

use nalgebra::Vector3;

use super::{Frame, degrees, id};

/// Position of a target, in the terms of its message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TargetPosition {
    /// x, y, z of a local frame, m.
    Local(Vector3<f64>),
    /// Latitude and longitude, degrees, and an altitude, m, whose zero the frame tells.
    Global {
        /// Degrees north.
        latitude_deg: f64,
        /// Degrees east.
        longitude_deg: f64,
        /// Altitude, m.
        altitude_m: f64,
    },
}

/// A set-point as it was sent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetPositionTarget {
    /// MAV_FRAME; any number.
    pub frame: u8,
    /// POSITION_TARGET_TYPEMASK: a set bit ignores its value.
    pub type_mask: u16,
    /// Position.
    pub position: TargetPosition,
    /// Velocity, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Acceleration, m/s², or force if the mask says so.
    pub acceleration_m_s2: Vector3<f64>,
    /// Heading, rad.
    pub yaw_rad: f64,
    /// Rate of the heading, rad/s.
    pub yaw_rate_rad_s: f64,
}

impl SetPositionTarget {
    /// Reads either message.
    pub fn read(frame: &Frame) -> Option<Self> {
        let payload = frame.payload();
        let position = match frame.message_id() {
            id::SET_POSITION_TARGET_LOCAL_NED => TargetPosition::Local(payload.reals(4).into()),
            id::SET_POSITION_TARGET_GLOBAL_INT => TargetPosition::Global {
                latitude_deg: degrees(payload.i32(4)),
                longitude_deg: degrees(payload.i32(8)),
                altitude_m: f64::from(payload.f32(12)),
            },
            _ => return None,
        };
        Some(Self {
            frame: payload.u8(52),
            type_mask: payload.u16(48),
            position,
            velocity_m_s: payload.reals(16).into(),
            acceleration_m_s2: payload.reals(28).into(),
            yaw_rad: f64::from(payload.f32(40)),
            yaw_rate_rad_s: f64::from(payload.f32(44)),
        })
    }
}
