//! Files that clients can reach: what a service may ask for, and folders of the disk that nothing leads out of.
//!
//! ```text
//!  service ──► FileStore ◄── Disk: `logs`, `files` ──► cap-std: a folder and what is below it, nothing else
//! ```

mod disk;
mod log_folder;
mod mount;
mod replace;
mod store;

pub use disk::Disk;
pub use log_folder::LogFolder;
pub use mount::Mount;
pub use replace::{Readers, replace};
pub use store::{Access, FileError, FileStore, LOGS, Listed, Nothing, OpenFile};
