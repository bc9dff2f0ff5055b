//! MAVLink FTP: files that are made when they are read, and those of a store.
//!
//! ```text
//!  FileServer ──► PackUploads: packed plans and parameters, which change the flight, at once
//!      │
//!      ├─ job ──► Desk, away from the flight: open files, listings, what was answered lately ──► FileStore
//!      │
//!      └◄─ replies ── Pending: sent in the order of the requests, as fast as links take them
//! ```

mod answered;
mod content;
mod desk;
mod job;
mod listing;
mod message;
mod pack_upload;
mod parameter_pack;
mod pending;
mod plan_pack;
mod plan_text;
mod root;
mod server;
mod sessions;

pub use server::FileServer;
