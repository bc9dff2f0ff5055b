//! `cargo xtask ros2`.

use crate::program::{self, Beside, VEHICLE};
use crate::progress::Progress;
use crate::python::{self, Packages};
use xtask::failure::Failure;
use xtask::process;
use xtask::workspace::Workspace;

/// Installs ROS 2 where nothing else is, and flies the vehicle from there through the bridge of the examples.
pub fn fly(workspace: &Workspace, progress: &Progress) -> Result<(), Failure> {
    let interpreter = python::interpreter()?;
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
