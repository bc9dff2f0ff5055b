//! PX4's ULog format, which Flight Review, PlotJuggler and pyulog read.

mod bytes;
mod row;
mod topics;
mod writer;

pub use bytes::entry_length;
pub use row::Row;
pub use topics::{TOPICS, Topic};
pub use writer::ULogWriter;
