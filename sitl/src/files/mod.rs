//! Files: folders that clients can reach and nothing leads out of, and files of our own that are written while vehicles fly.
//!
//! ```text
//!  autopilot::FileWorker ◄── FileThread: jobs of clients, away from the flights
//!                               └─► Disk: `logs`, `files` ──► cap-std: a folder and what is below it, nothing else
//!
//!  record, traffic log, flight log ──► Spool (bytes wait for a full disk) ─┐
//!  parameters, signing timestamps, key ──► replace (all or nothing) ───────┴─► Upkeep: announced once, told at the end
//!  FileLock: one process at a time
//! ```
//!
//! No file ends a flight: what cannot be written is announced, tried again each second, and named at the end with exit code 4.

mod disk;
mod kept_plans;
mod lock;
mod log_folder;
mod mount;
mod replace;
mod spool;
mod upkeep;
mod usage;
mod worker;

pub use disk::Disk;
pub use kept_plans::{kept_plans, plans_beside, render_plans};
pub use lock::FileLock;
pub use log_folder::LogFolder;
pub use mount::Mount;
pub use replace::{Readers, replace};
pub use spool::Spool;
#[cfg(test)]
pub(crate) use spool::tests::SmallDisk;
pub use upkeep::{Notice, Upkeep, WRITE_PERIOD, reason};
pub use worker::FileThread;
