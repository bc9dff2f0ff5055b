//! The world around the vehicle: where its local frame lies on the earth, and the wind.

mod field;
mod local_frame;
mod wind;

pub use field::{atmospheric_pressure_pa, earth_field_ned, pressure_altitude_m};
pub use local_frame::{Geodetic, LocalFrame};
pub use wind::{Wind, WindSettings};
