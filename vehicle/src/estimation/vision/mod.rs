//! Estimates of the motion from outside: motion capture, visual odometry.

mod fusion;
mod motion_history;
mod reading;
mod refusal;
mod settings;

pub use fusion::{VisionFusion, VisionTerms};
pub use motion_history::Moment;
pub use reading::{Measured, VelocityFrame, VisionReading};
pub use refusal::VisionRefusal;
pub use settings::{VisionSettings, VisionUse};
