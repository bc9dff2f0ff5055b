//! What was done, and what should not have happened.

use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

use sitl::record::Digest;

use super::Options;

/// Growth beyond this in the second half of the time is a leak, kB.
const MOST_GROWTH_KB: u64 = 1024;
/// Violations that are kept.
const MOST_KEPT: usize = 50;

#[derive(Default)]
pub struct Figures {
    vehicles: u8,
    end_us: u64,
    seed: u64,
    wall: Duration,
    pub received: u64,
    pub sent: u64,
    pub lost: u64,
    pub clients: u64,
    pub flights: u64,
    pub missions: u64,
    pub abandoned: u64,
    pub parameter_lists: u64,
    pub parameters_set: u64,
    pub uploads: u64,
    pub downloads: u64,
    pub rests: u64,
    pub farthest_drift_m: f64,
    /// Commands by number and result.
    pub commands: BTreeMap<(u16, u8), u64>,
    /// Resident memory after each tenth of the time, kB.
    memory_kb: Vec<u64>,
    sampled_us: u64,
    /// Digests of everything sent, of the flight log's topics, and of the closed loops' states: equal for equal flights.
    pub messages: Digest,
    pub logged: Digest,
    pub states: Digest,
    pub violations: Vec<String>,
}

impl Figures {
    pub fn new(options: &Options) -> Self {
        Self { vehicles: options.vehicles, end_us: options.end_us, seed: options.seed, ..Self::default() }
    }

    pub fn violation(&mut self, system: u8, time_us: u64, what: impl fmt::Display) {
        if self.violations.len() < MOST_KEPT {
            self.violations.push(format!("system {system} at {:.3} s: {what}", time_us as f64 / 1e6));
        }
    }

    /// Looks at the process, ten times in all.
    pub fn sample_memory(&mut self, time_us: u64) {
        if time_us < self.sampled_us + self.end_us / 10 && time_us < self.end_us {
            return;
        }
        self.sampled_us = time_us;
        self.memory_kb.extend(resident_kb());
    }

    pub fn finish(&mut self, wall: Duration) {
        self.wall = wall;
        // Less than ten minutes is all warm-up.
        if self.end_us >= 600_000_000 {
            self.violations.extend(leak(&self.memory_kb));
        }
    }
}

/// What is wrong with memory that has been looked at in equal times: it grows when everything has been in use.
pub fn leak(memory_kb: &[u64]) -> Option<String> {
    let (warm, last) = (memory_kb.get(memory_kb.len() / 2)?, memory_kb.last()?);
    (*last > warm + MOST_GROWTH_KB).then(|| format!("memory grew from {warm} to {last} kB"))
}

/// Resident memory, where the system tells it.
fn resident_kb() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.trim().trim_end_matches(" kB").trim().parse().ok()
}

impl fmt::Display for Figures {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let simulated_s = self.end_us as f64 / 1e6 * f64::from(self.vehicles);
        let wall_s = self.wall.as_secs_f64();
        writeln!(
            formatter,
            "{} vehicles, {:.2} vehicle-hours in {wall_s:.1} s ({:.0} times real time), seed {}",
            self.vehicles,
            simulated_s / 3600.0,
            simulated_s / wall_s.max(1e-9),
            self.seed
        )?;
        let messages = self.sent + self.received;
        let share = 100.0 * self.lost as f64 / messages.max(1) as f64;
        writeln!(
            formatter,
            "messages: {} to vehicles, {} to clients, {} lost ({share:.2} %)",
            self.sent, self.received, self.lost
        )?;
        writeln!(
            formatter,
            "clients: {}; flights: {} by commands, {} by missions, {} handed over to the next pilot",
            self.clients, self.flights, self.missions, self.abandoned
        )?;
        writeln!(
            formatter,
            "transfers: {} parameter lists, {} parameters set, {} missions up, {} down",
            self.parameter_lists, self.parameters_set, self.uploads, self.downloads
        )?;
        writeln!(
            formatter,
            "digests: messages {:016x}, log {:016x}, states {:016x}",
            self.messages.value(),
            self.logged.value(),
            self.states.value()
        )?;
        let of = |result: u8| -> u64 {
            self.commands.iter().filter(|((_, found), _)| *found == result).map(|(_, count)| count).sum()
        };
        let all: u64 = self.commands.values().sum();
        writeln!(
            formatter,
            "commands: {all} answered, {} accepted, {} refused for the moment, {} denied",
            of(0),
            of(1),
            all - of(0) - of(1)
        )?;
        writeln!(
            formatter,
            "rests: {}, the farthest drift {:.1} mm",
            self.rests,
            1e3 * self.farthest_drift_m
        )?;
        writeln!(formatter, "memory after each tenth of the time: {:?} kB", self.memory_kb)?;
        write!(formatter, "violations: {}", self.violations.len())?;
        self.violations.iter().try_for_each(|violation| write!(formatter, "\n  {violation}"))
    }
}
