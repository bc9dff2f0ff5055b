//! `cargo xtask workflows`.

use std::path::PathBuf;

use crate::progress::Progress;
use crate::python::{self, Packages};
use xtask::failure::Failure;
use xtask::files;
use xtask::process;
use xtask::workspace::Workspace;

/// Folders with workflows: ours, and those of templates.
const FOLDERS: [&str; 2] = [".github/workflows", "examples/ci/.github/workflows"];

/// Checks all workflows with actionlint.
pub fn check(workspace: &Workspace, progress: &Progress) -> Result<(), Failure> {
    let interpreter = python::interpreter()?;
    let python = python::environment(workspace, progress, &interpreter, Packages::Release)?;
    let mut workflows: Vec<PathBuf> = Vec::new();
    for folder in FOLDERS {
        workflows.extend(files::names_in(&workspace.root().join(folder))?);
    }
    // Other checkers that a machine may have are left out, so that it says the same everywhere.
    let mut actionlint = std::process::Command::new(python.program("actionlint"));
    actionlint.args(["-shellcheck=", "-pyflakes="]).args(&workflows).current_dir(workspace.root());
    let status = progress.timed("Checking the workflows", || process::status(&mut actionlint))?;
    if !status.success() {
        return Err(Failure::Ended { what: "checking the workflows".to_owned(), status });
    }
    workflows.iter().for_each(|path| println!("{}", workspace.shown(path)));
    Ok(())
}
