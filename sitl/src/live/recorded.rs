//! `--view-record FILE`: the page without a live flight.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use viewer::{Recording, Viewer, standalone};

use super::film::film;
use super::{open_viewer, table};
use crate::configuration::{Arguments, check_view_page, check_view_record};
use crate::failure::Failure;

/// How often it is looked whether the program shall end.
const REST: Duration = Duration::from_millis(50);
/// Bytes of the largest file that a browser can hold, and of the largest as one text: tables, and a flight within a page, whose text
/// is a third longer.
const LARGEST_FILE: u64 = 1_000_000_000;
const LARGEST_TEXT: u64 = 500_000_000;
const LARGEST_WITHIN: u64 = 375_000_000;

/// A page that shows a file, until the program ends.
#[derive(Debug)]
pub struct ShownRecording(Viewer);

/// Serves the file that the arguments name.
///
/// # Errors
/// [`Failure`]: a flag does not go with it, the file cannot be shown, or the address cannot be used.
pub fn show_recording(arguments: &Arguments, path: &Path) -> Result<ShownRecording, Failure> {
    check_view_record(arguments)?;
    let address = arguments.view.clone().unwrap_or_default();
    Ok(ShownRecording(open_viewer(
        &address,
        Some(recording(path, LARGEST_FILE, "show the log of a shorter flight")?),
    )?))
}

/// Writes a page with a recorded flight.
///
/// # Errors
/// [`Failure`]: a flag does not go with it, the file cannot be shown, or the page cannot be written.
pub fn write_page(arguments: &Arguments, path: &Path, page: &Path) -> Result<(), Failure> {
    check_view_page(arguments)?;
    let content = standalone(&recording(path, LARGEST_WITHIN, "show it with --view-record alone")?);
    std::fs::write(page, content).map_err(|source| Failure::write(page, source))
}

/// A file that the page can open, and how large it may be: `remedy` says what else to do.
fn recording(path: &Path, largest: u64, remedy: &str) -> Result<Recording, Failure> {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    let wrong = |reason: &str| Failure::Content { path: path.to_owned(), reason: reason.to_owned() };
    if extension == "lmpc" {
        return film(path);
    }
    if !["ulg", "csv"].iter().any(|known| extension == *known) {
        return Err(wrong("unknown file type; use a flight log (.ulg), a table (.csv) or a record (.lmpc)"));
    }
    let bytes = std::fs::metadata(path).map_err(|source| Failure::read(path, source))?.len();
    if extension == "csv" {
        check_size(path, bytes, LARGEST_TEXT, "write fewer columns or rows")?;
    }
    check_size(path, bytes, largest, remedy)?;
    let recording = Recording::read(path).map_err(|source| Failure::read(path, source))?;
    if extension == "csv" {
        table::check(&recording.content()).map_err(|reason| wrong(&reason))?;
    }
    Ok(recording)
}

/// Refuses what browsers cannot open.
fn check_size(path: &Path, bytes: u64, most: u64, remedy: &str) -> Result<(), Failure> {
    if bytes <= most {
        return Ok(());
    }
    let [bytes, most] = [bytes, most].map(|bytes| bytes.div_ceil(1_000_000));
    let reason = format!("{bytes} MB is too large: a browser can open at most {most} MB this way; {remedy}");
    Err(Failure::Content { path: path.to_owned(), reason })
}

impl ShownRecording {
    /// What is printed at the start.
    pub fn banner(&self) -> String {
        format!("lmpc-sitl {}: recorded flight at {}", env!("CARGO_PKG_VERSION"), self.url())
    }

    /// The address of the page, with the token that lets it have records replayed.
    pub fn url(&self) -> String {
        self.0.pilot_url()
    }

    /// Serves the page until the program is told to stop.
    pub fn run(self, stop: &AtomicBool) {
        while !stop.load(Ordering::Relaxed) {
            std::thread::sleep(REST);
        }
    }
}
