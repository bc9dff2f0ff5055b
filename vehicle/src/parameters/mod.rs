//! Parameters by MAVLink names: those of the closed loop and the vehicle's own.
//!
//! A [`ParameterTable`] reads and writes [`ParameterValues`], which are plain data. Whether a running vehicle takes changed
//! values is its own matter: [`Vehicle::adopt`](crate::Vehicle::adopt).

mod ardupilot_parameters;
mod conduct_parameter;
mod conduct_parameters;
mod description;
mod entry;
mod equipment_parameters;
mod file;
mod limit_names;
mod loop_access;
mod loop_names;
mod mode_parameters;
mod named_value;
mod px4_parameters;
mod radio_parameters;
mod set_error;
mod simulation_parameters;
mod source_parameters;
mod speed;
mod speed_parameters;
mod statistics;
mod stream_rate_parameters;
mod suggestion;
mod surroundings_parameters;
mod table;
mod value;
mod value_text;
mod values;

pub use ardupilot_parameters::ARDUPILOT_PARAMETERS;
pub use conduct_parameter::ConductParameter;
pub use conduct_parameters::CONDUCT_PARAMETERS;
pub use description::Description;
pub use entry::Entry;
pub use equipment_parameters::equipment_parameters;
pub use file::{FileFormat, ParameterFileError, parse, render};
pub use loop_names::{LOOP_NAMES, LoopName, loop_name};
pub use mode_parameters::{ARDUPILOT_MODE_PARAMETERS, PX4_MODE_PARAMETERS};
pub use named_value::NamedValue;
pub use px4_parameters::PX4_PARAMETERS;
pub use radio_parameters::radio_parameters;
pub use set_error::SetError;
pub use simulation_parameters::{SIMULATION_PARAMETERS, WIND_PARAMETERS};
pub use source_parameters::SOURCE_PARAMETERS;
pub use speed::Speed;
pub use speed_parameters::{SPEED_PARAMETERS, SpeedParameter};
pub use statistics::{Statistic, Statistics};
pub use surroundings_parameters::{ARDUPILOT_SURROUNDINGS, PX4_SURROUNDINGS};
pub use table::{Change, ParameterTable, SPEED_PARAMETER};
pub use value::Value;
pub use values::ParameterValues;
