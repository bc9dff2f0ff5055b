//! Ways that are planned in time: straight lines and the blends between them, within the limits of speed, acceleration and jerk.
//!
//! ```text
//!  direction limits ──┬─► straight: along a line, time-optimal
//!                     └─► blend: around a corner, at a constant direction of the acceleration
//!  straight, blend ─────► piece ──► piece flight: a piece that began at a time
//! ```

mod blend;
mod direction_limits;
mod piece_flight;
mod straight;

pub use blend::Blend;
pub use direction_limits::{change_distance_m, limits_along};
pub use piece_flight::{Piece, PieceFlight};
pub use straight::Straight;
