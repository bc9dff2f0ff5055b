//! The vehicles of a run, the links that clients reach them by, and the clocks that they fly by.
//!
//! ```text
//!  clients ◄──► hub (links) ◄──► members ◄── clock ◄── wall clock
//!               one for all,     autopilot,  one for all,
//!               or each its own  digest      or each its own
//! ```
//!
//! Vehicles do not interact: the flight of each depends only on its own messages and their simulation times. One whose
//! simulation fails ends alone.

#[cfg(test)]
mod allocations;
mod books;
mod clock;
mod flight;
mod held;
mod kept_file;
mod lockstep;
mod loss;
mod member;
mod onlooker;
mod reception;
#[cfg(test)]
mod resting;
mod roster;
mod signing_keeper;
#[cfg(test)]
mod station;

pub use clock::Clock;
pub use lockstep::{LockstepPhase, LockstepSettings};
pub use loss::Loss;
pub use member::Member;
pub use onlooker::Overheard;
pub use roster::Fleet;
