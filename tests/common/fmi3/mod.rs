//! The libraries through their FMI 3.0 interface, and their descriptions of that version.

pub mod description;
pub mod instance;
pub mod library;
pub mod log;
pub mod subject;
