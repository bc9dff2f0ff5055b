//! The first line of a record: what its flights began with.

use autopilot::envelope::LinkProfile;
use serde::{Deserialize, Serialize};
use vehicle::VehicleSettings;
use vehicle::parameters::Speed;

/// Name of the format, and what its versions begin with.
const NAME: &str = "lmpc-sitl record ";
/// Version of the format.
const VERSION: &str = "3";

/// What a flight began with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    format: String,
    /// Version of the program.
    pub program: String,
    /// Pace at the start; it does not change the flights.
    pub speed: Speed,
    /// Time of the start since 1970, µs.
    #[serde(default)]
    pub unix_start_us: u64,
    /// The vehicles.
    pub vehicles: Vec<Participant>,
}

/// A vehicle of a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Participant {
    /// MAVLink system id.
    pub system_id: u8,
    /// What its links were for.
    pub links: Vec<LinkProfile>,
    /// The vehicle.
    pub vehicle: VehicleSettings,
}

impl Header {
    /// A header of this program.
    pub fn new(speed: Speed, vehicles: Vec<Participant>) -> Self {
        let program = env!("CARGO_PKG_VERSION").to_owned();
        Self { format: format!("{NAME}{VERSION}"), program, speed, unix_start_us: 0, vehicles }
    }

    /// The same with the time of the start since 1970, µs.
    pub fn started_at(self, unix_start_us: u64) -> Self {
        Self { unix_start_us, ..self }
    }

    /// Reads the text of a header whose checksum is right.
    ///
    /// # Errors
    /// Why it cannot be used.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        serde_json::from_str(text).map_err(|error| format!("line 1 is not the header of a record: {error}"))
    }

    /// Refuses a first line of anything but this version, whatever its checksum.
    ///
    /// # Errors
    /// What the file is instead.
    pub(super) fn check_format(line: &[u8]) -> Result<(), String> {
        #[derive(Deserialize)]
        struct Format {
            format: String,
        }
        // A checksum may follow.
        let first = serde_json::Deserializer::from_slice(line).into_iter::<Format>().next();
        let format = first.and_then(Result::ok).map(|header| header.format).unwrap_or_default();
        match format.strip_prefix(NAME) {
            Some(VERSION) => Ok(()),
            Some(other) => Err(format!(
                "is a record of format {other}, and this program reads format {VERSION}; replay it with the release that wrote it"
            )),
            None if line.windows(NAME.len()).any(|bytes| bytes == NAME.as_bytes()) => {
                Err("line 1, the header, is damaged".to_owned())
            }
            None => Err("is not a record: line 1 is not the header of one; records are written by --record"
                .to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Header, Speed};

    #[test]
    fn other_formats_are_told_apart() {
        let text = serde_json::to_string(&Header::new(Speed::Max, Vec::new())).expect("a header");
        assert_eq!(Header::check_format(format!("{text} 01234567\n").as_bytes()), Ok(()));
        let older = text.replace("record 3", "record 2");
        let reason = Header::check_format(older.as_bytes()).expect_err("older");
        assert!(reason.contains("format 2") && reason.contains("format 3"), "{reason}");
        let damaged = text.replace(':', ";");
        assert!(Header::check_format(damaged.as_bytes()).expect_err("damaged").contains("is damaged"));
        for other in ["", "{}", "{\"format\": 3}", "PK\u{3}\u{4}", "[]"] {
            assert!(Header::check_format(other.as_bytes()).expect_err(other).contains("not a record"));
        }
    }
}
