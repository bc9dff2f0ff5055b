//! Ways that are planned in time: straight lines and the blends between them, and curves, within the limits of speed, acceleration and
//! jerk.
//!
//! ```text
//!  direction limits ──┬─► straight: along a line, time-optimal
//!                     ├─► blend: around a corner, at a constant direction of the acceleration
//!                     └─► curve speed: the fastest along curve pieces ──► eased speed: under an acceleration that changes evenly
//!  straight, blend ─────► piece ──► piece flight: a piece that began at a time
//! ```

mod blend;
mod curve_piece;
mod curve_speed;
mod direction_limits;
mod eased_speed;
mod piece_flight;
mod straight;

pub use blend::Blend;
pub use curve_piece::CurvePiece;
pub use curve_speed::CurveSpeed;
pub use direction_limits::{change_distance_m, limits_along};
pub use eased_speed::EasedSpeed;
pub use piece_flight::{Piece, PieceFlight};
pub use straight::Straight;
