//! `cargo xtask book`.

use std::process::Command;

use crate::program::{self, Beside, VEHICLE};
use crate::progress::Progress;
use crate::python::{self, Packages};
use xtask::failure::Failure;
use xtask::files;
use xtask::process;
use xtask::workspace::Workspace;

/// Builds the book into target/book. Every warning is an error: a page that is not in the contents, a link or an anchor that leads nowhere.
pub fn build(workspace: &Workspace, progress: &Progress) -> Result<(), Failure> {
    let interpreter = python::interpreter()?;
    let python = python::environment(workspace, progress, &interpreter, Packages::Book)?;
    let vehicle = progress
        .timed("Building the MAVLink vehicle", || program::build(workspace, VEHICLE, Beside::Nothing))?;
    let mut parameters = Vec::new();
    for autopilot in ["px4", "ardupilot"] {
        let path = workspace.target(&format!("book-parameters-{autopilot}.json"));
        let mut list = Command::new(&vehicle);
        list.args(["--autopilot", autopilot, "--list-parameters=json"]);
        files::write(&path, &process::output(&mut list, "listing the parameters")?)?;
        parameters.push(path);
    }
    let mut command = python.command();
    command
        .args(["-m", "mkdocs", "--quiet", "build", "--strict", "--config-file"])
        .arg(workspace.book().join("mkdocs.yml"))
        .env("LMPC_BOOK_PARAMETERS", &parameters[0])
        .env("LMPC_BOOK_ARDUPILOT_PARAMETERS", &parameters[1])
        // The theme's announcement of its successor is not about the book.
        .env("NO_MKDOCS_2_WARNING", "1");
    let status = progress.timed("Building the book", || process::status(&mut command))?;
    if !status.success() {
        return Err(Failure::Ended { what: "building the book".to_owned(), status });
    }
    println!("{}", workspace.shown(&workspace.target("book").join("index.html")));
    Ok(())
}
