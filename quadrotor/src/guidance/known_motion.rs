//! Motions of which every derivative is known: what tests hold others against.

use core::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;

use crate::PositionReference;

/// The motion with a derivative of each order: position, velocity, acceleration, jerk and snap.
pub(crate) fn motion(derivative: impl Fn(i32) -> Vector3<f64>) -> PositionReference {
    PositionReference {
        velocity_m_s: derivative(1),
        acceleration_m_s2: derivative(2),
        jerk_m_s3: derivative(3),
        snap_m_s4: derivative(4),
        ..PositionReference::goal(derivative(0).into(), 0.0)
    }
}

/// A level circle about the origin, which begins in the north.
pub(crate) fn circle(radius_m: f64, rate_rad_s: f64, time_s: f64) -> PositionReference {
    motion(|order| {
        let angle = rate_rad_s * time_s + f64::from(order) * FRAC_PI_2;
        Vector3::new(libm::cos(angle), libm::sin(angle), 0.0)
            * (radius_m * libm::pow(rate_rad_s, f64::from(order)))
    })
}
