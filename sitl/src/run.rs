//! From arguments to an ended run.

use std::io::{Write, stdout};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use vehicle::{Notice, Severity};

use crate::configuration::{Arguments, Settings, file, parameter_list};
use crate::failure::Failure;
use crate::hil::{HilSettings, Simulator};
use crate::ready;
use crate::record::replay;
use crate::session::Session;
use crate::summary::Summary;
use crate::terminal::{banner, hil_banner, start_log};

/// Does what the arguments say.
///
/// # Errors
/// [`Failure`] that ends the program.
pub fn run(arguments: Arguments) -> Result<(), Failure> {
    let arguments = with_file(arguments)?;
    start_log(arguments.log.clone().unwrap_or_default().into());
    if let Some(format) = arguments.list_parameters {
        say(parameter_list(&Settings::resolve(&arguments)?, format).trim_end());
        return Ok(());
    }
    if let Some(path) = &arguments.replay {
        for flight in replay(path)? {
            say(&format!(
                "system {}: replayed {:.3} s, flight digest {:016x}: identical to the recorded flight",
                flight.system_id,
                flight.time_us as f64 / 1e6,
                flight.digest
            ));
        }
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
            "system {}: flew {simulated_s:.3} s in {wall_s:.3} s ({:.1} times real time), flight digest {:016x}",
            flight.system_id,
            simulated_s / wall_s.max(1e-9),
            flight.digest
        ));
    }
    Ok(())
}

/// Simulates the plant for an external autopilot.
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

fn stop_on_signals() -> std::io::Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        // A second one ends the program at once.
        signal_hook::flag::register_conditional_shutdown(signal, 130, Arc::clone(&stop))?;
        signal_hook::flag::register(signal, Arc::clone(&stop))?;
    }
    Ok(stop)
}

/// Logs what the user is told at the start.
fn log(notes: &[Notice]) {
    for Notice { severity, text } in notes {
        match severity {
            Severity::Info => tracing::info!("{text}"),
            Severity::Warning => tracing::warn!("{text}"),
            Severity::Critical | Severity::Error => tracing::error!("{text}"),
        }
    }
}

/// A line on the standard output. Whoever has closed it does not want it.
fn say(line: &str) {
    let _closed = writeln!(stdout(), "{line}").and_then(|()| stdout().flush());
}
