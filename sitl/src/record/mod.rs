//! Records of flights: what came in, when in simulation time, and what flight it made.

mod digest;
mod record_file;
mod replay;
mod traffic_log;

pub use digest::Digest;
pub use record_file::{Entry, Header, Participant, Recorder, read};
pub use replay::replay;
pub use traffic_log::TrafficLog;
