//! Parameters by MAVLink identifiers: those of the closed loop and the vehicle's own.

mod ardupilot_parameters;
mod conduct_parameters;
mod description;
mod entry;
mod file;
mod identifier;
mod loop_access;
mod speed;
mod table;
mod value;

pub use ardupilot_parameters::ARDUPILOT_PARAMETERS;
pub use conduct_parameters::{CONDUCT_PARAMETERS, ConductParameter};
pub use description::Description;
pub use entry::Entry;
pub use file::{ParameterFileError, parse, render};
pub use identifier::identifier;
pub use speed::Speed;
pub use table::{Host, ParameterTable, SPEED_PARAMETER, SetError, View};
pub use value::{Encoding, Value};
