//! FMUs of others that fly: as the closed loop, or as the plant.
//!
//! ```text
//!  --map map.toml ─► map ─┐
//!                         ├─► mapping: signals ◄─► variables, with units, frames and start values
//!  FILE.fmu ─► description┘        │
//!                                  ▼
//!  vehicle ── demand ─► flown FMU ── values ─► importer::Guarded (a process of its own)
//!          ◄─ motion ──           ◄──────────
//! ```

mod axes;
mod choice;
#[cfg(test)]
mod documented;
mod flown;
mod listing;
mod map;
mod mapping;
mod resolve;
mod signals;

pub use axes::Axes;
pub use choice::{FmuChoice, HOST_ARGUMENT};
pub use flown::FlownFmu;
pub use listing::listing;
pub use map::Map;
pub use mapping::Mapping;
/// The groups of the wind and of the ground among the inputs.
pub use signals::input::{GROUND, WIND};
