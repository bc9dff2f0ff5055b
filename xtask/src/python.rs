//! The Python environment with the pinned packages.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::progress::Progress;
use xtask::failure::Failure;
use xtask::files;
use xtask::process;
use xtask::workspace::Workspace;

/// Oldest Python for which the pinned packages exist.
const OLDEST: (u32, u32) = (3, 10);

/// A list of pinned packages.
struct Pinned {
    /// File in xtask/python.
    file: &'static str,
    /// Whether the list is complete, so that pip need not look for dependencies.
    complete: bool,
}

/// Packages that are installed together, on top of those before them.
struct Layer {
    /// What is said while it is installed.
    what: &'static str,
    lists: &'static [Pinned],
    /// Name of the file that an environment with this layer holds: what it was made from.
    made_from: &'static str,
}

const LAYERS: [Layer; 3] = [
    Layer {
        what: "Installing Python packages (first time; downloads about 45 MB)",
        lists: &[Pinned { file: "demo.txt", complete: true }],
        made_from: "made-from.txt",
    },
    Layer {
        what: "Installing the tests' Python packages (first time; downloads about 260 MB)",
        lists: &[
            Pinned { file: "requirements.txt", complete: false },
            Pinned { file: "programs.txt", complete: true },
            Pinned { file: "optimum.txt", complete: true },
            Pinned { file: "sweep.txt", complete: true },
        ],
        made_from: "made-from-tests.txt",
    },
    Layer {
        what: "Installing what drives a browser (first time; downloads about 50 MB)",
        lists: &[Pinned { file: "browser.txt", complete: true }],
        made_from: "made-from-browser.txt",
    },
];

/// The book has an environment of its own, which takes seconds.
const BOOK_LAYERS: [Layer; 1] = [Layer {
    what: "Installing the book's Python packages (first time; downloads about 15 MB)",
    lists: &[Pinned { file: "book.txt", complete: true }],
    made_from: "made-from.txt",
}];

/// So has the nonlinear solver, whose packages are the largest.
const OPTIMUM_LAYERS: [Layer; 1] = [Layer {
    what: "Installing the nonlinear solver's Python packages (first time; downloads about 95 MB)",
    lists: &[Pinned { file: "optimum.txt", complete: true }],
    made_from: "made-from.txt",
}];

/// So has the linker for other platforms.
const ZIG_LAYERS: [Layer; 1] = [Layer {
    what: "Installing the linker for other platforms (first time; downloads about 95 MB)",
    lists: &[Pinned { file: "zig.txt", complete: true }],
    made_from: "made-from.txt",
}];

/// The tool that writes the Python package, and the linker with which it runs on old systems.
const WHEEL_LAYERS: [Layer; 2] = [
    Layer {
        what: "Installing the tool that writes the Python package (first time; downloads about 10 MB)",
        lists: &[Pinned { file: "wheel.txt", complete: true }],
        made_from: "made-from.txt",
    },
    Layer {
        what: "Installing the linker for old systems (first time; downloads about 95 MB)",
        lists: &[Pinned { file: "zig.txt", complete: true }],
        made_from: "made-from-zig.txt",
    },
];

/// The benchmark, whose peers are installed on top, as far as they can be.
const BENCH_LAYERS: [Layer; 1] = [Layer {
    what: "Installing the benchmark's Python packages (first time; downloads about 80 MB)",
    lists: &[Pinned { file: "../../bench/python/base.txt", complete: false }],
    made_from: "made-from.txt",
}];

/// What the tests of the installed Python package need beside it.
const PACKAGE_LAYERS: [Layer; 1] = [Layer {
    what: "Installing what the Python package is tested with (first time; downloads about 100 MB)",
    lists: &[Pinned { file: "package.txt", complete: false }],
    made_from: "made-from.txt",
}];

/// ROS 2, for the bridge of the examples.
const ROS2_LAYERS: [Layer; 1] = [Layer {
    what: "Installing ROS 2 (first time; downloads about 70 MB)",
    lists: &[Pinned { file: "ros2.txt", complete: true }],
    made_from: "made-from.txt",
}];

/// What checks workflows and writes bills of materials.
const RELEASE_LAYERS: [Layer; 1] = [Layer {
    what: "Installing the tools of a release (first time; downloads about 8 MB)",
    lists: &[Pinned { file: "release.txt", complete: true }],
    made_from: "made-from.txt",
}];

