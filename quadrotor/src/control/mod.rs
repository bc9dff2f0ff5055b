//! The control loop at run time: laws, their controllers, and what they know of the vehicle.

pub(crate) mod activity;
pub(crate) mod altitude_controller;
pub(crate) mod attitude_controller;
pub(crate) mod attitude_reference;
pub(crate) mod cascade;
pub(crate) mod command_limits;
pub(crate) mod control_error;
pub(crate) mod control_inputs;
pub(crate) mod control_loop;
pub(crate) mod control_state;
pub(crate) mod estimator;
pub(crate) mod flat_attitude;
pub(crate) mod governor;
pub(crate) mod instants;
mod largest_share;
mod learning;
pub(crate) mod mass_belief;
pub(crate) mod measurement;
pub(crate) mod mixer;
pub(crate) mod observation;
pub(crate) mod position_controller;
pub(crate) mod rotor_loss;
pub(crate) mod rotor_monitor;
pub(crate) mod spin;
pub(crate) mod thrust_lag;
pub(crate) mod tracking_law;
pub(crate) mod vehicle_motion;
