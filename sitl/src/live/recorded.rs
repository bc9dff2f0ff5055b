//! `--view-record FILE`: the page without a simulation.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use viewer::{Recording, Viewer};

use super::open_viewer;
use crate::configuration::{Arguments, check_view_record};
use crate::failure::Failure;

/// How often it is looked whether the program shall end.
const REST: Duration = Duration::from_millis(50);
/// Largest file: browsers hold all of it.
const MOST_BYTES: u64 = 1_000_000_000;

/// A page that shows a file, until the program ends.
#[derive(Debug)]
pub struct ShownRecording(Viewer);

/// Serves the file that the arguments name.
///
/// # Errors
/// [`Failure`]: another flag does not go with it, the file cannot be read or is of no kind that the page reads, or the address
/// cannot be used.
pub fn show_recording(arguments: &Arguments, path: &Path) -> Result<ShownRecording, Failure> {
    check_view_record(arguments)?;
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    let wrong = |reason: &str| Failure::Content { path: path.to_owned(), reason: reason.to_owned() };
    if !["ulg", "csv"].iter().any(|known| extension == *known) {
        return Err(wrong("the page reads .ulg and .csv; to fly a record (.lmpc) again, use --replay"));
    }
    let bytes = std::fs::metadata(path).map_err(|source| Failure::read(path, source))?.len();
    if bytes > MOST_BYTES {
        return Err(wrong("larger than 1 GB; open a shorter recording"));
    }
    let recording = Recording::read(path).map_err(|source| Failure::read(path, source))?;
    let address = arguments.view.clone().unwrap_or_default();
    Ok(ShownRecording(open_viewer(&address, Some(recording))?))
}

impl ShownRecording {
    /// What is printed at the start.
    pub fn banner(&self) -> String {
        format!("lmpc-sitl {}: recorded flight at {}", env!("CARGO_PKG_VERSION"), self.url())
    }

    /// The address of the page; there is nothing to command.
    pub fn url(&self) -> String {
        format!("http://{}/", self.0.address())
    }

    /// Serves the page until the program is told to stop.
    pub fn run(self, stop: &AtomicBool) {
        while !stop.load(Ordering::Relaxed) {
            std::thread::sleep(REST);
        }
    }
}
