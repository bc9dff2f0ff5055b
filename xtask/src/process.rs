//! Running other programs.

use std::io::ErrorKind;
use std::process::{Command, ExitStatus, Output, Stdio};

use crate::failure::Failure;

/// Runs a program whose output goes to the terminal, and tells how it ended.
///
/// # Errors
///
/// If the program does not start.
pub fn status(command: &mut Command) -> Result<ExitStatus, Failure> {
    command.status().map_err(|source| not_started(command, source))
}

/// Runs a program and collects its standard output; its errors go to the terminal.
///
/// # Errors
///
/// If the program does not start, or fails.
pub fn output(command: &mut Command, what: &str) -> Result<Vec<u8>, Failure> {
    let Output { status, stdout, .. } =
        command.stderr(Stdio::inherit()).output().map_err(|source| not_started(command, source))?;
    if status.success() { Ok(stdout) } else { Err(Failure::Ended { what: what.to_owned(), status }) }
}

/// Why a program did not start.
pub fn not_started(command: &Command, source: std::io::Error) -> Failure {
    let program = command.get_program().to_string_lossy().into_owned();
    if source.kind() == ErrorKind::NotFound {
        Failure::Missing { program, remedy: "install it or add its folder to PATH" }
    } else {
        Failure::Start { program, source }
    }
}
