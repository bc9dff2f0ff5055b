//! Writes the page of the book that compares this vehicle with PX4 and ArduPilot: `cargo run -p autopilot --example compatibility`.

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../book/src/vehicle/compatibility.md");
    match std::fs::write(&page, autopilot::compatibility::page()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: cannot write {}: {error}", page.display());
            ExitCode::FAILURE
        }
    }
}
