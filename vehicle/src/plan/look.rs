//! What a vehicle is asked to look at.

use super::Place;

/// A region of interest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Look {
    /// A place; what it leaves open is that of the vehicle, and z = 0.
    At(Place),
    /// Where the leg of a mission leads, plus an angle.
    NextWaypoint {
        /// Clockwise from there, rad.
        offset_rad: f64,
    },
}
