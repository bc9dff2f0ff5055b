//! `cargo xtask fmu` and `cargo xtask model-description`.

use std::path::PathBuf;
use std::process::Command;
use std::thread;

use crate::library;
use crate::program::{self, BUNDLE, Beside};
use crate::progress::Progress;
use crate::threads;
use xtask::failure::Failure;
use xtask::process;
use xtask::workspace::Workspace;

/// Builds the FMU and returns its path. `others` are FMUs of the same sources from other platforms.
pub fn make(
    workspace: &Workspace,
    progress: &Progress,
    others: &[PathBuf],
    beside: Beside,
) -> Result<PathBuf, Failure> {
    // Two profiles, which cargo builds at the same time: the chains of dependencies are long, one alone leaves a core idle.
    let (library, bundle) = thread::scope(|scope| {
        let library =
            scope.spawn(|| progress.timed("Building the FMU's library", || library::build(workspace)));
        let bundle = progress
            .timed("Building the program that bundles it", || program::build(workspace, BUNDLE, beside));
        (threads::join(library), bundle)
    });
    let mut command = Command::new(bundle?);
    command.arg("fmu").arg("--library").arg(library?);
    for other in others {
        command.arg("--merge").arg(other);
    }
    progress.timed("Bundling the FMU", || run(&mut command, "bundling the FMU"))?;
    Ok(workspace.fmu())
}

/// Rewrites modelDescription.xml at the root of the repository.
pub fn write_description(workspace: &Workspace, progress: &Progress) -> Result<(), Failure> {
    let bundle = progress.timed("Building the program that writes it", || {
        program::build(workspace, BUNDLE, Beside::Nothing)
    })?;
    run(Command::new(bundle).arg("model-description"), "writing modelDescription.xml")
}

fn run(command: &mut Command, what: &str) -> Result<(), Failure> {
    let status = process::status(command)?;
    if status.success() { Ok(()) } else { Err(Failure::Ended { what: what.to_owned(), status }) }
}
