//! From what the vehicle is asked for to the set-points that the controllers track.

pub(crate) mod attitude_target;
#[cfg(feature = "shaper")]
pub(crate) mod motion_profile;
pub(crate) mod position_reference;
pub(crate) mod ramp;
pub(crate) mod reference_guidance;
pub(crate) mod reference_motion;
pub(crate) mod setpoint;
#[cfg(feature = "shaper")]
pub(crate) mod shaper;
