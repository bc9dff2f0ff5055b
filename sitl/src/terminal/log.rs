//! The log on the standard error stream.

use std::cell::Cell;
use std::fmt;
use std::io::{Write, stderr};
use std::sync::atomic::{AtomicU64, Ordering};

use tracing::subscriber::NoSubscriber;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::fmt::format::Writer;
use tracing_subscriber::fmt::time::{FormatTime, SystemTime};
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;

use super::live;
use super::screen::has_colours;

/// Simulation time of what happens now, µs. The log belongs to the process, and so does this.
static SIMULATION_TIME_US: AtomicU64 = AtomicU64::new(0);

thread_local! {
    /// Whether this thread does something else.
    static IS_ASIDE: Cell<bool> = const { Cell::new(false) };
}

/// What is logged from now on happens at this simulation time, µs.
pub fn set_simulation_time(time_us: u64) {
    if !IS_ASIDE.get() {
        SIMULATION_TIME_US.store(time_us, Ordering::Relaxed);
    }
}

/// Does on this thread what does not belong to the flight: nothing of it is logged, and its simulation time is not the log's.
pub fn aside<R>(work: impl FnOnce() -> R) -> R {
    IS_ASIDE.set(true);
    let result = tracing::subscriber::with_default(NoSubscriber::default(), work);
    IS_ASIDE.set(false);
    result
}

/// Logs what passes the filter to the standard error stream. A log that is set up already stays.
pub fn start_log(filter: Targets) {
    let lines = tracing_subscriber::fmt::layer()
        .with_timer(Stamp)
        .with_target(false)
        .with_ansi(has_colours())
        .with_writer(|| LogLines);
    let _kept = tracing_subscriber::registry().with(filter).with(lines).try_init();
}

/// Wall clock and simulation time.
#[derive(Clone, Copy, Debug)]
struct Stamp;

impl FormatTime for Stamp {
    fn format_time(&self, writer: &mut Writer<'_>) -> fmt::Result {
        SystemTime.format_time(writer)?;
        let time_us = SIMULATION_TIME_US.load(Ordering::Relaxed);
        write!(writer, " {:9.3}s", time_us as f64 / 1e6)
    }
}

/// A writer of log lines that stand above what follows the flight.
#[derive(Clone, Copy, Debug)]
struct LogLines;

impl Write for LogLines {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        live::write_above(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        // Whoever has closed it does not want it: the flight goes on.
        let _gone = stderr().flush();
        Ok(())
    }
}
