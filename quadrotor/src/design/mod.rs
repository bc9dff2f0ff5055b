//! What is computed before a flight: linear models, limits and gains of the controllers.

pub(crate) mod capacities;
pub(crate) mod cascade_design;
pub(crate) mod controller_limits;
pub(crate) mod default_bandwidths;
pub(crate) mod default_limits;
pub(crate) mod default_reach;
pub(crate) mod estimator_design;
pub(crate) mod flyable_limits;
pub mod limited_samples;
pub(crate) mod linear_models;
pub(crate) mod loop_design;
pub(crate) mod reduced_attitude;
pub(crate) mod rotor_loss_design;
pub(crate) mod side_force;
pub(crate) mod stability;
