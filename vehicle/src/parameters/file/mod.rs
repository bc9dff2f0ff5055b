//! Parameter files.

mod error;
mod format;
mod line;
mod read;
mod write;

pub use error::ParameterFileError;
pub use format::FileFormat;
pub use read::parse;
pub use write::render;
