//! The live page: what browsers are shown of the fleet, and what their pilots ask of it.
//!
//! ```text
//!  fleet ──► sample, scene, news ──► viewer::Viewer
//!        ◄──       request        ◄──
//! ```
//!
//! Only the wall clock decides when something is shown, and nothing of it reaches a flight but requests, which are recorded as
//! messages of a ground station.

mod film;
mod ground;
mod news;
mod open;
mod page;
mod recorded;
mod request;
mod sample;
mod scene;
mod table;

pub use open::open_viewer;
pub use page::LivePage;
pub use recorded::{show_recording, write_page};
