//! `cargo xtask sitl`.

use std::path::PathBuf;

use crate::product::Product;
use crate::program::VEHICLE;
use crate::progress::Progress;
use crate::release::Release;
use xtask::failure::Failure;
use xtask::files;
use xtask::platform::Platform;
use xtask::workspace::Workspace;

/// Builds the vehicle for some platforms and returns the programs, each in a folder that is named after its platform.
pub fn make(
    workspace: &Workspace,
    progress: &Progress,
    release: &Release,
) -> Result<Vec<(Platform, PathBuf)>, Failure> {
    let mut programs = Vec::new();
    for (platform, built) in release.build(workspace, progress, Product::Vehicle)? {
        let folder = workspace.vehicles().join(platform.fmi2_folder());
        let program = folder.join(format!("{VEHICLE}{}", platform.program_suffix()));
        files::create_folder(&folder)?;
        let bytes = files::copy(&built, &program)?;
        println!("{} ({:.1} MB)", workspace.shown(&program), bytes as f64 / 1e6);
        programs.push((platform, program));
    }
    Ok(programs)
}
