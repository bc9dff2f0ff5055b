//! Programs of the workspace that a task runs.

use std::path::PathBuf;

use xtask::cargo::cargo;
use xtask::failure::Failure;
use xtask::process;
use xtask::workspace::Workspace;

/// Writes the FMU and modelDescription.xml.
pub const BUNDLE: &str = "bundle";
/// The MAVLink vehicle.
pub const VEHICLE: &str = "lmpc-sitl";

/// What is built beside the program. Dependencies get the features of all that is built together, and compile again when these change.
#[derive(Clone, Copy)]
pub enum Beside {
    /// Nothing.
    Nothing,
    /// The tests: after `cargo test --workspace` there is nothing left to compile.
    Tests,
}

/// Builds a program for development and returns its path.
pub fn build(workspace: &Workspace, name: &str, beside: Beside) -> Result<PathBuf, Failure> {
    let mut build = cargo();
    // `--workspace` gives every program's dependencies the same features, so that they compile once for all.
    build.args(["build", "--quiet", "--workspace", "--bin", name]).current_dir(workspace.root());
    if matches!(beside, Beside::Tests) {
        build.arg("--tests");
    }
    process::output(&mut build, &format!("building {name}"))?;
    Ok(workspace.program(name))
}
