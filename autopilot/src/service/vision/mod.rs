//! Estimates of the motion from outside: VISION_POSITION_ESTIMATE, ODOMETRY and their like.

mod estimates;
mod message;
mod odometry;
mod pose;

pub use estimates::Vision;
