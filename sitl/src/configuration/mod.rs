//! Settings of a run: flags, then the environment, then the file, then defaults.

mod addressed;
mod arguments;
mod conventions;
pub mod environment;
pub mod file;
mod formation;
pub mod help;
mod hil;
mod home;
mod log_filter;
pub mod mistake;
mod noise;
mod parameter_list;
mod plan_file;
mod ranged;
mod settings;
mod sharing;
mod start_parameters;
mod suggestion;
mod text_file;
mod wind;
mod wind_drag;
mod wind_hold;

pub use addressed::Addressed;
pub use arguments::Arguments;
pub use conventions::Conventions;
pub use formation::{Formation, Shape};
pub use home::HomePosition;
pub use log_filter::LogFilter;
pub use noise::MeasurementNoise;
pub use parameter_list::{ListFormat, parameter_list};
pub use plan_file::read_plans;
pub use settings::{MemberSettings, Settings};
pub use sharing::{Clocks, Ports};
pub use wind::WindFrom;
