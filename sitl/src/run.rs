//! From arguments to an ended run.

use std::io::{Write, stdout};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use vehicle::{Notice, Severity};

use crate::configuration::{Arguments, Settings, check_replay, file, fmu_listing, parameter_list};
use crate::failure::Failure;
use crate::fleet::Loss;
use crate::hil::{HilSettings, Simulator};
use crate::live::{show_recording, write_page};
use crate::ready;
use crate::record::{RecordEnd, Replayed, replay};
use crate::session::Session;
use crate::signals::stop_on_signals;
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
    if arguments.fmu_check == Some(true) && arguments.replay.is_none() {
        let settings = Settings::resolve(&arguments)?;
        if let (Some(choice), Some(first)) = (&settings.fmu, settings.vehicles.first()) {
            say(fmu_listing(choice, &first.vehicle)?.trim_end());
        }
        return Ok(());
    }
    if let Some(path) = &arguments.replay {
        check_replay(&arguments)?;
        replay(path)?.iter().for_each(|replayed| say(&told(replayed)));
        return Ok(());
    }
    if let Some(page) = &arguments.view_page {
        let path = arguments.view_record.as_deref().ok_or_else(|| Failure::Value {
            name: "--view-page".to_owned(),
            reason: "needs a flight to show; add --view-record FILE".to_owned(),
        })?;
        return write_page(&arguments, path, page);
    }
    if let Some(path) = &arguments.view_record {
        let shown = show_recording(&arguments, path)?;
        let stop = stop_on_signals().map_err(Failure::Signals)?;
        arguments.ready_file.as_deref().map(|file| ready::write_view(file, &shown.url())).transpose()?;
        say(&shown.banner());
        shown.run(&stop);
        return Ok(());
    }
    let stop = stop_on_signals().map_err(Failure::Signals)?;
    let summary = match &arguments.hil {
        Some(address) => simulate(HilSettings::resolve(&arguments, address)?, &stop)?,
        None => {
            let settings = Settings::resolve(&arguments)?;
            let session = Session::new(settings.clone())?;
            say(banner(&settings, session.fleet(), session.pilot_url().as_deref()).trim_end());
            log(&settings.notes);
            session.run(&stop)
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
    outcome(summary.losses, summary.incomplete)
}

/// What the program ends with: a failed simulation goes before incomplete files.
fn outcome(losses: Vec<Loss>, incomplete: Vec<String>) -> Result<(), Failure> {
    if losses.is_empty() {
        return if incomplete.is_empty() { Ok(()) } else { Err(Failure::Incomplete(incomplete)) };
    }
    incomplete.iter().for_each(|lacking| tracing::warn!("{lacking}"));
    Err(Failure::Lost(losses))
}

/// A line about a replayed flight.
fn told(replayed: &Replayed) -> String {
    let Replayed { flight, end, verified_us } = replayed;
    let end = match end {
        RecordEnd::Complete => "the same flight".to_owned(),
        RecordEnd::Failure => "the same flight; its simulation fails there, as recorded".to_owned(),
        RecordEnd::Limit => {
            "the same flight as far as it was recorded; the record ends at its size limit".to_owned()
        }
        RecordEnd::Cut => {
            format!("the same flight up to {:.3} s; the record ends early", *verified_us as f64 / 1e6)
        }
    };
    let replayed_s = flight.time_us as f64 / 1e6;
    format!(
        "system {}: replayed {replayed_s:.3} s, flight digest {:016x}: {end}",
        flight.system_id, flight.digest
    )
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
