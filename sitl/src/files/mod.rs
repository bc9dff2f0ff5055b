//! Files that clients can reach: folders of the disk that nothing leads out of.
//!
//! ```text
//!  autopilot::FileStore ◄── Disk: `logs`, `files` ──► cap-std: a folder and what is below it, nothing else
//! ```

mod disk;
mod log_folder;
mod mount;
mod replace;

pub use disk::Disk;
pub use log_folder::LogFolder;
pub use mount::Mount;
pub use replace::{Readers, replace};
