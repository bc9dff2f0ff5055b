//! `cargo xtask ros2`.

use std::env::consts::{ARCH, OS};

use crate::program::{self, Beside, VEHICLE};
use crate::progress::Progress;
use crate::python::{self, Packages};
use xtask::failure::Failure;
use xtask::platform::Platform;
use xtask::process;
use xtask::workspace::Workspace;

/// The only Python that the registry's packages of ROS 2 are for.
const PYTHON: &str = "3.11.";

/// Installs ROS 2 where nothing else is, and flies the vehicle from there through the bridge of the examples.
pub fn fly(workspace: &Workspace, progress: &Progress) -> Result<(), Failure> {
    let interpreter = python::interpreter()?;
    is_packaged_for(Platform::host(), interpreter.version())?;
    let ros = python::environment(workspace, progress, &interpreter, Packages::Ros2)?;
    let python = python::environment(workspace, progress, &interpreter, Packages::Tests)?;
    let sitl = progress
        .timed("Building the MAVLink vehicle", || program::build(workspace, VEHICLE, Beside::Nothing))?;
    let mut test = python.command();
    test.args(["-m", "pytest", "-p", "no:cacheprovider", "-m", "ros2"])
        .arg(workspace.python_tests().join("sitl"))
        .current_dir(workspace.root())
        .env("LMPC_SITL", sitl)
        .env("LMPC_ROS2_PYTHON", ros.program("python"));
    let status = progress.timed("Flying from ROS 2", || process::status(&mut test))?;
    if status.success() { Ok(()) } else { Err(Failure::Tests { failed: "flights from ROS 2".to_owned() }) }
}

/// Whether there are packages for a version of Python on a platform.
fn is_packaged_for(platform: Option<Platform>, version: &str) -> Result<(), Failure> {
    if platform == Some(Platform::X86_64Linux) && version.starts_with(PYTHON) {
        return Ok(());
    }
    Err(Failure::OtherPython {
        what: "ROS 2 Jazzy",
        version: version.to_owned(),
        system: OS,
        architecture: ARCH,
    })
}

#[cfg(test)]
mod tests {
    use super::is_packaged_for;
    use xtask::platform::Platform;

    #[test]
    fn other_machines_and_other_pythons_are_told_what_is_needed() {
        assert!(is_packaged_for(Some(Platform::X86_64Linux), "3.11.7").is_ok());
        for (platform, version) in [
            (Some(Platform::X86_64Linux), "3.12.1"),
            (Some(Platform::X86_64Linux), "3.1.11"),
            (Some(Platform::Aarch64Linux), "3.11.7"),
            (Some(Platform::X86_64Windows), "3.11.7"),
            (None, "3.11.7"),
        ] {
            let said = is_packaged_for(platform, version).expect_err("refused").to_string();
            assert!(said.contains("Python 3.11 on Linux (x86-64)") && said.contains(version), "{said}");
            assert!(said.contains("PYTHON to the path of a Python 3.11"), "{said}");
        }
    }
}
