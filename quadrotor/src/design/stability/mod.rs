//! The closed loop as it flies, for small signals: sampled controllers at two rates, rotor lag, estimator.

pub(crate) mod cause;
pub(crate) mod linear_law;
pub(crate) mod loop_events;
pub(crate) mod loop_stability;
pub(crate) mod motion;
pub(crate) mod moving_axis;
pub(crate) mod noise_effect;
pub(crate) mod small_signal;
pub(crate) mod stability_report;
pub(crate) mod stability_warning;
#[cfg(test)]
mod tests;
pub(crate) mod tilting_loop;
pub(crate) mod turning_axis;
pub(crate) mod turning_loop;
pub(crate) mod verdict;
pub(crate) mod vertical_loop;
