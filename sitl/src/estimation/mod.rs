//! Instruments with the noise of real ones, and the estimator that flies by them.
//!
//! ```text
//!                 ┌─ inertial unit 1 kHz ─► accumulated to 200 Hz ─┐
//!  true motion ───┼─ GPS receiver  10 Hz, 0.1 s late ──────────────┼─► estimator ─► estimate, health
//!                 ├─ barometer     50 Hz ──────────────────────────┤   (error-state
//!                 └─ magnetometer  50 Hz ──────────────────────────┘    Kalman filter)
//! ```
//!
//! Each instrument's figures stand in its file, beside the part and the table of the data sheet that they are from.

pub mod barometer;
pub mod gps;
pub mod inertial;
pub mod magnetometer;
mod noise;
mod true_motion;
mod vibration;
mod wander;

pub use true_motion::TrueMotion;
pub use vibration::Vibration;
