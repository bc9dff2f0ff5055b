//! The outputs.
//!
//! Outputs at a communication point do not depend on the inputs set there: these act from then on.

use std::f64::consts::PI;

use fmi::array;
use fmi::variables::{Array, Variable};
use quadrotor::Outputs;

use super::ClosedLoop;
use crate::quantities::{ANGLE, POSITION};
use crate::tables::rows::{output, within};
use crate::tables::{motion, steering};

const ATTITUDE: &[&str] = &["initial.attitude."];

/// The motion of the vehicle, its rotors and its battery.
pub(super) const MOTION: [Variable<ClosedLoop>; 34] = motion::motion();

/// What the controllers steer by.
pub(super) const STEERING: [Variable<ClosedLoop>; 12] = steering::set_points();

/// How far the vehicle is from there.
#[rustfmt::skip]
pub(super) const ERRORS: [Variable<ClosedLoop>; 4] = [
    output("tracking_error.x", &POSITION, &["armed", "reference.position.x", "reference.shaping", "initial.position.x"], |outputs: &Outputs| outputs.tracking_error_m.x, "Position minus set-point north"),
    output("tracking_error.y", &POSITION, &["armed", "reference.position.y", "reference.shaping", "initial.position.y"], |outputs: &Outputs| outputs.tracking_error_m.y, "Position minus set-point east"),
    output("tracking_error.z", &POSITION, &["armed", "reference.position.z", "reference.shaping", "initial.position.z"], |outputs: &Outputs| outputs.tracking_error_m.z, "Position minus set-point down"),
    within(output("yaw_error", &ANGLE, ATTITUDE, |outputs: &Outputs| outputs.yaw_error_rad, "Heading minus set-point, wrapped to [-pi, pi]"), -PI, PI),
];

/// How the controllers came to their last inputs.
pub(super) const ACTIVITY: [Variable<ClosedLoop>; 12] = steering::activity();

/// Arrays that only the closed loop has.
pub(super) const ARRAYS: &[Array] =
    &[array!("tracking_error", [".x", ".y", ".z"], "Position minus set-point: north, east, down")];
