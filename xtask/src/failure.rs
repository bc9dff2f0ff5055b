//! What can go wrong, each as one line with the remedy.

use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;

use thiserror::Error;

use crate::platform::Platform;

/// Why a task failed.
#[derive(Debug, Error)]
pub enum Failure {
    /// A program is not installed.
    #[error("cannot find {program}: {remedy}")]
    Missing {
        /// Its name.
        program: String,
        /// How to get it.
        remedy: &'static str,
    },
    /// A program could not be started.
    #[error("cannot start {program}: {source}")]
    Start {
        /// Its name.
        program: String,
        /// Why.
        source: io::Error,
    },
    /// A program ended with an error, after saying why.
    #[error("{what} failed ({status}); see its output above")]
    Ended {
        /// What it did.
        what: String,
        /// How it ended.
        status: ExitStatus,
    },
    /// A program answered something else than expected.
    #[error("cannot read the answer of {what}: {detail}")]
    Answer {
        /// What it was asked for.
        what: &'static str,
        /// What is wrong with it.
        detail: String,
    },
    /// Python is too old.
    #[error(
        "{program} is Python {version}; the pinned packages need 3.10 or newer: \
         install a newer one and set the environment variable PYTHON to its path"
    )]
    OldPython {
        /// The interpreter.
        program: String,
        /// Its version.
        version: String,
    },
    /// Some packages are built for one Python on one system.
    #[error(
        "{what} is packaged only for Python 3.11 on Linux (x86-64), but this is Python {version} on {system} ({architecture}): \
         on Linux (x86-64), set the environment variable PYTHON to the path of a Python 3.11 interpreter"
    )]
    OtherPython {
        /// What is in the packages.
        what: &'static str,
        /// Version of the interpreter.
        version: String,
        /// Operating system.
        system: &'static str,
        /// Processor.
        architecture: &'static str,
    },
    /// Python comes without venv or pip.
    #[error(
        "{program} has no venv and pip: on Debian and Ubuntu install python3-venv, elsewhere Python from python.org"
    )]
    NoVenv {
        /// The interpreter.
        program: String,
    },
    /// pip failed, after saying why.
    #[error(
        "cannot install the pinned Python packages; see pip's output above (the first run needs a network)"
    )]
    Packages,
    /// Something is missing on the machine.
    #[error(
        "this machine lacks what the platforms need; install it, or run the command as root with --install:{needs}"
    )]
    Needs {
        /// One line each, with the remedy.
        needs: String,
    },
    /// Apple's linker and frameworks are on Macs only.
    #[error("{platform} is built on a Mac: run this command there, and add its FMU here with --merge")]
    OnlyOnMac {
        /// Which.
        platform: Platform,
    },
    /// Containers are Linux.
    #[error("there are no images for {platform}: use linux64 or aarch64-linux")]
    NoImage {
        /// Which.
        platform: Platform,
    },
    /// Nothing on this machine runs the programs of a platform.
    #[error("programs for {platform} do not run on this machine: leave it out of --platforms")]
    NoEmulator {
        /// Which.
        platform: Platform,
    },
    /// FMI has no name for this machine, or nobody has asked for it.
    #[error(
        "the FMU is not built on this system and processor: use 64-bit Linux, Windows or macOS on x86 or ARM"
    )]
    UnknownPlatform,
    /// A file or folder could not be read or written.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        /// "read", "write", …
        action: &'static str,
        /// Which.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The benchmark's kept figures, or what is written from them, are not as they should be.
    #[error("{file} {detail}")]
    Figures {
        /// The file.
        file: &'static str,
        /// What is wrong with it, and the remedy.
        detail: String,
    },
    /// A demo flight missed its goal, as its table says.
    #[error("a flight missed its goal; see the lines marked MISSED above")]
    GoalMissed,
    /// Work takes more instructions than its reference allows.
    #[error("more than a tenth above the reference: {exceeded}; {remedy}")]
    MoreInstructions {
        /// Which, with both numbers.
        exceeded: String,
        /// What to do.
        remedy: String,
    },
    /// Tests failed, after saying which.
    #[error("{failed} failed; see above")]
    Tests {
        /// The suites.
        failed: String,
    },
}
