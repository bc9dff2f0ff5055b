//! From arguments to an ended run.

use std::io::{IsTerminal, Write, stdout};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use tracing_subscriber::EnvFilter;

use crate::configuration::{Arguments, Settings, check_replay, file};
use crate::failure::Failure;
use crate::hil::{HilSettings, Simulator};
use crate::ready;
use crate::record::{RecordEnd, Replayed, replay};
use crate::session::Session;
use crate::signals::stop_on_signals;
use crate::summary::Summary;
use crate::terminal::{LogLines, banner, hil_banner};

/// Does what the arguments say.
///
/// # Errors
/// [`Failure`] that ends the program.
pub fn run(arguments: Arguments) -> Result<(), Failure> {
    let arguments = with_file(arguments)?;
    log_to_stderr(arguments.log.as_deref())?;
    if let Some(path) = &arguments.replay {
        check_replay(&arguments)?;
        replay(path)?.iter().for_each(|replayed| say(&told(replayed)));
        return Ok(());
    }
    let stop = stop_on_signals().map_err(Failure::Signals)?;
    let summary = match &arguments.hil {
        Some(address) => simulate(HilSettings::resolve(&arguments, address)?, &stop)?,
        None => {
            let settings = Settings::resolve(&arguments)?;
            let session = Session::new(settings.clone())?;
            say(banner(&settings, session.fleet()).trim_end());
            log(&settings.notes);
            session.run(&stop)?
        }
    };
    let wall_s = summary.wall.as_secs_f64();
    for flight in summary.flights {
        let simulated_s = flight.time_us as f64 / 1e6;
        say(&format!(
            "system {}: flew {simulated_s:.3} s in {wall_s:.3} s ({:.1} times real time), digest {:016x}",
            flight.system_id,
            simulated_s / wall_s.max(1e-9),
            flight.digest
        ));
    }
    if summary.incomplete.is_empty() { Ok(()) } else { Err(Failure::Incomplete(summary.incomplete)) }
}

/// A line about a replayed flight.
fn told(replayed: &Replayed) -> String {
    let Replayed { flight, end, verified_us } = replayed;
    let end = match end {
        RecordEnd::Complete => "the same flight".to_owned(),
        RecordEnd::Limit => {
            "the same flight as far as it was recorded; the record ends at its size limit".to_owned()
        }
        RecordEnd::Cut => {
            format!("the same flight up to {:.3} s; the record ends early", *verified_us as f64 / 1e6)
        }
    };
    let replayed_s = flight.time_us as f64 / 1e6;
    format!("system {}: replayed {replayed_s:.3} s, digest {:016x}: {end}", flight.system_id, flight.digest)
}

/// The plant for an external autopilot.
fn simulate(settings: HilSettings, stop: &Arc<AtomicBool>) -> Result<Summary, Failure> {
    let ready_file = settings.ready_file.as_deref();
    ready_file.map(ready::forget).transpose()?;
    let simulator = Simulator::open(settings.clone())?;
    ready_file.map(|path| ready::write_address(path, &simulator.address())).transpose()?;
    say(hil_banner(&settings, &simulator.address()).trim_end());
    log(&settings.notes);
    simulator.run(stop)
}

/// The arguments, completed by the configuration file that they name.
fn with_file(arguments: Arguments) -> Result<Arguments, Failure> {
    match &arguments.config {
        Some(path) => file::read(path).map(|file| arguments.or(file)),
        None => Ok(arguments),
    }
}

fn log_to_stderr(filter: Option<&str>) -> Result<(), Failure> {
    let filter = filter.unwrap_or("info");
    let filter = EnvFilter::try_new(filter).map_err(|_| Failure::Value {
        name: "--log".to_owned(),
        reason: format!(
            "`{filter}` is no filter: error, warn, info, debug, trace, off, or TARGET=LEVEL between commas"
        ),
    })?;
    let subscriber = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(|| LogLines)
        .with_target(false)
        .with_ansi(std::io::stderr().is_terminal());
    // Somebody who has set one up already keeps it.
    let _kept = subscriber.try_init();
    Ok(())
}

/// Lines of the log.
fn log(notes: &[String]) {
    notes.iter().for_each(|note| tracing::info!("{note}"));
}

/// A line on the standard output. Whoever has closed it does not want it.
fn say(line: &str) {
    let _closed = writeln!(stdout(), "{line}").and_then(|()| stdout().flush());
}
