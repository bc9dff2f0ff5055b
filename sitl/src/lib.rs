//! A quadrotor under Laguerre model predictive control that MAVLink clients fly.

#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

pub mod codec;
pub mod identity;
pub mod vehicle;
pub mod world;
