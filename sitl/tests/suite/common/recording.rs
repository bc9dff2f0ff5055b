//! A flight that is recorded, and its record.

use autopilot::codec::Message;
use autopilot::envelope::LinkProfile;
use sitl::record::{Digest, Header, Participant, RecordEnd, Recorder, Replayed, replay};
use sitl::{Failure, Flight};
use tempfile::TempDir;
use vehicle::VehicleSettings;
use vehicle::parameters::Speed;

use super::Bench;
use super::seal::sealed;

/// A vehicle whose every received frame goes into a record.
pub struct Recording {
    pub bench: Bench,
    folder: TempDir,
    recorder: Recorder,
    digest: Digest,
}

/// A complete record.
pub struct Record {
    folder: TempDir,
    /// The flight that was recorded.
    pub flight: Flight,
}

const NAME: &str = "flight.record";

impl Recording {
    pub fn of(settings: &VehicleSettings) -> Self {
        // Replays start at another time of the wall clock.
        Self::started_at(settings, 0, 77)
    }

    /// A record with a limit of its size, bytes.
    pub fn limited(settings: &VehicleSettings, most_bytes: u64) -> Self {
        Self::create(settings, 0, 77, most_bytes)
    }

    /// A record that tells a time of the start, µs since 1970, and the time at which it was started.
    pub fn started_at(settings: &VehicleSettings, told_us: u64, start_us: u64) -> Self {
        Self::create(settings, told_us, start_us, u64::MAX)
    }

    fn create(settings: &VehicleSettings, told_us: u64, start_us: u64, most_bytes: u64) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let links = vec![LinkProfile::Ground];
        let participant = Participant { system_id: 1, links, vehicle: settings.clone() };
        let header = Header::new(Speed::Factor(1.0), vec![participant]).started_at(told_us);
        let recorder = Recorder::create(&folder.path().join(NAME), &header, most_bytes).expect("a file");
        let bench = Bench::started_at(settings, start_us);
        Self { bench, folder, recorder, digest: Digest::default() }
    }

    pub fn send(&mut self, message: impl Into<Message>) {
        let frame = self.bench.frame(message);
        let time_us = self.bench.autopilot.vehicle().time_us();
        self.recorder.frame(0, time_us, &Bench::origin(), &frame);
        self.bench.receive(&frame);
    }

    /// One millisecond.
    pub fn step(&mut self) {
        self.bench.fly(0.001);
        self.digest.update(self.bench.autopilot.vehicle());
    }

    /// The digest so far goes into the record.
    pub fn note_state(&mut self) {
        self.recorder.state(0, self.bench.autopilot.vehicle().time_us(), self.digest);
    }

    /// Stops the record if it is full.
    pub fn stop_if_full(&mut self) -> bool {
        let full = self.recorder.is_full();
        if full {
            let time_us = self.bench.autopilot.vehicle().time_us();
            self.recorder.stop(std::iter::once((0, time_us, self.digest)));
        }
        full
    }

    pub fn finish(mut self) -> Record {
        let time_us = self.bench.autopilot.vehicle().time_us();
        self.recorder.end(0, time_us, self.digest);
        assert_eq!(self.recorder.finish(), None);
        let flight = Flight { system_id: 1, time_us, digest: self.digest.value() };
        Record { folder: self.folder, flight }
    }
}

impl Record {
    pub fn text(&self) -> String {
        std::fs::read_to_string(self.folder.path().join(NAME)).expect("readable")
    }

    /// Fails unless the replayed flight is the recorded one, bit for bit.
    pub fn assert_same(&self) {
        let replayed = replay(&self.folder.path().join(NAME)).expect("the same flight");
        let verified_us = self.flight.time_us;
        assert_eq!(replayed, [Replayed { flight: self.flight, end: RecordEnd::Complete, verified_us }]);
    }

    /// Replays another text in place of the record.
    pub fn replay_text(&self, text: &str) -> Result<Vec<Replayed>, Failure> {
        let path = self.folder.path().join("changed.record");
        std::fs::write(&path, text).expect("written");
        replay(&path)
    }

    /// Replays the record with one text in it replaced by another, and its checksums made right.
    pub fn changed(&self, from: &str, to: &str) -> Result<Vec<Replayed>, Failure> {
        let text = self.text();
        assert!(text.contains(from), "the record has no `{from}`");
        self.replay_text(&sealed(&text.replacen(from, to, 1)))
    }

    /// Fails unless such a change makes another flight.
    pub fn assert_depends_on(&self, from: &str, to: &str) {
        let replayed = self.changed(from, to);
        assert!(matches!(replayed, Err(Failure::Differs { .. })), "{from}: {replayed:?}");
    }
}
