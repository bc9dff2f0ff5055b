//! FMI 2.0 for co-simulation, called.

mod functions;
mod instance;
mod logger;
mod types;

pub(crate) use functions::load_for_all;
pub(crate) use instance::Birth;
pub use instance::Instance;
pub use logger::Message;
pub use types::{Call, Status};
