//! `cargo xtask fmu` and `cargo xtask model-description`.

use std::path::PathBuf;
use std::process::Command;
use std::thread;

use crate::paths::Paths;
use crate::product::{self, Product, Profile};
use crate::program::{self, BUNDLE, Beside};
use crate::progress::Progress;
use crate::release::Release;
use crate::threads;
use crate::toolchains::Toolchain;
use crate::universal;
use xtask::failure::Failure;
use xtask::platform::Platform;
use xtask::process;
use xtask::workspace::Workspace;

/// A library with the platform that it is for.
pub type Library = (Platform, PathBuf);

/// Builds the FMU for this machine and returns its path. `others` are FMUs of the same sources from other platforms.
pub fn make(
    workspace: &Workspace,
    progress: &Progress,
    others: &[PathBuf],
    beside: Beside,
) -> Result<PathBuf, Failure> {
    let library = || {
        progress.timed("Building the FMU's library", || {
            let toolchain = Toolchain::of_this_machine()?;
            let paths = Paths::find(workspace)?;
            let library =
                product::build(workspace, &toolchain, None, &paths, Product::Library, Profile::Release)?;
            Ok(vec![(toolchain.platform(), library)])
        })
    };
    bundle_beside(workspace, progress, library, others, beside)
}

/// Builds the FMU with binaries that run on any machine of some platforms, and returns its path.
pub fn make_for(
    workspace: &Workspace,
    progress: &Progress,
    release: &Release,
    others: &[PathBuf],
) -> Result<PathBuf, Failure> {
    let libraries = || {
        let libraries = release.build(workspace, progress, Product::Library, Profile::Release)?;
        universal::on_macs(workspace, libraries)
    };
    bundle_beside(workspace, progress, libraries, others, Beside::Nothing)
}

/// Two profiles, which cargo builds at the same time: the chains of dependencies are long, one alone leaves a core idle.
fn bundle_beside(
    workspace: &Workspace,
    progress: &Progress,
    libraries: impl FnOnce() -> Result<Vec<Library>, Failure> + Send,
    others: &[PathBuf],
    beside: Beside,
) -> Result<PathBuf, Failure> {
    let (libraries, bundle) = thread::scope(|scope| {
        let libraries = scope.spawn(libraries);
        let bundle = progress
            .timed("Building the program that bundles it", || program::build(workspace, BUNDLE, beside));
        (threads::join(libraries), bundle)
    });
    let mut command = Command::new(bundle?);
    command.arg("fmu");
    for (platform, library) in libraries? {
        command.arg("--library").arg(format!("{platform}={}", library.display()));
    }
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
