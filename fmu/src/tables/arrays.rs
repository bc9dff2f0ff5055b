//! The arrays of FMI 3.0: vectors whose components are neighbours in the table of variables.

use fmi::array;
use fmi::variables::Array;

/// What is asked for.
#[rustfmt::skip]
pub(crate) const REFERENCE: &[Array] = &[
    array!("reference.position", [".x", ".y", ".z"], "Position reference: north, east, down"),
    array!("reference.velocity", [".x", ".y", ".z"], "Velocity reference: north, east, down"),
    array!("reference.acceleration", [".x", ".y", ".z"], "Acceleration reference, fed forward without shaping: north, east, down"),
];

/// What pushes the vehicle.
#[rustfmt::skip]
pub(crate) const DISTURBANCE: &[Array] = &[
    array!("disturbance.force", [".x", ".y", ".z"], "Force on the centre of mass: north, east, down"),
    array!("disturbance.torque", [".x", ".y", ".z"], "Torque about the forward, right and down axes of the body"),
    array!("wind.velocity", [".x", ".y", ".z"], "Wind velocity: north, east, down; acts through airframe.drag, airframe.body_drag and the rotors' coefficients"),
];

/// The motion of the vehicle.
#[rustfmt::skip]
pub(crate) const MOTION: &[Array] = &[
    array!("position", [".x", ".y", ".z"], "Position: north, east, down"),
    array!("velocity", [".x", ".y", ".z"], "Velocity: north, east, down"),
    array!("acceleration", [".x", ".y", ".z"], "Acceleration: north, east, down"),
    array!("body_velocity", [".u", ".v", ".w"], "Velocity: forward, right, down of the body"),
    array!("attitude", [".phi", ".theta", ".psi"], "ZYX Euler angles: roll, pitch, heading; pitch within [-pi/2, pi/2]"),
    array!("attitude.q" as "quaternion", ["0", "1", "2", "3"], "Attitude quaternion, scalar part first: body into north-east-down"),
    array!("body_rate", [".p", ".q", ".r"], "Body rates: roll, pitch, yaw"),
    array!("torque", [".phi", ".theta", ".psi"], "Torque of the four rotors about the forward, right and down axes"),
    array!("rotor.speed", ["[1]", "[2]", "[3]", "[4]"], "Speeds of the front, right, back and left rotor"),
];

/// What the controllers steer by.
#[rustfmt::skip]
pub(crate) const STEERING: &[Array] = &[
    array!("tilt_reference", [".phi", ".theta"], "Roll and pitch angle commanded by the position controller"),
    array!("setpoint.position", [".x", ".y", ".z"], "Position set-point, after shaping: north, east, down"),
    array!("setpoint.velocity", [".x", ".y", ".z"], "Velocity set-point, after shaping: north, east, down"),
    array!("setpoint.acceleration", [".x", ".y", ".z"], "Acceleration set-point, after shaping: north, east, down"),
    array!("controller.believed_drag", [".x", ".y", ".z"], "Drag coefficients north, east and down that the controllers go by"),
];

/// The airframe as controllers know it.
#[rustfmt::skip]
pub(crate) const AIRFRAME: &[Array] = &[
    array!("airframe.inertia", [".x", ".y", ".z"], "Moments of inertia J_x, J_y, J_z about the forward, right and down axes (Table 1)"),
    array!("airframe.drag", [".x", ".y", ".z"], "Linear drag along north, east, down"),
];

/// The rest of the airframe.
#[rustfmt::skip]
pub(crate) const AIRFRAME_OF_PLANT: &[Array] = &[
    array!("airframe.inertia" as "airframe.products_of_inertia", [".xy", ".xz", ".yz"], "Entries J_xy, J_xz, J_yz of the inertia tensor, minus the integrals of x y, x z and y z dm; the controllers ignore them"),
    array!("airframe.centre_of_gravity", [".x", ".y", ".z"], "Centre of mass forward, right and down of the rotors' centre; the controllers ignore it"),
    array!("airframe.body_drag", [".x", ".y", ".z"], "Linear drag along the forward, right and down axes of the body, in addition to airframe.drag"),
];

/// Where a flight begins.
#[rustfmt::skip]
pub(crate) const INITIAL: &[Array] = &[
    array!("initial.position", [".x", ".y", ".z"], "Initial position: north, east, down"),
    array!("initial.velocity", [".x", ".y", ".z"], "Initial velocity: north, east, down"),
    array!("initial.attitude", [".phi", ".theta", ".psi"], "Initial ZYX Euler angles: roll, pitch, heading"),
    array!("initial.body_rate", [".p", ".q", ".r"], "Initial body rates: roll, pitch, yaw"),
];

/// Weights of the controllers.
#[rustfmt::skip]
pub(crate) const CONTROLLERS: &[Array] = &[
    array!("controller.position.output_weight", [".x", ".y"], "Q: weights of the error north, east, relative to the bandwidth as in altitude"),
    array!("controller.position.damping_weight", [".x", ".y"], "Q: weights of the speed north, east over the bandwidth"),
    array!("controller.position.rate_weight", [".x", ".y"], "Q: weights of the acceleration north, east over the square of the bandwidth"),
    array!("controller.position.increment_weight", [".theta", ".phi"], "R: weights of the rate of change of the acceleration commanded north (by pitch), east (by roll), over the cube of the bandwidth"),
    array!("controller.attitude.output_weight", [".phi", ".theta", ".psi"], "Q: weights of the roll, pitch and heading error, relative to the bandwidth as in altitude"),
    array!("controller.attitude.damping_weight", [".phi", ".theta", ".psi"], "Q: weights of the roll, pitch and yaw rate over the bandwidth"),
    array!("controller.attitude.rate_weight", [".phi", ".theta", ".psi"], "Q: weights of the roll, pitch and yaw acceleration over the square of the bandwidth"),
    array!("controller.attitude.increment_weight", [".phi", ".theta", ".psi"], "R: weights of the rate of change of the commanded roll, pitch and yaw acceleration over the cube of the bandwidth"),
];
