//! `--traffic`: aircraft that fly by: one straight on, those of a file, or the other vehicles of the run.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use vehicle::surroundings::{ScriptedAircraft, Way};

use super::text_file::{read_text, toml_mistake};
use crate::failure::Failure;

/// Addresses of aircraft that name none begin here: those of no state.
const FIRST_ADDRESS: u32 = 0xf0_0001;
const LAST_ADDRESS: u32 = 0xff_ffff;
/// Emitter category of one that names none: light.
const LIGHT: u8 = 1;
/// Fastest, m/s.
const FASTEST_M_S: f64 = 600.0;

/// What flies by.
#[derive(Clone, Debug, PartialEq)]
pub enum TrafficChoice {
    /// The other vehicles of the run.
    Fleet,
    /// One aircraft, straight on.
    Straight(Straight),
    /// The aircraft of a TOML file.
    File(PathBuf),
}

/// A straight flight: north, east and height above the origin, m; speed, m/s; course, degrees; climb, m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Straight {
    from: [f64; 3],
    speed: f64,
    course_deg: f64,
    climb: f64,
}

impl TrafficChoice {
    /// Reads `fleet`, `NORTH,EAST,HEIGHT,SPEED,COURSE[,CLIMB]` or `FILE.toml`.
    ///
    /// # Errors
    /// What is allowed.
    pub fn of(given: OsString) -> Result<Self, String> {
        let path = PathBuf::from(given);
        let text = path.to_str().unwrap_or_default();
        if text == "fleet" {
            return Ok(Self::Fleet);
        }
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
            return Ok(Self::File(path));
        }
        let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[north, east, height, speed, course_deg]) => {
                straight([north, east, height], speed, course_deg, 0.0)
            }
            Some(&[north, east, height, speed, course_deg, climb]) => {
                straight([north, east, height], speed, course_deg, climb)
            }
            _ => Err(format!("`{text}`: allowed fleet, NORTH,EAST,HEIGHT,SPEED,COURSE[,CLIMB] or FILE.toml")),
        }
        .map(Self::Straight)
    }

    /// The aircraft, with addresses from a number on; none of the fleet, which flies itself.
    ///
    /// # Errors
    /// [`Failure`] of a file that cannot be read.
    pub(super) fn aircraft(&self, number: usize) -> Result<Vec<ScriptedAircraft>, Failure> {
        match self {
            Self::Fleet => Ok(Vec::new()),
            Self::Straight(way) => Ok(vec![ScriptedAircraft {
                id: address(number),
                callsign: callsign(number),
                category: LIGHT,
                way: way.way(),
            }]),
            Self::File(path) => read(path, number),
        }
    }
}

impl Straight {
    fn way(&self) -> Way {
        let [north, east, height] = self.from;
        let course_rad = self.course_deg.to_radians();
        Way::Straight {
            from_m: [north, east, -height],
            velocity_m_s: [
                self.speed * libm::cos(course_rad),
                self.speed * libm::sin(course_rad),
                -self.climb,
            ],
        }
    }
}

fn straight(from: [f64; 3], speed: f64, course_deg: f64, climb: f64) -> Result<Straight, String> {
    let finite = from.iter().chain([&course_deg]).all(|number| number.is_finite());
    if !finite || !(0.0..=FASTEST_M_S).contains(&speed) || !(-FASTEST_M_S..=FASTEST_M_S).contains(&climb) {
        return Err(format!(
            "speed {speed} m/s, climb {climb} m/s; allowed 0 to {FASTEST_M_S} m/s, and finite places"
        ));
    }
    Ok(Straight { from, speed, course_deg, climb })
}

fn address(number: usize) -> u32 {
    FIRST_ADDRESS.saturating_add(u32::try_from(number).unwrap_or(u32::MAX)).min(LAST_ADDRESS)
}

fn callsign(number: usize) -> String {
    format!("SIM{}", number + 1)
}

/// The file: a table `[[aircraft]]` for each.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct TrafficFile {
    aircraft: Vec<AircraftTable>,
}

/// An aircraft: `from`, `speed`, `course` and perhaps `climb`, or a `track` of times, s, with north, east and height, m.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct AircraftTable {
    callsign: Option<String>,
    icao: Option<u32>,
    category: Option<u8>,
    from: Option<[f64; 3]>,
    speed: Option<f64>,
    course: Option<f64>,
    climb: Option<f64>,
    track: Option<Vec<[f64; 4]>>,
}

