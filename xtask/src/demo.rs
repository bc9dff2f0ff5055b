//! `cargo xtask demo`.

use crate::bundle;
use crate::failure::Failure;
use crate::process;
use crate::progress::Progress;
use crate::python;
use crate::vehicle;
use crate::workspace::Workspace;

/// Exit code with which the script says that a flight missed its goal; Python's own errors have another.
const GOAL_MISSED: i32 = 3;

/// Builds the FMU and the MAVLink vehicle, flies them in FMPy and from pymavlink, and writes tables and plots to target/demo.
pub fn fly(workspace: &Workspace, progress: &Progress) -> Result<(), Failure> {
    // First: what is missing on the machine is said before the long build.
    let python = python::environment(workspace, progress)?;
    let fmu = bundle::make(workspace, progress, &[])?;
    let vehicle = vehicle::build(workspace, progress)?;
    let mut command = python.command();
    command
        .arg(workspace.python_sources().join("demo.py"))
        .arg(&fmu)
        .arg(&vehicle)
        .arg(workspace.demo())
        .arg("--root")
        .arg(workspace.root())
        .arg("--elapsed")
        .arg(progress.elapsed().as_secs_f64().to_string());
    let status = process::status(&mut command)?;
    match status.code() {
        Some(0) => Ok(()),
        Some(GOAL_MISSED) => Err(Failure::GoalMissed),
        _ => Err(Failure::Ended { what: "the demo".to_owned(), status }),
    }
}
