//! ArduPilot's DataFlash format, which MAVExplorer, mavlogdump and the other readers of .BIN files read.
//!
//! ```text
//!  field (one row: name, type, unit, multiplier, value) ──► message ──► table ─┬─► FMT, FMTU, UNIT, MULT
//!                                                                              └─► data, as LOG_BITMASK says
//!  happenings: MODE, ARM, EV, ERR, CMD, ORGN when they change                 └──► bytes
//! ```

mod bytes;
mod estimates;
mod field;
mod happenings;
mod motion;
mod power;
mod sensors;
mod table;
mod units;
mod writer;

pub use field::Field;
pub use table::{MESSAGES, Message};
pub use writer::DataFlashWriter;
