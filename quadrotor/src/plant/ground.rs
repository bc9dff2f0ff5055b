//! Contact with a ground plane at z = 0.

use nalgebra::{UnitQuaternion, Vector3};

use crate::plant::plant_state::PlantState;
use crate::plant::rigid_body::{External, RigidBody};
use crate::{Airframe, GRAVITY_M_S2, InitialState};

/// Natural frequency of the vehicle on its four feet, rad/s: it rests 4 mm deep, and the integration
/// step of 1 ms resolves the contact fifty times over.
const CONTACT_FREQUENCY_RAD_S: f64 = 50.0;
/// Critically damped: a landing does not bounce.
const CONTACT_DAMPING_RATIO: f64 = 1.0;
/// Rubber on concrete.
const FRICTION_COEFFICIENT: f64 = 0.7;
/// Slip speed at which friction is fully developed, m/s; it keeps the equations smooth.
const FRICTION_SLIP_M_S: f64 = 0.1;
/// Deepest that a foot may start, m. A level vehicle at rest settles from here without leaving the ground, whatever its
/// mass; from 3 cm on the contact would throw it up.
const DEEPEST_START_M: f64 = 0.01;

/// Force, NED, N, and torque, FRD, N·m, of the ground on the four feet. There is one in place of each rotor, level with the
/// centre of mass, so that a vehicle at rest on the ground is at z = 0 but for the compliance.
///
/// The friction is that of feet that slip: proportional to a slow slip, and zero at rest. [`is_held`] decides when static
/// friction holds the vehicle instead.
pub(crate) fn contact(airframe: &Airframe, body: &RigidBody) -> External {
    let mut total = External::default();
    if is_above(airframe, body) {
        return total;
    }
    let rotation = body.rotation();
    for foot in feet(airframe) {
        let Some((normal, velocity)) = footing(airframe, body, &rotation, &foot) else { continue };
        let slip = libm::hypot(velocity.x, velocity.y);
        let friction = FRICTION_COEFFICIENT * normal / slip.max(FRICTION_SLIP_M_S);
        let force = Vector3::new(-friction * velocity.x, -friction * velocity.y, -normal);
        total.force_n += force;
        total.torque_n_m += foot.cross(&rotation.inverse_transform_vector(&force));
    }
    total
}

/// Whether static friction holds the vehicle where it is: all feet carry load, it slips more slowly than sliding friction
/// needs to develop, and the feet together can take the `pull`, which is all force and torque but the ground's and gravity.
pub(crate) fn is_held(airframe: &Airframe, body: &RigidBody, pull: &External) -> bool {
    let reach_m = airframe.arm_length_m * airframe.layout.reach();
    let slip_m_s = body.velocity_m_s.xy().norm() + libm::fabs(body.body_rate_rad_s.z) * reach_m;
    if is_above(airframe, body) || slip_m_s >= FRICTION_SLIP_M_S {
        return false;
    }
    let rotation = body.rotation();
    let normals = feet(airframe)
        .map(|foot| footing(airframe, body, &rotation, &foot).map_or(0.0, |(normal, _)| normal));
    // A foot at the nearest rotor bears |f|/4 + |τ|/4r of at most μ N/4.
    let nearest_m = airframe.arm_length_m * airframe.layout.nearest();
    let demand_n = pull.force_n.xy().norm() + libm::fabs(pull.torque_n_m.z) / nearest_m;
    let load_n: f64 = normals.iter().sum();
    normals.iter().all(|normal| *normal > 0.0) && demand_n <= FRICTION_COEFFICIENT * load_n
}

/// The greatest z, NED, m, from which a flight can start above the ground with this initial attitude: there the lowest foot
/// touches the ground. In whole millimetres, so that what a message prints is allowed.
pub(crate) fn greatest_start_z_m(airframe: &Airframe, initial: &InitialState) -> f64 {
    let rotation = PlantState::at_rest(initial).body.rotation();
    let lowest_foot_m =
        feet(airframe).iter().map(|foot| (rotation * foot).z).fold(f64::NEG_INFINITY, f64::max);
    libm::floor(1e3 * (DEEPEST_START_M - lowest_foot_m)) / 1e3
}

/// Whether no foot can touch the ground in any attitude.
fn is_above(airframe: &Airframe, body: &RigidBody) -> bool {
    body.position_m.z < -airframe.arm_length_m * airframe.layout.reach()
}

/// Feet below the rotors, FRD, m.
fn feet(airframe: &Airframe) -> [Vector3<f64>; 4] {
    let l = airframe.arm_length_m;
    airframe.layout.rotors.map(|rotor| Vector3::new(l * rotor.x, l * rotor.y, 0.0))
}

/// Load of a foot, N, and its velocity, NED, m/s, if it touches the ground.
fn footing(
    airframe: &Airframe,
    body: &RigidBody,
    rotation: &UnitQuaternion<f64>,
    foot: &Vector3<f64>,
) -> Option<(f64, Vector3<f64>)> {
    let depth = body.position_m.z + (rotation * foot).z;
    if depth <= 0.0 {
        return None;
    }
    let mass = airframe.mass_kg / 4.0;
    let stiffness = mass * CONTACT_FREQUENCY_RAD_S * CONTACT_FREQUENCY_RAD_S;
    let damping = 2.0 * CONTACT_DAMPING_RATIO * mass * CONTACT_FREQUENCY_RAD_S;
    // A fall from any height stays a number: no foot pushes with more than 200 g.
    let strongest = 200.0 * airframe.mass_kg * GRAVITY_M_S2;
    let velocity = body.velocity_m_s + rotation * body.body_rate_rad_s.cross(foot);
    // The ground only pushes.
    Some(((stiffness * depth + damping * velocity.z).clamp(0.0, strongest), velocity))
}
