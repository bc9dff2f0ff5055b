//! Aircraft of the simulation, whose ways are known from the start.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::Aircraft;

/// An aircraft and its way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScriptedAircraft {
    /// Its address, 24 bits.
    pub id: u32,
    /// What it calls itself: at most eight characters.
    pub callsign: String,
    /// Emitter category of ADS-B.
    pub category: u8,
    /// Its way.
    pub way: Way,
}

/// A way, in the local frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Way {
    /// Straight on for ever.
    Straight {
        /// Where it is at the start, NED, m.
        from_m: [f64; 3],
        /// How it moves, NED, m/s.
        velocity_m_s: [f64; 3],
    },
    /// Straight from place to place; it is there from the first time to the last one.
    Track(Vec<TrackPoint>),
}

/// A time, s, and the place, NED, m, at that time.
pub type TrackPoint = (f64, [f64; 3]);

impl ScriptedAircraft {
    /// What its transponder tells at a time, µs; `None` while it is not there.
    pub fn at(&self, time_us: u64) -> Option<Aircraft> {
        let time_s = time_us as f64 / 1e6;
        let (position_m, velocity_m_s) = match &self.way {
            Way::Straight { from_m, velocity_m_s } => {
                let velocity_m_s = Vector3::from(*velocity_m_s);
                (Vector3::from(*from_m) + velocity_m_s * time_s, velocity_m_s)
            }
            Way::Track(points) => {
                let mut legs = points.iter().zip(points.iter().skip(1));
                let ((from_s, from_m), (to_s, to_m)) =
                    legs.find(|((from_s, _), (to_s, _))| (*from_s..=*to_s).contains(&time_s))?;
                let (from_m, to_m) = (Vector3::from(*from_m), Vector3::from(*to_m));
                let velocity_m_s = (to_m - from_m) / (to_s - from_s);
                (from_m + velocity_m_s * (time_s - from_s), velocity_m_s)
            }
        };
        let mut callsign = [0; 9];
        for (place, letter) in callsign.iter_mut().take(8).zip(self.callsign.bytes()) {
            *place = letter;
        }
        let (id, category) = (self.id, self.category);
        Some(Aircraft {
            id,
            callsign,
            category,
            position_m,
            velocity_m_s,
            heard_us: time_us,
            simulated: true,
        })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{ScriptedAircraft, Way};

    #[test]
    fn a_track_is_flown_from_place_to_place_and_ends() {
        let points =
            vec![(10.0, [0.0, 0.0, -100.0]), (20.0, [200.0, 0.0, -100.0]), (30.0, [200.0, 100.0, -150.0])];
        let aircraft =
            ScriptedAircraft { id: 7, callsign: "TEST".to_owned(), category: 1, way: Way::Track(points) };
        assert_eq!(aircraft.at(9_000_000), None);
        let on_its_way = aircraft.at(25_000_000).expect("there");
        assert_eq!(on_its_way.position_m, Vector3::new(200.0, 50.0, -125.0));
        assert_eq!(on_its_way.velocity_m_s, Vector3::new(0.0, 10.0, -5.0));
        assert_eq!(on_its_way.name(), "TEST");
        assert_eq!(aircraft.at(31_000_000), None);
    }
}
