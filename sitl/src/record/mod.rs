//! Records of flights: what came in, when in simulation time, and what flights it made.
//!
//! A record is lines of text. Each ends with a checksum of all bytes before it, so that damage anywhere is noticed.
//!
//! ```text
//! {"format":"lmpc-sitl record 3", …} CRC    the vehicles and their settings
//! frame TIME_US VEHICLE LINK PEER HEX CRC   a frame that a vehicle received
//! station TIME_US VEHICLE 0|1 CRC           a ground station is heard no more, or (again)
//! motion TIME_US VEHICLE VALUE… CRC         how an FMU moved a vehicle in the tick that follows: bits of doubles
//! state TIME_US VEHICLE DIGEST CRC          once per second of the wall clock: the digest of the flight so far
//! end TIME_US VEHICLE DIGEST CRC            the end of the flight
//! limit TIME_US VEHICLE DIGEST CRC          instead of the end: the record has reached its size limit
//! failure TIME_US VEHICLE DIGEST CRC        instead of the end: the simulation of the vehicle failed in the next tick
//! ```
//!
//! Vehicles are numbered from zero in the order of the header; times are those of each one's own clock. CRC is the CRC-32 (zlib's) of
//! all bytes of the file before it, as eight hexadecimal digits. What a program that was killed has written, at most a second less
//! than it has flown, replays up to its last whole line.

mod checksum;
mod digest;
mod entry;
mod header;
mod reader;
mod recorded_model;
mod recorder;
mod replay;
mod traffic_log;

pub use digest::Digest;
pub use entry::{Entry, Event};
pub use header::{Header, Participant};
pub use reader::Reader;
pub use recorder::Recorder;
pub use replay::{Audience, RecordEnd, Replayed, replay, replay_before};
pub use traffic_log::TrafficLog;
