//! The vehicle without its controllers: rotors, rigid body and ground, as f(x, u) and as an integrated step.

pub(crate) mod airframe;
pub(crate) mod battery_pack;
pub(crate) mod differentiation;
pub(crate) mod disturbance;
pub(crate) mod drag;
pub(crate) mod dynamics;
pub(crate) mod events;
pub(crate) mod forces;
pub(crate) mod ground;
pub(crate) mod inertia;
pub(crate) mod orientation;
pub(crate) mod overload;
pub(crate) mod plant_inputs;
pub(crate) mod plant_outputs;
pub(crate) mod plant_state;
pub(crate) mod presets;
pub(crate) mod rigid_body;
pub(crate) mod rotor_aerodynamics;
pub(crate) mod rotor_fault;
pub(crate) mod rotor_forces;
pub(crate) mod rotor_layout;
pub(crate) mod rotor_map;
pub(crate) mod rotor_spin;
