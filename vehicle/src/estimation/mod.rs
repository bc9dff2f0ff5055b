//! Instruments with the noise of real ones, and the estimator that flies by them.
//!
//! ```text
//!                 ┌─ inertial unit 1 kHz ─► accumulated to 200 Hz ─┐
//!  true motion ───┼─ GPS receiver  10 Hz, 0.1 s late ──────────────┼─► estimator ─► estimate, health
//!                 ├─ barometer     50 Hz ──────────────────────────┤   (error-state
//!                 └─ magnetometer  50 Hz ──────────────────────────┘    Kalman filter)
//! ```
//!
//! The filter is the crate `fusion-nav`; what it is told of the instruments stands in `tuning.rs`. The linear Kalman
//! predictor (26) of the closed loop stays behind it: it estimates what pushes the vehicle.
//!
//! Estimates from outside, of motion capture or visual odometry, come as messages and are fused like fixes (`vision/`), by the choice
//! of each autopilot's parameters (`aiding/`).
//!
//! A fault stands between an instrument and everybody who reads it (`defect.rs`). Ideal sensors (`ideal.rs`) have no
//! noise and need no estimator; faults can only silence them.
//!
//! Each instrument's figures stand in its file, beside the part and the data sheet that they are from; what no data sheet
//! has is marked as assumed.

pub mod aiding;
pub mod barometer;
mod defect;
mod estimate;
mod estimator;
pub mod gps;
mod ideal;
pub mod inertial;
mod jamming;
mod leap;
mod lockout;
pub mod magnetometer;
mod navigation;
mod noise;
mod outside_aid;
mod release;
mod sensor_errors;
mod settings;
mod true_motion;
mod tuning;
mod vibration;
pub mod vision;
mod wander;
mod watch;

pub use estimate::{Estimate, TestRatios, Validity};
pub use estimator::Estimator;
pub use ideal::IdealSensors;
pub use navigation::{InstrumentHealth, Navigation, Readings};
pub use sensor_errors::{FIX_3D, MagnetometerUse, SensorErrors, SensorSwitches, Triple};
pub use settings::{SensorModel, SensorSettings};
pub use true_motion::TrueMotion;
pub use vibration::Vibration;
