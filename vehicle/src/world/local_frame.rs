//! The local frame on the WGS-84 ellipsoid.

use libm::{atan2, cos, hypot, sin, sqrt};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Semi-major axis of WGS-84, m.
const A_M: f64 = 6_378_137.0;
/// First eccentricity of WGS-84, squared.
const E2: f64 = 6.694_379_990_141_316_5e-3;

/// Farther than this from the origin, m, nothing is flown to: the tangent plane is not the earth.
pub const FARTHEST_M: f64 = 100_000.0;

/// A place on the earth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Geodetic {
    /// Latitude, degrees north.
    pub latitude_deg: f64,
    /// Longitude, degrees east.
    pub longitude_deg: f64,
    /// Altitude above mean sea level, m. The geoid counts as the ellipsoid.
    pub altitude_m: f64,
}

impl Geodetic {
    /// Whether it is a place: finite, latitude within ±90°, longitude within ±180°.
    pub fn is_valid(&self) -> bool {
        self.latitude_deg.abs() <= 90.0 && self.longitude_deg.abs() <= 180.0 && self.altitude_m.is_finite()
    }
}

/// North, east, down at an origin.
///
/// North and east are those of the plane that touches the ellipsoid there (the local tangent plane of WGS-84,
/// through earth-centred coordinates); the altitude is carried beside them, so that down is always minus the
/// height above the origin: the ground of the simulation is flat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalFrame {
    origin: Geodetic,
    centre_m: Vector3<f64>,
    north: Vector3<f64>,
    east: Vector3<f64>,
}

impl Default for Geodetic {
    /// Where PX4's simulators start: a field near Zurich.
    fn default() -> Self {
        Self { latitude_deg: 47.397_742, longitude_deg: 8.545_594, altitude_m: 488.0 }
    }
}

impl LocalFrame {
    /// The frame whose origin lies here.
    pub fn new(origin: Geodetic) -> Self {
        let (phi, lambda) = (origin.latitude_deg.to_radians(), origin.longitude_deg.to_radians());
        Self {
            origin,
            centre_m: earth_centred_m(phi, lambda, origin.altitude_m),
            north: Vector3::new(-sin(phi) * cos(lambda), -sin(phi) * sin(lambda), cos(phi)),
            east: Vector3::new(-sin(lambda), cos(lambda), 0.0),
        }
    }

    /// The origin.
    pub fn origin(&self) -> Geodetic {
        self.origin
    }

    /// A place in the local frame, NED, m.
    pub fn to_local_m(&self, place: &Geodetic) -> Vector3<f64> {
        let (phi, lambda) = (place.latitude_deg.to_radians(), place.longitude_deg.to_radians());
        let way = earth_centred_m(phi, lambda, self.origin.altitude_m) - self.centre_m;
        Vector3::new(way.dot(&self.north), way.dot(&self.east), self.origin.altitude_m - place.altitude_m)
    }

    /// A local position, NED, m, as a place.
    pub fn to_geodetic(&self, position_m: &Vector3<f64>) -> Geodetic {
        // The point of the ellipsoid (raised to the origin's altitude) above or below the tangent plane:
        // a few steps, because down depends on how far north and east it is.
        let up = self.north.cross(&self.east) * -1.0;
        let plane = self.centre_m + self.north * position_m.x + self.east * position_m.y;
        let (mut phi, mut lambda, mut sunk_m) = (0.0, 0.0, 0.0);
        for _ in 0..4 {
            let height_m;
            (phi, lambda, height_m) = geodetic_of(&(plane - up * sunk_m));
            sunk_m += height_m - self.origin.altitude_m;
        }
        Geodetic {
            latitude_deg: phi.to_degrees(),
            longitude_deg: lambda.to_degrees(),
            altitude_m: self.origin.altitude_m - position_m.z,
        }
    }
}

/// Earth-centred, earth-fixed coordinates, m.
fn earth_centred_m(phi: f64, lambda: f64, h_m: f64) -> Vector3<f64> {
    // N = a / √(1 − e² sin²φ)
    let n = A_M / sqrt(1.0 - E2 * sin(phi) * sin(phi));
    Vector3::new(
        (n + h_m) * cos(phi) * cos(lambda),
        (n + h_m) * cos(phi) * sin(lambda),
        (n * (1.0 - E2) + h_m) * sin(phi),
    )
}

/// Latitude and longitude, rad, and height, m, of earth-centred coordinates (Bowring 1976; two rounds leave
/// nanometres near the surface).
fn geodetic_of(point_m: &Vector3<f64>) -> (f64, f64, f64) {
    let p = hypot(point_m.x, point_m.y);
    let b_m = A_M * sqrt(1.0 - E2);
    let second = E2 / (1.0 - E2);
    let mut beta = atan2(point_m.z * A_M, p * b_m);
    let mut phi = 0.0;
    for _ in 0..2 {
        let (s, c) = (sin(beta), cos(beta));
        phi = atan2(point_m.z + second * b_m * s * s * s, p - E2 * A_M * c * c * c);
        beta = atan2((b_m / A_M) * sin(phi), cos(phi));
    }
    let n = A_M / sqrt(1.0 - E2 * sin(phi) * sin(phi));
    // h from the better conditioned of the two components.
    let h_m = p * cos(phi) + point_m.z * sin(phi) - n * (1.0 - E2 * sin(phi) * sin(phi));
    (phi, atan2(point_m.y, point_m.x), h_m)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::{Geodetic, LocalFrame};

    proptest! {
        #[test]
        fn there_and_back_is_where_it_was(
            latitude_deg in -85.0..85.0, longitude_deg in -180.0..180.0, altitude_m in -100.0..4000.0,
            x in -20_000.0..20_000.0, y in -20_000.0..20_000.0, z in -1000.0..0.0,
        ) {
            let frame = LocalFrame::new(Geodetic { latitude_deg, longitude_deg, altitude_m });
            let position = Vector3::new(x, y, z);
            let again = frame.to_local_m(&frame.to_geodetic(&position));
            prop_assert!((again - position).norm() < 1e-4, "{position} became {again}");
        }
    }

    /// Arc lengths of one minute at 45° of WGS-84, from its published radii of curvature M = 6367 381.8 m and
    /// N = 6388 838.3 m.
    #[test]
    fn a_minute_is_as_long_as_the_ellipsoid_says() {
        let frame = LocalFrame::new(Geodetic { latitude_deg: 45.0, longitude_deg: 8.0, altitude_m: 0.0 });
        let minute = 1.0 / 60.0;
        let radian = f64::to_radians(minute);
        let north = Geodetic { latitude_deg: 45.0 + minute, longitude_deg: 8.0, altitude_m: 10.0 };
        let local = frame.to_local_m(&north);
        assert!((local.x - 6_367_381.8 * radian).abs() < 0.5, "{local}");
        assert!(local.y.abs() < 1e-6 && local.z == -10.0, "{local}");
        let east = Geodetic { latitude_deg: 45.0, longitude_deg: 8.0 + minute, altitude_m: 0.0 };
        let local = frame.to_local_m(&east);
        assert!((local.y - 6_388_838.3 * f64::cos(f64::to_radians(45.0)) * radian).abs() < 0.05, "{local}");
    }
}
