//! From what the vehicle is asked for to the set-points that the controllers track.

pub(crate) mod attitude_target;
pub(crate) mod consistent_way;
pub(crate) mod continuation;
pub(crate) mod derivative_estimator;
pub(crate) mod direct_reference;
pub(crate) mod eased_limits;
pub(crate) mod found_derivatives;
pub(crate) mod heading;
#[cfg(feature = "shaper")]
pub(crate) mod heading_shaper;
pub(crate) mod held_input;
#[cfg(test)]
pub(crate) mod known_motion;
pub(crate) mod lately_missed;
pub(crate) mod motion_filters;
pub(crate) mod motion_profile;
#[cfg(feature = "shaper")]
pub(crate) mod past_motion;
pub(crate) mod polynomial_fit;
pub(crate) mod position_reference;
pub(crate) mod reference_guidance;
pub(crate) mod reference_motion;
pub(crate) mod reference_plan;
#[cfg(feature = "shaper")]
pub(crate) mod shaper;
pub(crate) mod signal_noise;
#[cfg(feature = "shaper")]
pub(crate) mod smoothing;
#[cfg(feature = "shaper")]
pub(crate) mod state_to_state;
pub(crate) mod streamed_velocity;
#[cfg(feature = "shaper")]
pub(crate) mod way_plan;
