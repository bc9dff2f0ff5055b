//! Files that a person has edited, cut or mixed up.

use std::path::Path;

use autopilot::Autopilot;
use autopilot::codec::{Message, Version};
use autopilot::envelope::{LinkProfile, Origin, PeerId};
use sitl::configuration::{Addressed, Arguments, Settings};
use sitl::record::{Digest, Header, Reader, Recorder};
use sitl::signing::{Kept, SecretKey};
use vehicle::parameters::{FileFormat, ParameterTable, ParameterValues, Speed, Statistics, render};

use super::bytes::Bytes;
use crate::seal::sealed;

/// Ticks that a vehicle from a file flies.
const TICKS: usize = 50;
/// Words that stand where others did.
const WORDS: [&str; 16] = [
    "NaN",
    "-inf",
    "1e999",
    "-1",
    "0",
    "4294967296",
    "1e-320",
    "null",
    "\"\"",
    "[]",
    "{",
    "}",
    "true",
    "16",
    "\u{1F681}",
    "\t",
];
const PLAN: &str = include_str!("../corpus/mission.plan");
const WAYPOINTS: &str = include_str!("../corpus/mission.waypoints");
const TIMESTAMPS: &str =
    "lmpc-sitl signing timestamps 2\nsent 7\nforgotten 19\nstream 0 255 190 5\nstream 3 1 1 19\n";
const CONFIGURATION: &str = "# a vehicle\nautopilot = \"ardupilot\"\nhome = \"-35.363262,149.165237,584,353\"\nspeed = \"5\"\nwind = \"4,270\"\ngusts = 1.5\n\
    seed = 7\nvehicles = 3\nformation = \"circle,6\"\nset = [\"FRAME_MASS=0.8\"]\nfault = [\"12.5:rotor1=off\"]\nnoise = \"rtk-gps\"\nkalman = true\nduration = 9.0\n";

/// Reads one file of each kind. Panics if a reader does, or if what it has accepted does not fly. Returns how many there were.
pub fn changed(seed: u64) -> u64 {
    let mut bytes = Bytes::new(seed);
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: String| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        path
    };
    for (name, text) in [("a.plan", PLAN), ("a.waypoints", WAYPOINTS)] {
        let mission = write(name, edited(&mut bytes, text));
        let mission = Some(vec![Addressed { system_id: None, value: mission }]);
        fly(&Arguments { mission, ..Arguments::default() });
    }
    for (name, format) in [("a.parm", FileFormat::Plain), ("a.params", FileFormat::QGroundControl)] {
        let parameters = write(name, edited(&mut bytes, &parameters(format)));
        fly(&Arguments { parameters: Some(parameters), ..Arguments::default() });
    }
    let configuration = write("a.toml", edited(&mut bytes, CONFIGURATION));
    if let Ok(arguments) = sitl::configuration::file::read(&configuration) {
        fly(&arguments);
    }
    let path = folder.path().join("a.lmpc");
    recorded(&path);
    let text = std::fs::read_to_string(&path).expect("a record");
    // With the checksums of somebody who knows how they are made, and without.
    let mut text = edited(&mut bytes, &text);
    if bytes.below(4) > 0 {
        text = sealed(&text);
    }
    std::fs::write(&path, text).expect("written");
    if let Ok(mut reader) = Reader::open(&path) {
        let entries = reader.by_ref().take_while(Result::is_ok).count();
        assert!(entries < 100, "{entries} entries of a short record");
        for participant in &reader.header().vehicles {
            let _refused = Autopilot::new(
                &participant.vehicle,
                participant.system_id,
                Speed::Max,
                &participant.links,
                0,
            );
        }
    }
    if let Ok(kept) = Kept::parse(&edited(&mut bytes, TIMESTAMPS)) {
        assert_eq!(Kept::parse(&kept.render()), Ok(kept));
    }
    let _key = SecretKey::read(edited(&mut bytes, &"5a".repeat(32)).as_bytes());
    8
}

