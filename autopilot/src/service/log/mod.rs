//! Logs of flights: a list of them, downloads, and erasing. Jobs read the disk; messages go as links have room.

mod catalog;
mod download;
mod job;
mod server;

pub use server::LogServer;
