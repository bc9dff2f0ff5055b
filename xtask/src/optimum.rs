//! Optimal flights of the nonlinear solver, for the paper's report.

use std::fs;
use std::path::PathBuf;

use crate::progress::Progress;
use crate::python::{self, Packages};
use xtask::failure::Failure;
use xtask::files;
use xtask::process;
use xtask::workspace::Workspace;

/// The file of optimal flights in the target folder. It is kept until the solver's program or the vehicle's parameters change.
pub fn find(workspace: &Workspace, progress: &Progress) -> Result<PathBuf, Failure> {
    let script = workspace.python_sources().join("optimum.py");
    let (file, made_from) = (workspace.target("optimum.json"), workspace.target("optimum-made-from.txt"));
    let description = workspace.model_description();
    let wanted = format!("{}{}", files::read_text(&script)?, files::read_text(&description)?);
    if file.is_file() && fs::read_to_string(&made_from).is_ok_and(|made_from| made_from == wanted) {
        return Ok(file);
    }
    let interpreter = python::interpreter()?;
    let python = python::environment(workspace, progress, &interpreter, Packages::Optimum)?;
    let mut command = python.command();
    command.arg(&script).arg(&description).arg(&file);
    let status = progress.timed("Solving for optimal flights", || process::status(&mut command))?;
    if !status.success() {
        return Err(Failure::Ended { what: "the nonlinear solver".to_owned(), status });
    }
    // Last: what was interrupted is computed again.
    files::write(&made_from, wanted.as_bytes())?;
    Ok(file)
}