fn read(path: &Path, first: usize) -> Result<Vec<ScriptedAircraft>, Failure> {
    parse(&read_text(path)?, first).map_err(|reason| Failure::Content { path: path.to_owned(), reason })
}

fn parse(text: &str, first: usize) -> Result<Vec<ScriptedAircraft>, String> {
    let file: TrafficFile = toml::from_str(text).map_err(|error| toml_mistake(text, &error))?;
    file.aircraft.into_iter().zip(first..).map(|(table, number)| aircraft(table, number)).collect()
}

fn aircraft(table: AircraftTable, number: usize) -> Result<ScriptedAircraft, String> {
    let name = table.callsign.clone().unwrap_or_else(|| callsign(number));
    let wrong = |reason: String| format!("aircraft {name}: {reason}");
    if name.len() > 8 || !name.bytes().all(|letter| letter.is_ascii_graphic()) {
        return Err(wrong("the callsign must have at most eight letters, digits or signs".to_owned()));
    }
    let id = table.icao.unwrap_or_else(|| address(number));
    if id > LAST_ADDRESS {
        return Err(wrong(format!("icao {id}; allowed 0 to {LAST_ADDRESS} (24 bits)")));
    }
    let way = match (table.from, table.track) {
        (Some(from), None) => {
            let (speed, course) = (table.speed.unwrap_or(0.0), table.course.unwrap_or(0.0));
            straight(from, speed, course, table.climb.unwrap_or(0.0)).map_err(wrong)?.way()
        }
        (None, Some(track)) => track_of(&track).map_err(wrong)?,
        _ => return Err(wrong("give `from` with `speed` and `course`, or a `track`".to_owned())),
    };
    Ok(ScriptedAircraft { id, callsign: name, category: table.category.unwrap_or(LIGHT), way })
}

fn track_of(track: &[[f64; 4]]) -> Result<Way, String> {
    let ordered = track.windows(2).all(|pair| matches!(pair, [[before, ..], [after, ..]] if before < after));
    let finite = track.iter().flatten().all(|number| number.is_finite());
    if track.len() < 2 || !ordered || !finite {
        return Err(
            "a track needs two or more places [seconds, north, east, height] with rising times".to_owned()
        );
    }
    let point = |[time_s, north, east, height]: &[f64; 4]| (*time_s, [*north, *east, -*height]);
    Ok(Way::Track(track.iter().map(point).collect()))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{TrafficChoice, parse};

    #[test]
    fn a_straight_flight_is_six_numbers_at_most() {
        let choice = TrafficChoice::of("800,-10,60,30,180".into()).expect("an aircraft");
        let aircraft = choice.aircraft(0).expect("one");
        let later = aircraft[0].at(10_000_000).expect("there");
        assert!((later.position_m - Vector3::new(500.0, -10.0, -60.0)).norm() < 1e-9, "{later:?}");
        assert_eq!(later.name(), "SIM1");
        assert_eq!(TrafficChoice::of("fleet".into()), Ok(TrafficChoice::Fleet));
        for wrong in ["flet", "1,2,3", "0,0,0,1000,0", "0,0,0,nan,0"] {
            assert!(TrafficChoice::of(wrong.into()).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_file_has_straight_flights_and_tracks() {
        let text = "[[aircraft]]\ncallsign = \"HB-ABC\"\nicao = 4928512\nfrom = [0, 0, 100]\nspeed = 20\ncourse = 90\nclimb = 1\n\
                    [[aircraft]]\ntrack = [[0, 0, 0, 50], [10, 100, 0, 50]]\n";
        let aircraft = parse(text, 3).expect("two");
        assert_eq!((aircraft[0].id, aircraft[0].callsign.as_str()), (4_928_512, "HB-ABC"));
        let at = |number: usize| aircraft[number].at(5_000_000).expect("there").position_m;
        assert!((at(0) - Vector3::new(0.0, 100.0, -105.0)).norm() < 1e-9);
        assert!((at(1) - Vector3::new(50.0, 0.0, -50.0)).norm() < 1e-9);
        assert_eq!(aircraft[1].callsign, "SIM5");
        for (text, expected) in [
            ("[[aircraft]]\nspeed = 3\n", "aircraft SIM1: give `from`"),
            ("[[aircraft]]\ntrack = [[1, 0, 0, 0], [1, 5, 0, 0]]\n", "aircraft SIM1: a track needs two"),
            ("[[aircraft]]\nfrom = [0, 0]\n", "line 2"),
        ] {
            let reason = parse(text, 0).expect_err(text);
            assert!(reason.starts_with(expected), "{reason}");
        }
    }
}
