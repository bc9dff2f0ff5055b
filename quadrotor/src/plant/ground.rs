//! Contact with a ground plane at z = 0.

use nalgebra::Vector3;

use crate::plant::rigid_body::{External, RigidBody};
use crate::{Airframe, GRAVITY_M_S2};

/// Natural frequency of the vehicle on its four feet, rad/s: it rests 4 mm deep, and the integration
/// step of 1 ms resolves the contact fifty times over.
const CONTACT_FREQUENCY_RAD_S: f64 = 50.0;
/// Critically damped: a landing does not bounce.
const CONTACT_DAMPING_RATIO: f64 = 1.0;
/// Rubber on concrete.
const FRICTION_COEFFICIENT: f64 = 0.7;
/// Slip speed at which friction is fully developed, m/s; it keeps the equations smooth.
const FRICTION_SLIP_M_S: f64 = 0.1;

/// Force and torque of the ground on four feet below the rotors, level with the centre of mass, so that
/// a vehicle at rest on the ground is at z = 0 but for the compliance.
pub(crate) fn contact(airframe: &Airframe, body: &RigidBody) -> External {
    if body.position_m.z < -airframe.arm_length_m * airframe.layout.reach() {
        return External::default();
    }
    let mass = airframe.mass_kg / 4.0;
    let stiffness = mass * CONTACT_FREQUENCY_RAD_S * CONTACT_FREQUENCY_RAD_S;
    let damping = 2.0 * CONTACT_DAMPING_RATIO * mass * CONTACT_FREQUENCY_RAD_S;
    // A fall from any height stays a number: no foot pushes with more than 200 g.
    let strongest = 200.0 * airframe.mass_kg * GRAVITY_M_S2;

    let rotation = body.rotation();
    let l = airframe.arm_length_m;
    let feet = airframe.layout.rotors.map(|rotor| Vector3::new(l * rotor.x, l * rotor.y, 0.0));
    let mut total = External::default();
    for foot in feet {
        let depth = body.position_m.z + (rotation * foot).z;
        if depth <= 0.0 {
            continue;
        }
        let velocity = body.velocity_m_s + rotation * body.body_rate_rad_s.cross(&foot);
        // The ground only pushes.
        let normal = (stiffness * depth + damping * velocity.z).clamp(0.0, strongest);
        let slip = libm::hypot(velocity.x, velocity.y);
        let friction = FRICTION_COEFFICIENT * normal / slip.max(FRICTION_SLIP_M_S);
        let force = Vector3::new(-friction * velocity.x, -friction * velocity.y, -normal);
        total.force_n += force;
        total.torque_n_m += foot.cross(&rotation.inverse_transform_vector(&force));
    }
    total
}
