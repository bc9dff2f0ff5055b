//! Every test of the engine as one program: linked once, its tests run side by side.

mod common;

mod attitude_steps;
mod attitude_target;
mod control_loop;
mod controllers;
mod determinism;
mod disturbances;
mod estimate;
mod extended_flights;
mod extended_physics;
mod fleet;
mod flight_bits;
mod flights;
mod full_thrust;
mod ground;
mod hand_over;
mod layouts;
mod learning;
mod loads;
mod lowered_limits;
mod parameters;
mod physics;
mod plant_bits;
mod plant_derivatives;
mod plant_events;
mod plant_simulation;
mod presets;
mod raw_goals;
mod recovery;
mod redesign;
mod references;
mod rotor_loss;
mod stability;
mod steps_of_acceleration;
mod two_rotors_lost;
