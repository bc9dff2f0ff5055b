//! A page that shows flying vehicles in a browser, and takes what their pilot asks for.
//!
//! ```text
//!             frames, scene, news               HTTP, WebSocket
//!  simulation ──────────────────► Viewer ─────────────────────► browsers
//!             ◄──────────────────  a thread  ◄───────────────────
//!             orders               of its own        orders with the token
//! ```
//!
//! It knows vehicles only as what is drawn of them: no MAVLink, no engine. What is published replaces what was published before,
//! so that a slow browser misses frames and never delays the simulation.

#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod assets;
mod bounded_listener;
mod client;
mod film;
mod frame;
mod guard;
mod hub;
mod news;
mod order;
mod recording;
mod replayer;
mod scene;
mod server;
mod standalone;
mod token;

pub use film::{Film, NewsFrom};
pub use frame::{Frame, Solver, VehicleState};
pub use news::{News, Text, VehicleNews};
pub use order::{Action, Order, Reply};
pub use recording::Recording;
pub use replayer::Replayer;
pub use scene::{FenceScene, GroundScene, ObstacleScene, Scene, VehicleScene, Waypoint, ZoneScene};
pub use server::{Past, Viewer, ViewerError};
pub use standalone::standalone;
pub use token::Token;
