//! `cargo xtask paper`.

use std::path::Path;

use crate::cargo::cargo;
use crate::failure::Failure;
use crate::process;
use crate::progress::Progress;
use crate::workspace::Workspace;

/// Computes the paper's results in a release build, because it times the controllers; or designs a controller for the model in a file.
pub fn run(workspace: &Workspace, progress: &Progress, gain: Option<&Path>) -> Result<(), Failure> {
    progress.step("Building the program; the first time takes several minutes");
    let mut command = cargo();
    command.args(["run", "--release", "--package", "paper", "--"]);
    match gain {
        Some(model) => command.arg("--gain").arg(model),
        None => command.arg("--out").arg(workspace.paper()),
    };
    let status = process::status(&mut command)?;
    if status.success() { Ok(()) } else { Err(Failure::Ended { what: "the computation".to_owned(), status }) }
}