/// What an environment is for.
#[derive(Clone, Copy)]
pub enum Packages {
    /// The demo's flights and plots.
    Demo,
    /// Also the tests' oracles and clients.
    Tests,
    /// Also what drives a browser.
    BrowserTests,
    /// The book.
    Book,
    /// The optimal flights of the paper's report.
    Optimum,
    /// The benchmark without its peers.
    Bench,
    /// The linker for other platforms.
    Zig,
    /// What writes the Python package for this machine.
    Wheel,
    /// What writes the Python package for any machine of this platform.
    WheelForAll,
    /// The tests of the installed Python package.
    Package,
    /// What checks workflows and writes bills of materials.
    Release,
    /// ROS 2.
    Ros2,
}

impl Packages {
    /// Name of the folder of the environment, all layers that it can have, and how many of them are needed.
    fn environment(self) -> (&'static str, &'static [Layer], usize) {
        match self {
            Self::Demo => ("venv", &LAYERS, 1),
            Self::Tests => ("venv", &LAYERS, 2),
            Self::BrowserTests => ("venv", &LAYERS, 3),
            Self::Book => ("venv-book", &BOOK_LAYERS, 1),
            Self::Optimum => ("venv-optimum", &OPTIMUM_LAYERS, 1),
            Self::Bench => ("venv-bench", &BENCH_LAYERS, 1),
            Self::Zig => ("venv-zig", &ZIG_LAYERS, 1),
            Self::Wheel => ("venv-wheel", &WHEEL_LAYERS, 1),
            Self::WheelForAll => ("venv-wheel", &WHEEL_LAYERS, 2),
            Self::Package => ("venv-package", &PACKAGE_LAYERS, 1),
            Self::Release => ("venv-release", &RELEASE_LAYERS, 1),
            Self::Ros2 => ("venv-ros2", &ROS2_LAYERS, 1),
        }
    }
}

/// A Python of this machine that is new enough and can create environments.
pub struct Interpreter {
    program: String,
    version: String,
}

impl Interpreter {
    /// Its version: three numbers with points between them.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// A command of this interpreter, for scripts that need no packages.
    pub fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.env("PYTHONUTF8", "1").env("PYTHONDONTWRITEBYTECODE", "1");
        command
    }
}

/// Interpreter of the environment.
pub struct Python {
    folder: PathBuf,
}

impl Python {
    /// The folder of the programs that its packages bring.
    pub fn programs(&self) -> PathBuf {
        self.folder.join(if cfg!(windows) { "Scripts" } else { "bin" })
    }

    /// A program of its packages.
    pub fn program(&self, name: &str) -> PathBuf {
        self.programs().join(format!("{name}{}", env::consts::EXE_SUFFIX))
    }

    /// A command of this interpreter. It opens no window and keeps compiled files in the environment, away from the sources.
    pub fn command(&self) -> Command {
        let mut command = Command::new(self.program("python"));
        command
            .env("MPLBACKEND", "Agg")
            .env("PYTHONPYCACHEPREFIX", self.folder.join("compiled"))
            .env("PYTHONUTF8", "1")
            .env_remove("PYTHONDONTWRITEBYTECODE")
            .env_remove("PYTHONPATH")
            .env_remove("PYTHONHOME");
        command
    }

    /// Installs pinned packages.
    fn install(&self, list: &Pinned, sources: &Path) -> Result<(), Failure> {
        let mut install = self.command();
        // Python compiles what is imported, once; all of the packages would take longer than to download them.
        install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input"]);
        install.args(["--prefer-binary", "--no-compile"]);
        if list.complete {
            install.arg("--no-deps");
        }
        install.arg("--requirement").arg(sources.join(list.file));
        if process::status(&mut install)?.success() { Ok(()) } else { Err(Failure::Packages) }
    }

    /// The folder of the environment.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Installs a package with what it needs within the versions of a list, if that is possible; tells whether it was. Options of pip
    /// may follow the package.
    pub fn installs(&self, package: &str, constraint: &Path) -> Result<bool, Failure> {
        let mut install = self.command();
        install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input"]);
        install.args(["--prefer-binary", "--no-compile", "--constraint"]).arg(constraint);
        install.args(package.split_whitespace()).stderr(Stdio::null());
        Ok(process::status(&mut install)?.success())
    }

