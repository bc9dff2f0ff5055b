//! Mass and drag of the vehicle, learned in flight.

pub(crate) mod averaging;
pub(crate) mod bounded_estimate;
pub(crate) mod coherence;
pub(crate) mod excitation;
pub(crate) mod flight_sample;
pub(crate) mod gust_memory;
pub(crate) mod mass_and_drag;
pub(crate) mod motion_equation;
mod prior_knowledge;
pub(crate) mod steady_thrust;
pub(crate) mod thrust_fit;
