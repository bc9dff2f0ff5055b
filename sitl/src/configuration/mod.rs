//! What the program is told: defaults, then the file, then the environment, then the flags.

mod arguments;
mod home;
mod settings;
mod wind;

pub use arguments::Arguments;
pub use home::HomePosition;
pub use settings::{MemberSettings, Settings};
pub use wind::WindFrom;
