//! An importer of FMI 2.0 co-simulation FMUs.
//!
//! ```text
//!  FILE.fmu ─► archive ─► description ─► variables, units         in this process
//!                │
//!                └─► library ─► Instance                           in this one, or
//!                        ▲
//!                        └── isolation: host ◄──pipes──► Guarded   in a process of its own
//! ```
//!
//! Archives and descriptions may come from anywhere: they are bounded and checked. The code of an FMU cannot be checked; where
//! it must not take this program along, it runs in another process, with a deadline for each call.

#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod archive;
pub mod description;
mod error;
mod fmi2;
mod fmu;
mod isolation;
mod platform;

pub use error::{CallError, ImportError};
pub use fmi2::{Call, Instance, Message, Status};
pub use fmu::Fmu;
pub use isolation::{Guarded, GuestError, Said, Setup, StartValue, host};
