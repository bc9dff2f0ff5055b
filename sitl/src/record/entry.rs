//! One line of a record behind its header.

use std::fmt;

use autopilot::codec::Frame;
use autopilot::envelope::{Origin, PeerId};
use vehicle::Pulses;

/// What happened to one vehicle, and when.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// When, µs of the vehicle's own clock.
    pub time_us: u64,
    /// Number of the vehicle, from zero in the order of the header.
    pub vehicle: usize,
    /// What happened.
    pub event: Event,
}

/// What can happen.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A frame was received.
    Frame(Origin, Frame),
    /// A ground station is heard, or no more: that is judged by the wall clock.
    GroundStation(bool),
    /// The pilot's radio sends these pulses from now on.
    Radio(Pulses),
    /// How a foreign model moves the vehicle in the tick that follows.
    Motion(Vec<f64>),
    /// The digest of the flight so far, to be compared.
    State(u64),
    /// The end of the flight, with its digest.
    End(u64),
    /// The flight went on, but the record has reached its size limit; the digest of the flight so far.
    Limit(u64),
    /// The simulation of the vehicle failed in the tick that follows; the digest of the flight so far.
    Failure(u64),
}

impl Event {
    /// The first word of its line.
    fn word(&self) -> &'static str {
        match self {
            Self::Frame(..) => "frame",
            Self::GroundStation(_) => "station",
            Self::Radio(_) => "radio",
            Self::Motion(_) => "motion",
            Self::State(_) => "state",
            Self::End(_) => "end",
            Self::Limit(_) => "limit",
            Self::Failure(_) => "failure",
        }
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} {} {} ", self.event.word(), self.time_us, self.vehicle)?;
        match &self.event {
            Event::Frame(Origin { peer: PeerId { link, number }, .. }, frame) => {
                write!(formatter, "{link} {number} ")?;
                frame.bytes().iter().try_for_each(|byte| write!(formatter, "{byte:02x}"))
            }
            Event::GroundStation(heard) => write!(formatter, "{}", u8::from(*heard)),
            Event::Radio(pulses) => {
                let words: Vec<String> = pulses.iter().map(u16::to_string).collect();
                formatter.write_str(&words.join(" "))
            }
            Event::Motion(values) => {
                let words: Vec<String> =
                    values.iter().map(|value| format!("{:x}", value.to_bits())).collect();
                formatter.write_str(&words.join(" "))
            }
            Event::State(digest) | Event::End(digest) | Event::Limit(digest) | Event::Failure(digest) => {
                write!(formatter, "{digest:016x}")
            }
        }
    }
}

impl Entry {
    /// Reads the text of a line; `None` if it is not an entry.
    pub fn parse(text: &str) -> Option<Self> {
        let mut words = text.split(' ');
        let word = words.next()?;
        let time_us = words.next()?.parse().ok()?;
        let vehicle = words.next()?.parse().ok()?;
        let mut digest = || u64::from_str_radix(words.next()?, 16).ok();
        let event = match word {
            "frame" => {
                let peer = PeerId { link: words.next()?.parse().ok()?, number: words.next()?.parse().ok()? };
                let frame = Frame::parse(&bytes(words.next()?)?)?;
                let origin = Origin { peer, system: frame.system(), component: frame.component() };
                Event::Frame(origin, frame)
            }
            "station" => match words.next()? {
                "0" => Event::GroundStation(false),
                "1" => Event::GroundStation(true),
                _ => return None,
            },
            "radio" => {
                let read: Vec<u16> = words.by_ref().map(|word| word.parse().ok()).collect::<Option<_>>()?;
                Event::Radio(read.try_into().ok()?)
            }
            "motion" => {
                let value = |word| u64::from_str_radix(word, 16).ok().map(f64::from_bits);
                let values: Vec<f64> = words.by_ref().map(value).collect::<Option<_>>()?;
                Event::Motion(Some(values).filter(|values| !values.is_empty())?)
            }
            "state" => Event::State(digest()?),
            "end" => Event::End(digest()?),
            "limit" => Event::Limit(digest()?),
            "failure" => Event::Failure(digest()?),
            _ => return None,
        };
        words.next().is_none().then_some(Self { time_us, vehicle, event })
    }
}

fn bytes(hex: &str) -> Option<Vec<u8>> {
    let digits = hex.as_bytes();
    let pair = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok();
    if digits.len().is_multiple_of(2) { digits.chunks(2).map(pair).collect() } else { None }
}

#[cfg(test)]
mod tests {
    use super::{Entry, Event, Frame, Origin, PeerId};
    use autopilot::codec::Version;
    use mavlink::dialects::ardupilotmega::{HEARTBEAT_DATA, MavMessage};

    #[test]
    fn motions_keep_every_bit() {
        let values = vec![0.0, -0.0, 1.0 / 3.0, f64::MIN_POSITIVE, -1e300];
        let entry = Entry { time_us: 7_000, vehicle: 0, event: Event::Motion(values.clone()) };
        let text = entry.to_string();
        let Some(Entry { event: Event::Motion(read), .. }) = Entry::parse(&text) else { panic!("{text}") };
        assert_eq!(
            read.iter().map(|value| value.to_bits()).collect::<Vec<_>>(),
            values.iter().map(|value| value.to_bits()).collect::<Vec<_>>()
        );
        for wrong in ["motion 1 0", "motion 1 0 x", "motion 1 0 1 ", "motion 1 0 11111111111111111"] {
            assert_eq!(Entry::parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn entries_read_as_they_are_written_and_nothing_else_does() {
        let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()).into();
        let frame = Frame::encode(&message, Version::Two, 7, (255, 190)).expect("a frame");
        let origin = Origin { peer: PeerId { link: 1, number: 2 }, system: 255, component: 190 };
        for event in [
            Event::Frame(origin, frame),
            Event::GroundStation(true),
            Event::GroundStation(false),
            Event::Radio([1500; 18]),
            Event::State(7),
            Event::End(u64::MAX),
            Event::Limit(0),
            Event::Failure(1),
        ] {
            let entry = Entry { time_us: 250_000, vehicle: 3, event };
            let text = entry.to_string();
            assert_eq!(Entry::parse(&text), Some(entry), "{text}");
            assert_eq!(Entry::parse(&format!("{text} 1")), None);
            assert_eq!(Entry::parse(text.rsplit_once(' ').expect("words").0), None);
        }
        for wrong in
            ["", "end", "end 1 0 x", "fame 1 0 1", "station 1 0 2", "state -1 0 0", "frame 1 0 0 0 fd0"]
        {
            assert_eq!(Entry::parse(wrong), None, "{wrong}");
        }
    }
}
