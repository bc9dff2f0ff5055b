//! The world around the vehicle: where its local frame lies on the earth, headings, air, wind and magnetic field.

mod atmosphere;
mod heading;
mod local_frame;
mod magnetic_field;
mod told_frame;
mod wind;
pub mod wind_drag;

pub use atmosphere::{atmospheric_pressure_pa, atmospheric_temperature_degc, pressure_altitude_m};
pub use heading::heading_deg;
pub use local_frame::{FARTHEST_M, Geodetic, LocalFrame};
pub use magnetic_field::earth_field_ned;
pub use told_frame::ToldFrame;
pub use wind::{Wind, WindProfile, WindSettings, WindShape};
