//! What aids the estimator beside the inertial unit: which receivers and cameras are listened to, by each autopilot's parameters.

mod choice;
mod px4;
mod source_sets;

pub use choice::{Aiding, AidingSettings, GpsUse};
pub use px4::{HeightReference, Px4Aiding};
pub use source_sets::{SourceSet, SourceSets};
