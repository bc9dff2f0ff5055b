//! What the program is told: defaults, then the file, then the environment, then the flags.

mod addressed;
mod arguments;
mod conventions;
pub mod file;
mod formation;
mod hil;
mod home;
pub mod mistake;
mod noise;
mod plan_file;
mod ranged;
mod replay;
mod settings;
mod sharing;
mod start_parameters;
mod wind;
mod wind_drag;

pub use addressed::Addressed;
pub use arguments::Arguments;
pub use conventions::Conventions;
pub use formation::{Formation, Shape};
pub use home::HomePosition;
pub use noise::MeasurementNoise;
pub use plan_file::read_plans;
pub use replay::check_replay;
pub use settings::{MemberSettings, Settings};
pub use sharing::{Clocks, Ports};
pub use wind::WindFrom;
