//! One vehicle among those of a run.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use crate::autopilot::Autopilot;
use crate::failure::Failure;
use crate::parameters::Speed;
use crate::record::{Digest, Participant};

/// A client must hear a heartbeat this often, however slow simulation time is.
const HEARTBEAT: Duration = Duration::from_millis(1_100);

/// A vehicle, what is known of its flight, and where it is reached.
#[derive(Debug)]
pub struct Member {
    pub(super) autopilot: Autopilot,
    pub(super) hub: usize,
    pub(super) last_heartbeat: Instant,
    digest: Digest,
    parameters: Option<PathBuf>,
}

impl Member {
    /// A vehicle that has just started, behind the links of a hub.
    pub(super) fn new(
        participant: &Participant,
        speed: Speed,
        hub: usize,
        parameters: Option<PathBuf>,
        unix_start_us: u64,
    ) -> Result<Self, Failure> {
        let Participant { system_id, links, vehicle } = participant;
        Ok(Self {
            autopilot: Autopilot::new(vehicle, *system_id, speed, links, unix_start_us)?,
            hub,
            last_heartbeat: Instant::now(),
            digest: Digest::default(),
            parameters,
        })
    }

    /// The vehicle with its services.
    pub fn autopilot(&self) -> &Autopilot {
        &self.autopilot
    }

    /// Number of its hub.
    pub fn hub(&self) -> usize {
        self.hub
    }

    /// Its simulation time, µs.
    pub fn time_us(&self) -> u64 {
        self.autopilot.vehicle().time_us()
    }

    /// Digest of its flight so far.
    pub fn digest(&self) -> Digest {
        self.digest
    }

    /// One tick on.
    pub(super) fn tick(&mut self) -> Result<(), Failure> {
        self.autopilot.tick()?;
        self.digest.update(self.autopilot.vehicle());
        Ok(())
    }

    /// Whether its links would look dead, because simulation time is slow.
    pub(super) fn is_silent(&self, now: Instant) -> bool {
        let slow = !matches!(self.autopilot.speed(), Speed::Max);
        slow && now.saturating_duration_since(self.last_heartbeat) > HEARTBEAT
    }

    /// Writes its parameters into their file, if one has changed.
    pub(super) fn save_parameters(&mut self) -> Result<(), Failure> {
        let Some(path) = &self.parameters else { return Ok(()) };
        let Some(text) = self.autopilot.take_changed_parameters() else { return Ok(()) };
        // A crash in between leaves the old file.
        let beside = path.with_extension("new");
        std::fs::write(&beside, text)
            .and_then(|()| std::fs::rename(&beside, path))
            .map_err(|source| Failure::write(path, source))
    }
}