/// What is refused says why in one line; what is not flies.
fn fly(arguments: &Arguments) {
    let vehicles = match Settings::resolve(arguments) {
        Ok(settings) => settings.vehicles,
        Err(failure) => {
            let told = failure.to_string();
            assert!(!told.is_empty() && told.lines().count() == 1, "{told}");
            return;
        }
    };
    for own in vehicles.iter().take(2) {
        let links = [LinkProfile::Ground];
        let mut autopilot =
            Autopilot::new(&own.vehicle, own.system_id, Speed::Max, &links, 0).expect("it was accepted");
        for _ in 0..TICKS {
            autopilot.tick().expect("the flight goes on");
            drop(autopilot.take_outgoing());
        }
    }
}

/// The parameters as the vehicle writes them.
fn parameters(format: FileFormat) -> String {
    let settings = Settings::resolve(&Arguments::default()).expect("defaults");
    let vehicle = &settings.vehicles[0].vehicle;
    let table = ParameterTable::new(vehicle.identity);
    let (configuration, conduct) = (vehicle.configuration, vehicle.conduct);
    render(
        format,
        &table,
        &ParameterValues {
            configuration,
            conduct,
            system_id: 1,
            speed: Speed::Max,
            statistics: Statistics::default(),
        },
    )
}

/// A short record.
fn recorded(path: &Path) {
    use mavlink::dialects::ardupilotmega::{HEARTBEAT_DATA, MavMessage};
    let settings = Settings::resolve(&Arguments::default()).expect("defaults");
    let mut recorder =
        Recorder::create(path, &Header::new(Speed::Max, settings.participants()), u64::MAX).expect("a file");
    let message = Message::from(MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    let frame = autopilot::codec::Frame::encode(&message, Version::Two, 0, (255, 190)).expect("a frame");
    let origin = Origin { peer: PeerId { link: 0, number: 0 }, system: 255, component: 190 };
    for time_us in [0, 1_000, 250_000] {
        recorder.frame(0, time_us, &origin, &frame);
    }
    recorder.ground_station(0, 300_000, true);
    recorder.end(0, 400_000, Digest::default());
    assert_eq!(recorder.finish(), None);
}

/// A text after some edits, still UTF-8.
fn edited(bytes: &mut Bytes, text: &str) -> String {
    let mut text = text.to_owned();
    for _ in 0..bytes.below(5) {
        let place = |bytes: &mut Bytes, text: &str| {
            let at = bytes.below(text.len() + 1);
            (at..=text.len()).find(|at| text.is_char_boundary(*at)).unwrap_or(text.len())
        };
        let at = place(bytes, &text);
        match bytes.below(7) {
            // A character more, or another.
            0 => text.insert(at, char::from(b' ' + bytes.below(95) as u8)),
            1 if at < text.len() => drop(text.remove(at)),
            // Cut off.
            2 if bytes.below(4) == 0 => text.truncate(at),
            // A line doubled, lost or elsewhere.
            3 => {
                let mut lines: Vec<&str> = text.lines().collect();
                if !lines.is_empty() {
                    let from = bytes.below(lines.len());
                    let line = lines[from];
                    match bytes.below(3) {
                        0 => drop(lines.remove(from)),
                        1 => lines.insert(from, line),
                        _ => lines.insert(bytes.below(lines.len()), line),
                    }
                    text = lines.join("\n") + "\n";
                }
            }
            // Another word.
            _ => {
                let is_word = |character: char| character.is_alphanumeric() || "+-._".contains(character);
                let start = text[..at]
                    .rfind(|character| !is_word(character))
                    .map_or(0, |before| before + text[before..].chars().next().map_or(1, char::len_utf8));
                let end =
                    text[at..].find(|character| !is_word(character)).map_or(text.len(), |after| at + after);
                if start < end {
                    text.replace_range(start..end, WORDS[bytes.below(WORDS.len())]);
                }
            }
        }
    }
    text
}
