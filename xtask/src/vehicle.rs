//! The MAVLink vehicle for the demo and the tests.

use std::path::PathBuf;

use crate::cargo::cargo;
use crate::failure::Failure;
use crate::process;
use crate::progress::Progress;
use crate::workspace::Workspace;

/// Builds the vehicle and returns its program. The profile is that of the tests, whose dependencies are shared: the dialect
/// of MAVLink takes minutes to build again.
pub fn build(workspace: &Workspace, progress: &Progress) -> Result<PathBuf, Failure> {
    progress.step("Building the MAVLink vehicle");
    let mut build = cargo();
    build.args(["build", "--package", "sitl"]).current_dir(workspace.root());
    process::output(&mut build, "cargo build")?;
    Ok(workspace.sitl())
}
