//! `cargo xtask paper`.

use std::path::Path;
use std::process::Command;
use std::thread;

use crate::optimum;
use crate::progress::Progress;
use crate::threads;
use xtask::cargo::cargo;
use xtask::failure::Failure;
use xtask::process;
use xtask::workspace::Workspace;

/// Computes the paper's results in a release build, because it times the controllers; or designs a controller for the model in a file;
/// or compares designs of the shipped loops.
pub fn run(
    workspace: &Workspace,
    progress: &Progress,
    gain: Option<&Path>,
    tune: bool,
) -> Result<(), Failure> {
    progress.note("Building the program; the first time takes several minutes");
    let mut command = program("run");
    command.arg("--");
    if let Some(model) = gain {
        return ended(command.arg("--gain").arg(model));
    }
    if tune {
        return ended(command.arg("--tune"));
    }
    // Nothing else runs while the controllers are timed.
    let optima = thread::scope(|scope| {
        let optima = scope.spawn(|| optimum::find(workspace, progress));
        ended(&mut program("build"))?;
        Ok(threads::join(optima))
    })?;
    command.arg("--out").arg(workspace.paper());
    match optima {
        Ok(file) => {
            command.arg("--optimum").arg(file);
        }
        Err(failure) => progress.note(&format!("No optimal flights in this report: {failure}")),
    }
    ended(&mut command)
}

/// The program of the paper, with a command of cargo.
fn program(task: &str) -> Command {
    let mut command = cargo();
    command.args([task, "--release", "--package", "paper", "--bin", "paper"]);
    command
}

fn ended(command: &mut Command) -> Result<(), Failure> {
    let status = process::status(command)?;
    if status.success() { Ok(()) } else { Err(Failure::Ended { what: "the computation".to_owned(), status }) }
}
