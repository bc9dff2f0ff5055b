//! Flying a record again.

use std::path::Path;
use std::time::{Duration, Instant};

use autopilot::Autopilot;
use vehicle::{TICK_US, Vehicle};

use super::recorded_model::{Motions, RecordedModel};
use super::{Digest, Entry, Event, Header, Reader};
use crate::failure::Failure;
use crate::summary::Flight;
use crate::terminal::set_simulation_time;

/// How often the progress is told.
const TOLD: Duration = Duration::from_secs(2);
/// Ticks between two looks at the wall clock.
const TICKS: u32 = 1000;

/// How the record of a flight ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum RecordEnd {
    /// With the flight.
    Complete,
    /// At the size limit of the record.
    Limit,
    /// With the tick in which the simulation failed.
    Failure,
    /// Before the flight: the program was killed, or its disk was full.
    #[default]
    Cut,
}

/// A flight that was flown again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replayed {
    /// The flight as far as it is recorded; its digest is the recorded one.
    pub flight: Flight,
    /// How its record ends.
    pub end: RecordEnd,
    /// Until when the digests were compared, µs.
    pub verified_us: u64,
}

/// Looks on while a record is flown again.
pub trait Audience {
    /// A vehicle, numbered as in the record, has flown a tick. What it has said is to be taken away.
    fn see(&mut self, vehicle: usize, autopilot: &mut Autopilot);
    /// All vehicles have come to the end of the record.
    fn end(&mut self, _vehicles: &[&Autopilot]) {}
}

/// Nobody looks on.
struct Nobody;

impl Audience for Nobody {
    fn see(&mut self, _vehicle: usize, autopilot: &mut Autopilot) {
        drop(autopilot.take_outgoing());
    }
}

/// Flies every vehicle of a record again, as fast as possible, and compares the flights as far as they are recorded. The whole
/// record is checked first.
///
/// # Errors
/// [`Failure::Differs`] at the first digest that differs, [`Failure::FliesOn`] where only the recorded simulation failed; [`Failure`] when
/// the file cannot be read, is not a record or is damaged.
pub fn replay(path: &Path) -> Result<Vec<Replayed>, Failure> {
    replay_before(path, &mut Nobody)
}

