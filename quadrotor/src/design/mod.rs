//! What is computed before a flight: linear models, limits and gains of the controllers.

pub(crate) mod altitude_limits;
pub(crate) mod attitude_bandwidth;
pub(crate) mod attitude_design;
pub(crate) mod attitude_limits;
pub(crate) mod attitude_loop;
pub(crate) mod capacities;
pub(crate) mod cascade_design;
pub(crate) mod controller_limits;
pub(crate) mod default_bandwidths;
pub(crate) mod default_limits;
pub(crate) mod default_reach;
pub(crate) mod estimator_design;
pub(crate) mod flyable_limits;
pub mod limited_samples;
pub(crate) mod linear_loop;
pub(crate) mod linear_models;
pub(crate) mod loop_design;
pub(crate) mod loop_weights;
pub(crate) mod position_limits;
pub(crate) mod printed_design;
pub(crate) mod reduced_attitude;
pub(crate) mod rotor_loss_design;
pub(crate) mod side_force;
pub(crate) mod stability;
pub(crate) mod stabilized_law;
pub(crate) mod translation_design;
