//! `cargo xtask paper`.

use std::path::Path;

use crate::progress::Progress;
use xtask::cargo::cargo;
use xtask::failure::Failure;
use xtask::process;
use xtask::workspace::Workspace;

/// Computes the paper's results in a release build, because it times the controllers; or designs a controller for the model in a file.
pub fn run(workspace: &Workspace, progress: &Progress, gain: Option<&Path>) -> Result<(), Failure> {
    progress.note("Building the program; the first time takes several minutes");
    let mut command = cargo();
    command.args(["run", "--release", "--package", "paper", "--"]);
    match gain {
        Some(model) => command.arg("--gain").arg(model),
        None => command.arg("--out").arg(workspace.paper()),
    };
    let status = process::status(&mut command)?;
    if status.success() { Ok(()) } else { Err(Failure::Ended { what: "the computation".to_owned(), status }) }
}