/// The same while somebody looks on.
///
/// # Errors
/// Those of [`replay`].
pub fn replay_before(path: &Path, audience: &mut dyn Audience) -> Result<Vec<Replayed>, Failure> {
    let survey = Survey::of(path)?;
    let mut reader = Reader::open(path)?;
    let header = reader.header().clone();
    let mut flown = header
        .vehicles
        .iter()
        .map(|participant| {
            let (system_id, links) = (participant.system_id, &participant.links);
            let settings = &participant.vehicle;
            let (speed, unix_start_us) = (header.speed, header.unix_start_us);
            let motions = Motions::default();
            let autopilot = match &settings.foreign {
                None => Autopilot::new(settings, system_id, speed, links, unix_start_us)?,
                Some(foreign) => {
                    let model = RecordedModel::new(foreign, &motions);
                    let vehicle = Vehicle::flown_by(settings, Box::new(model))?;
                    Autopilot::of(vehicle, settings, system_id, speed, links, unix_start_us)
                }
            };
            Ok(Flown {
                system_id,
                autopilot,
                motions,
                digest: Digest::default(),
                end: RecordEnd::Cut,
                verified_us: 0,
            })
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    survey.announce(path, &header);
    let mut progress = Progress::new(survey.simulated_us());
    // Somebody may still be writing the file.
    for entry in reader.by_ref().take(survey.entries) {
        let entry = entry?;
        if let Some(flown) = flown.get_mut(entry.vehicle) {
            flown.fly_to(&entry, &mut progress, audience)?;
            flown.take(entry)?;
        }
    }
    audience.end(&flown.iter().map(|flown| &flown.autopilot).collect::<Vec<_>>());
    Ok(flown.into_iter().map(Flown::finish).collect())
}

/// What a record holds.
#[derive(Debug)]
struct Survey {
    entries: usize,
    /// Time of the last entry of each vehicle, µs, and whether its flight is over.
    last: Vec<(u64, bool)>,
}

impl Survey {
    /// Reads all of it.
    fn of(path: &Path) -> Result<Self, Failure> {
        let mut reader = Reader::open(path)?;
        let mut survey = Self { entries: 0, last: vec![(0, false); reader.header().vehicles.len()] };
        while let Some(entry) = reader.next() {
            let entry = entry?;
            let Some((last_us, over)) = survey.last.get_mut(entry.vehicle) else { continue };
            if *over || entry.time_us < *last_us {
                let reason = format!("line {} comes after a later entry of its vehicle", reader.line());
                return Err(Failure::Content { path: path.to_owned(), reason });
            }
            *last_us = entry.time_us;
            *over = matches!(entry.event, Event::End(_) | Event::Limit(_) | Event::Failure(_));
            survey.entries += 1;
        }
        Ok(survey)
    }

    /// Simulation time of all vehicles, µs.
    fn simulated_us(&self) -> u64 {
        self.last.iter().map(|(last_us, _)| last_us).fold(0, |sum, last_us| sum.saturating_add(*last_us))
    }

    fn announce(&self, path: &Path, header: &Header) {
        let longest_us = self.last.iter().map(|(last_us, _)| *last_us).max().unwrap_or(0);
        tracing::info!(
            "replaying {}: {}, {:.3} s, recorded by lmpc-sitl {}",
            path.display(),
            match self.last.len() {
                1 => "1 vehicle".to_owned(),
                many => format!("{many} vehicles"),
            },
            longest_us as f64 / 1e6,
            header.program,
        );
        if self.last.iter().any(|(_, over)| !over) {
            tracing::warn!(
                "the record was cut in line {}: the program was killed, or its disk was full; replaying what there is",
                self.entries + 2
            );
        }
    }
}

/// How far a replay has come.
#[derive(Debug)]
struct Progress {
    all_us: u64,
    done_us: u64,
    told: Instant,
}

impl Progress {
    fn new(all_us: u64) -> Self {
        Self { all_us, done_us: 0, told: Instant::now() }
    }

    /// So much more simulation time, µs. Returns what to tell, if it is time.
    fn add(&mut self, time_us: u64, now: Instant) -> Option<String> {
        self.done_us += time_us;
        if now.saturating_duration_since(self.told) < TOLD {
            return None;
        }
        self.told = now;
        let percent = 100.0 * self.done_us as f64 / self.all_us.max(1) as f64;
        let [done_s, all_s] = [self.done_us, self.all_us].map(|time_us| time_us as f64 / 1e6);
        Some(format!("replayed {done_s:.1} of {all_s:.1} s ({percent:.0} %)"))
    }
}

/// A vehicle that is flown again.
#[derive(Debug)]
struct Flown {
    system_id: u8,
    autopilot: Autopilot,
    /// Those of an FMU that are read ahead of the flight.
    motions: Motions,
    digest: Digest,
    end: RecordEnd,
    verified_us: u64,
}

impl Flown {
    fn fly_to(
        &mut self,
        entry: &Entry,
        progress: &mut Progress,
        audience: &mut dyn Audience,
    ) -> Result<(), Failure> {
        let time_us = entry.time_us;
        while self.autopilot.time_us() + TICK_US <= time_us {
            let begin_us = self.autopilot.time_us();
            for _ in 0..TICKS {
                if self.autopilot.time_us() + TICK_US > time_us {
                    break;
                }
                set_simulation_time(self.autopilot.time_us());
                self.autopilot.tick()?;
                self.digest.update(self.autopilot.vehicle());
                audience.see(entry.vehicle, &mut self.autopilot);
            }
            let flown_us = self.autopilot.time_us() - begin_us;
            if let Some(line) = progress.add(flown_us, Instant::now()) {
                tracing::info!("{line}");
            }
        }
        Ok(())
    }

    fn take(&mut self, entry: Entry) -> Result<(), Failure> {
        match entry.event {
            Event::Frame(origin, frame) => self.autopilot.receive(&origin, &frame),
            Event::GroundStation(heard) => self.autopilot.hear_ground_station(heard),
            Event::Radio(pulses) => self.autopilot.receive_radio(pulses),
            Event::Motion(values) => self.motions.push(values),
            Event::State(digest) => self.compare(entry.time_us, digest)?,
            Event::End(digest) => {
                self.compare(entry.time_us, digest)?;
                self.end = RecordEnd::Complete;
            }
            Event::Limit(digest) => {
                self.compare(entry.time_us, digest)?;
                self.end = RecordEnd::Limit;
            }
            Event::Failure(digest) => {
                self.compare(entry.time_us, digest)?;
                self.fail()?;
            }
        }
        Ok(())
    }

    /// The tick in which the recorded simulation failed.
    fn fail(&mut self) -> Result<(), Failure> {
        let (system_id, time_us) = (self.system_id, self.autopilot.time_us());
        let Err(error) = self.autopilot.tick() else {
            return Err(Failure::FliesOn { system_id, time_us });
        };
        tracing::info!("system {system_id}: {error}");
        self.end = RecordEnd::Failure;
        Ok(())
    }

    fn compare(&mut self, time_us: u64, recorded: u64) -> Result<(), Failure> {
        let (system_id, replayed) = (self.system_id, self.digest.value());
        if replayed != recorded {
            return Err(Failure::Differs { system_id, time_us, recorded, replayed });
        }
        self.verified_us = time_us;
        Ok(())
    }

    fn finish(self) -> Replayed {
        let time_us = self.autopilot.time_us();
        let flight = Flight { system_id: self.system_id, time_us, digest: self.digest.value() };
        Replayed { flight, end: self.end, verified_us: self.verified_us }
    }
}

#[cfg(test)]
mod tests {
    use super::{Duration, Instant, Progress};

    #[test]
    fn progress_is_told_every_two_seconds_of_the_wall_clock() {
        let mut progress = Progress::new(40_000_000);
        let start = Instant::now();
        let after = |ms| start + Duration::from_millis(ms);
        assert_eq!(progress.add(1_000_000, after(1000)), None);
        assert_eq!(progress.add(9_000_000, after(2500)).as_deref(), Some("replayed 10.0 of 40.0 s (25 %)"));
        assert_eq!(progress.add(1_000_000, after(3000)), None);
    }
}
