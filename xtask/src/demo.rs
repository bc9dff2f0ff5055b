//! `cargo xtask demo`.

use std::path::Path;
use std::thread;

use crate::fmu;
use crate::program::{self, Beside, VEHICLE};
use crate::progress::Progress;
use crate::python::{self, Packages, Python};
use crate::threads;
use xtask::failure::Failure;
use xtask::process;
use xtask::workspace::Workspace;

/// Exit code with which the scripts say that a flight missed its goal; Python's own errors have another.
const GOAL_MISSED: i32 = 3;

/// Builds the FMU and the MAVLink vehicle, flies them in FMPy and from pymavlink, and writes tables, plots and pages to target/demo.
///
/// What is seen first is built first: the FMU, beside the downloads of the Python packages. The vehicle compiles while the FMU flies.
pub fn fly(workspace: &Workspace, progress: &Progress) -> Result<(), Failure> {
    // What is missing on the machine is said before the long build.
    let interpreter = python::interpreter()?;
    if !workspace.fmu().is_file() {
        progress.note("First run: two to three minutes to the first picture, about five in all on two cores; later runs take seconds");
    }
    let (of_fmu, of_vehicle) = thread::scope(|scope| {
        let python = scope.spawn(|| python::environment(workspace, progress, &interpreter, Packages::Demo));
        let fmu = fmu::make(workspace, progress, &[], Beside::Nothing);
        // Both before either's error: the environment is not left half made.
        let python = threads::join(python)?;
        let fmu = fmu?;
        let vehicle = scope.spawn(|| {
            progress
                .timed("Building the MAVLink vehicle", || program::build(workspace, VEHICLE, Beside::Nothing))
        });
        let of_fmu =
            progress.timed("Flying the FMU", || run(workspace, progress, &python, "demo_fmu.py", &fmu));
        let vehicle = threads::join(vehicle)?;
        let of_vehicle = progress.timed("Flying the MAVLink vehicle", || {
            run(workspace, progress, &python, "demo_vehicle.py", &vehicle)
        });
        Ok((of_fmu, of_vehicle))
    })?;
    progress.print_summary();
    of_fmu.and(of_vehicle)
}

/// Runs a script that flies something.
fn run(
    workspace: &Workspace,
    progress: &Progress,
    python: &Python,
    script: &str,
    flown: &Path,
) -> Result<(), Failure> {
    let arguments: [&Path; 3] = [&workspace.python_sources().join(script), flown, &workspace.demo()];
    let status = process::status(
        python
            .command()
            .args(arguments)
            .arg("--root")
            .arg(workspace.root())
            .arg("--elapsed")
            .arg(progress.elapsed().as_secs_f64().to_string()),
    )?;
    match status.code() {
        Some(0) => Ok(()),
        Some(GOAL_MISSED) => Err(Failure::GoalMissed),
        _ => Err(Failure::Ended { what: script.to_owned(), status }),
    }
}
