//! Failsafes: causes that are watched, actions by parameter, the worst one first.
//!
//! ```text
//!  conditions ──► cause begins ──► action by parameter ──► worse than what is done? ──► mode, or stopped rotors
//!                      │                                         no: announced only
//!                      └──► announced, logged
//! ```
//!
//! A cause acts when it begins. After that the pilot decides: a mode that a user chooses is taken, and the failsafe acts again
//! when another cause begins or the same one comes back. Two causes leave no choice while they last: without an estimate of
//! its place, and without a rotor, the vehicle only lands. If one of them began on the ground, it acts as soon as the vehicle
//! takes off.

mod action;
mod cause;
mod settings;
mod state;

pub use action::Action;
pub use cause::Cause;
pub use settings::{
    BatteryActions, BatteryLimits, FailsafeSettings, FenceDatum, FenceOptions, FenceParts, FenceStart,
};
pub use state::{Change, Failsafe, Weakness};
