//! Programs of the workspace that a task runs.

use std::path::PathBuf;
use std::process::Command;

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
    built(workspace, name, beside, &mut cargo())
}

/// The same as `.ci/run` compiles it, whatever this machine is set to: the same instructions.
pub fn build_as_in_ci(workspace: &Workspace, name: &str, beside: Beside) -> Result<PathBuf, Failure> {
    built(workspace, name, beside, cargo().env("CARGO_INCREMENTAL", "0").env("CARGO_PROFILE_DEV_DEBUG", "0"))
}

fn built(workspace: &Workspace, name: &str, beside: Beside, build: &mut Command) -> Result<PathBuf, Failure> {
    // `--workspace` gives every program's dependencies the same features, so that they compile once for all.
    build.args(["build", "--quiet", "--workspace", "--bin", name]).current_dir(workspace.root());
    if matches!(beside, Beside::Tests) {
        build.arg("--tests");
    }
    process::output(build, &format!("building {name}"))?;
    Ok(workspace.program(name))
}
