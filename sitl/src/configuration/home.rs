//! `--home lat,lon,alt,heading`.

use std::str::FromStr;

use vehicle::world::Geodetic;

use super::ranged::numbers;

/// Where the vehicle stands at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomePosition {
    /// The place.
    pub place: Geodetic,
    /// Heading, degrees from north through east.
    pub heading_deg: f64,
}

impl Default for HomePosition {
    fn default() -> Self {
        Self { place: Geodetic::default(), heading_deg: 0.0 }
    }
}

impl FromStr for HomePosition {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "invalid place `{text}`; use LAT,LON,ALT[,HEADING]: latitude -85 to 85 and longitude -180 to 180 degrees, \
                 altitude -1000 to 10000 m, heading -360 to 360 degrees"
            )
        };
        let numbers = numbers(text).ok_or_else(wrong)?;
        let (latitude_deg, longitude_deg, altitude_m, heading_deg) = match *numbers.as_slice() {
            [latitude, longitude, altitude] => (latitude, longitude, altitude, 0.0),
            [latitude, longitude, altitude, heading] => (latitude, longitude, altitude, heading),
            _ => return Err(wrong()),
        };
        let fits = latitude_deg.abs() <= 85.0
            && longitude_deg.abs() <= 180.0
            && (-1000.0..=10_000.0).contains(&altitude_m)
            && heading_deg.abs() <= 360.0;
        let place = Geodetic { latitude_deg, longitude_deg, altitude_m };
        if fits { Ok(Self { place, heading_deg }) } else { Err(wrong()) }
    }
}
