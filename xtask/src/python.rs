//! The Python environment with the pinned packages.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::failure::Failure;
use crate::files;
use crate::process;
use crate::progress::Progress;
use crate::workspace::Workspace;

/// Name of the file that a finished environment holds: what it was made from.
const MADE_FROM: &str = "made-from.txt";

/// Oldest Python for which the pinned packages exist.
const OLDEST: (u32, u32) = (3, 10);

/// Interpreter of the environment.
pub struct Python {
    program: PathBuf,
}

impl Python {
    /// A command of this interpreter. It opens no window and leaves no compiled files among the sources.
    pub fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command
            .env("MPLBACKEND", "Agg")
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .env("PYTHONUTF8", "1")
            .env_remove("PYTHONPATH")
            .env_remove("PYTHONHOME");
        command
    }
}

/// The environment in target/venv, made anew when the requirements or the interpreter have changed.
pub fn environment(workspace: &Workspace, progress: &Progress) -> Result<Python, Failure> {
    let [requirements, programs] =
        ["requirements.txt", "programs.txt"].map(|name| workspace.python_sources().join(name));
    let (interpreter, version) = interpreter()?;
    let made_from = [
        format!("{interpreter} {version}\n"),
        files::read_text(&requirements)?,
        files::read_text(&programs)?,
    ]
    .concat();

    let folder = workspace.python_environment();
    let program = if cfg!(windows) {
        folder.join("Scripts").join("python.exe")
    } else {
        folder.join("bin").join("python")
    };
    let python = Python { program };
    let marker = folder.join(MADE_FROM);
    if std::fs::read_to_string(&marker).is_ok_and(|made| made == made_from) && works(&python) {
        return Ok(python);
    }

    progress.step("Making the Python environment (once; downloads about 175 MB)");
    files::remove_folder(&folder)?;
    let mut make = Command::new(&interpreter);
    make.args(["-m", "venv"]).arg(&folder);
    if !process::status(&mut make)?.success() {
        return Err(Failure::NoVenv { program: interpreter });
    }
    install(&python, &requirements, &[])?;
    install(&python, &programs, &["--no-deps"])?;
    // Last: an environment that was interrupted is not taken for a finished one.
    files::write(&marker, made_from.as_bytes())?;
    Ok(python)
}

/// Installs pinned packages from a file.
fn install(python: &Python, pinned: &Path, options: &[&str]) -> Result<(), Failure> {
    let mut install = python.command();
    install
        .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input"])
        .arg("--prefer-binary")
        .args(options)
        .arg("--requirement")
        .arg(pinned);
    if process::status(&mut install)?.success() { Ok(()) } else { Err(Failure::Packages) }
}

/// Whether the interpreter still starts; the one it was made from may have been removed.
fn works(python: &Python) -> bool {
    let quiet = python.command().args(["-c", ""]).stdout(Stdio::null()).stderr(Stdio::null()).status();
    quiet.is_ok_and(|status| status.success())
}

/// Name and version of a Python that is new enough and can make environments.
fn interpreter() -> Result<(String, String), Failure> {
    let named = env::var("PYTHON").ok();
    let candidates: Vec<String> = match &named {
        Some(program) => vec![program.clone()],
        None => ["python3", "python"].map(str::to_owned).to_vec(),
    };
    for program in candidates {
        let Some(version) = version_of(&program) else { continue };
        if !new_enough(&version) {
            return Err(Failure::OldPython { program, version });
        }
        // Debian leaves ensurepip out of its python3 package; without it venv cannot bring pip along.
        if !imports(&program, "venv, ensurepip") {
            return Err(Failure::NoVenv { program });
        }
        return Ok((program, version));
    }
    Err(Failure::Missing {
        program: named.unwrap_or_else(|| "python3".to_owned()),
        remedy: "install Python 3.10 or newer with venv and pip (on Debian and Ubuntu: python3-venv), \
                 or name an interpreter in the environment variable PYTHON",
    })
}

fn version_of(program: &str) -> Option<String> {
    let answer = Command::new(program)
        .args(["-c", "import sys; print('%d.%d.%d' % sys.version_info[:3])"])
        .stderr(Stdio::null())
        .output()
        .ok()?;
    // On Windows an absent python may be a stub that succeeds and says nothing.
    let version = String::from_utf8(answer.stdout).ok()?.trim().to_owned();
    (answer.status.success() && !version.is_empty()).then_some(version)
}

fn imports(program: &str, modules: &str) -> bool {
    Command::new(program)
        .args(["-c", &format!("import {modules}")])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

fn new_enough(version: &str) -> bool {
    let mut numbers = version.split('.').map(|number| number.parse::<u32>().unwrap_or(0));
    let (major, minor) = (numbers.next().unwrap_or(0), numbers.next().unwrap_or(0));
    (major, minor) >= OLDEST
}

#[cfg(test)]
mod tests {
    use super::new_enough;

    #[test]
    fn versions_are_compared_as_numbers() {
        assert!(new_enough("3.10.0"));
        assert!(new_enough("3.14.1"));
        assert!(!new_enough("3.9.18"));
        assert!(!new_enough("2.7.18"));
        assert!(!new_enough("unknown"));
    }
}
