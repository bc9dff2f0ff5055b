//! Every test of the public interface as one program: linked once, its tests run side by side.

mod common;

mod conditioning;
mod constrained;
mod controller;
mod controller_state;
mod controllers;
mod design;
mod design_search;
mod eigenvalues;
mod equations;
mod kalman;
mod laguerre;
mod models;
mod posed_program;
mod published;
mod quadratic_program;
mod quadratic_program_scale;
mod reachability;
mod riccati;
mod several_inputs;
mod stabilized_design;
mod stabilized_mpc;
mod state_space_mpc;
