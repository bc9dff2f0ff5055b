//! Where the places of a plan are.

use nalgebra::Vector3;

use super::{Altitude, MissionItem, Place};
use crate::identity::Identity;
use crate::surroundings::Terrain;
use crate::world::{Geodetic, LocalFrame};

/// MAV_FRAME.
#[allow(missing_docs)] // Their names are their documentation.
pub mod frame {
    pub const GLOBAL: u8 = 0;
    pub const LOCAL_NED: u8 = 1;
    pub const MISSION: u8 = 2;
    pub const GLOBAL_RELATIVE: u8 = 3;
    pub const GLOBAL_INT: u8 = 5;
    pub const GLOBAL_RELATIVE_INT: u8 = 6;
    pub const LOCAL_OFFSET_NED: u8 = 7;
    pub const BODY_NED: u8 = 8;
    pub const BODY_OFFSET_NED: u8 = 9;
    pub const GLOBAL_TERRAIN: u8 = 10;
    pub const GLOBAL_TERRAIN_INT: u8 = 11;
}

/// What the places of a plan refer to.
#[derive(Clone, Debug)]
pub struct Site {
    /// Whose conventions hold.
    pub identity: Identity,
    /// The local frame.
    pub frame: LocalFrame,
    /// Home, NED, m.
    pub home_m: Vector3<f64>,
    /// The ground.
    pub terrain: Terrain,
}

impl Site {
    /// Whether x, y, z of a frame are a place here.
    pub fn knows(frame: u8) -> bool {
        frame == frame::LOCAL_NED || is_global(frame)
    }

    /// The place of an item. Latitude and longitude that are no numbers, or both zero, leave it open, as clients send them for
    /// "here"; an altitude above the terrain is then one above the ground at home.
    ///
    /// `None` for an unknown frame or a latitude or longitude that there is not.
    pub fn place(&self, item: &MissionItem) -> Option<Place> {
        let [x, y, z] = item.position;
        let finite = |value: f64| Some(value).filter(|value| value.is_finite());
        if item.frame == frame::LOCAL_NED {
            let horizontal_m = finite(x).zip(finite(y)).map(|(x, y)| [x, y]);
            return Some(Place { horizontal_m, altitude: finite(z).map(Altitude::Down) });
        }
        if !is_global(item.frame) {
            return None;
        }
        let here = x.is_nan() && y.is_nan() || (x == 0.0 && y == 0.0);
        let horizontal_m = if here {
            None
        } else {
            let altitude_m = self.frame.origin().altitude_m;
            let place = Geodetic { latitude_deg: x, longitude_deg: y, altitude_m };
            if !place.is_valid() {
                return None;
            }
            let local = self.frame.to_local_m(&place);
            Some([local.x, local.y])
        };
        let altitude = finite(z).map(|altitude_m| {
            self.altitude(item.frame, altitude_m, horizontal_m.unwrap_or([self.home_m.x, self.home_m.y]))
        });
        Some(Place { horizontal_m, altitude })
    }

    /// z, m, of an altitude, m, in a global frame, at a place north and east, m, with home where it is now.
    pub fn down_m(&self, frame: u8, altitude_m: f64, place_m: [f64; 2]) -> f64 {
        self.altitude(frame, altitude_m, place_m).down_m(self.home_m.z)
    }

    /// An altitude, m, in a global frame, at a place north and east, m.
    fn altitude(&self, frame: u8, altitude_m: f64, place_m: [f64; 2]) -> Altitude {
        match frame {
            frame::GLOBAL_RELATIVE | frame::GLOBAL_RELATIVE_INT => Altitude::AboveHome(altitude_m),
            frame::GLOBAL_TERRAIN | frame::GLOBAL_TERRAIN_INT => {
                Altitude::AboveGround(self.terrain.z_m(place_m) - altitude_m)
            }
            _ => Altitude::Down(self.frame.origin().altitude_m - altitude_m),
        }
    }
}

/// Whether altitudes of a frame are above the ground.
pub fn is_above_ground(frame: u8) -> bool {
    matches!(frame, frame::GLOBAL_TERRAIN | frame::GLOBAL_TERRAIN_INT)
}

/// Whether a frame has latitude and longitude.
pub fn is_global(frame: u8) -> bool {
    matches!(
        frame,
        frame::GLOBAL
            | frame::GLOBAL_INT
            | frame::GLOBAL_RELATIVE
            | frame::GLOBAL_RELATIVE_INT
            | frame::GLOBAL_TERRAIN
            | frame::GLOBAL_TERRAIN_INT
    )
}