    /// Installs a wheel with nothing else, in place of the one that is there.
    pub fn install_wheel(&self, wheel: &Path) -> Result<(), Failure> {
        let mut install = self.command();
        install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input"]);
        install.args(["--no-deps", "--no-index", "--force-reinstall"]).arg(wheel);
        if process::status(&mut install)?.success() { Ok(()) } else { Err(Failure::Packages) }
    }

    /// Whether the interpreter still starts; the one it was made from may have been removed.
    fn works(&self) -> bool {
        let quiet = self.command().args(["-c", ""]).stdout(Stdio::null()).stderr(Stdio::null()).status();
        quiet.is_ok_and(|status| status.success())
    }
}

/// The environment with all that `packages` need. It is created anew when the interpreter or a list that it was made
/// from has changed; missing packages are added.
pub fn environment(
    workspace: &Workspace,
    progress: &Progress,
    interpreter: &Interpreter,
    packages: Packages,
) -> Result<Python, Failure> {
    let sources = workspace.python_sources();
    let (name, layers, needed) = packages.environment();
    let mut wanted = Vec::new();
    let mut text = format!("{} {}\n", interpreter.program, interpreter.version);
    for layer in layers {
        for list in layer.lists {
            text.push_str(&files::read_text(&sources.join(list.file))?);
        }
        wanted.push(text.clone());
    }
    let folder = workspace.target(name);
    let python = Python { folder: folder.clone() };
    let found: Vec<Option<String>> =
        layers.iter().map(|layer| std::fs::read_to_string(folder.join(layer.made_from)).ok()).collect();
    let mut installed = up_to_date(&found, &wanted);
    if installed > 0 && !python.works() {
        installed = 0;
    }
    if installed == 0 {
        let what = format!("Creating the Python environment in target/{name}");
        progress.timed(&what, || create(interpreter, &folder))?;
    }
    for (layer, made_from) in layers.iter().zip(&wanted).take(needed).skip(installed) {
        progress
            .timed(layer.what, || layer.lists.iter().try_for_each(|list| python.install(list, &sources)))?;
        // Last: an environment that was interrupted is not taken for a finished one.
        files::write(&folder.join(layer.made_from), made_from.as_bytes())?;
    }
    Ok(python)
}

/// How many layers of an environment can stay: those that are there, unless one was made from something else than is wanted now, which
/// cannot be taken out.
fn up_to_date(found: &[Option<String>], wanted: &[String]) -> usize {
    let there = found.iter().take_while(|found| found.is_some()).count();
    let same =
        found.iter().zip(wanted).all(|(found, wanted)| found.as_ref().is_none_or(|found| found == wanted));
    if same { there } else { 0 }
}

/// Creates an empty environment.
fn create(interpreter: &Interpreter, folder: &Path) -> Result<(), Failure> {
    files::remove_folder(folder)?;
    let mut make = Command::new(&interpreter.program);
    make.args(["-m", "venv"]).arg(folder);
    if process::status(&mut make)?.success() {
        Ok(())
    } else {
        Err(Failure::NoVenv { program: interpreter.program.clone() })
    }
}

/// Finds Python, and says what is missing on the machine.
pub fn interpreter() -> Result<Interpreter, Failure> {
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
        return Ok(Interpreter { program, version });
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
    use super::{new_enough, up_to_date};

    #[test]
    fn an_environment_stays_until_a_list_changes() {
        let wanted = ["demo", "demo tests"].map(str::to_owned);
        let found =
            |layers: [Option<&str>; 2]| up_to_date(&layers.map(|layer| layer.map(str::to_owned)), &wanted);
        assert_eq!(found([None, None]), 0);
        assert_eq!(found([Some("demo"), None]), 1);
        assert_eq!(found([Some("demo"), Some("demo tests")]), 2);
        assert_eq!(found([Some("old"), None]), 0);
        assert_eq!(found([Some("demo"), Some("demo old")]), 0);
        assert_eq!(found([None, Some("demo tests")]), 0);
    }

    #[test]
    fn versions_are_compared_as_numbers() {
        assert!(new_enough("3.10.0"));
        assert!(new_enough("3.14.1"));
        assert!(!new_enough("3.9.18"));
        assert!(!new_enough("2.7.18"));
        assert!(!new_enough("unknown"));
    }
}
