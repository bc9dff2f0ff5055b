//! An FMU in a process of its own.
//!
//! ```text
//!  Guarded (this program)                       host (a child process)
//!    request  ──────────── stdin ─────────────►   set inputs, fmi2DoStep, get outputs
//!    response ◄─────────── stdout ─────────────
//!    said     ◄─────────── stderr ─────────────   log messages, and what the FMU prints
//!    call     ◄──────── a file's byte ─────────   the call that is being made
//!    watchdog ───────────── kill ─────────────►
//! ```
//!
//! Whatever the FMU does to its process, this one is told how it ended, in which call, and what was said last.

mod frame;
mod guarded;
mod guest_error;
mod hosting;
mod lines;
mod protocol;
mod signal_names;
mod slip;
mod streams;
mod watchdog;

pub use guarded::{Guarded, Setup};
pub use guest_error::GuestError;
pub use hosting::host;
pub use lines::Said;
pub use protocol::StartValue;
