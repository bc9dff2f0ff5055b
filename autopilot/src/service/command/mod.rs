//! The command protocol: COMMAND_LONG and COMMAND_INT. Services say which commands they take.

mod acknowledgement;
mod protocol;
mod retry;
mod told_place;

pub use acknowledgement::{acknowledge, acknowledge_outcome, as_told_by};
pub use protocol::{CommandProtocol, explain};
pub use told_place::{global_frame, told_frame, told_place};
