//! MAVLink FTP: files that are made when they are read, and those of a store.

mod message;
mod parameter_pack;
mod plan_pack;
mod plan_text;
mod root;
mod server;
mod sessions;

pub use server::FileServer;
