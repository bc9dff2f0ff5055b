//! `cargo xtask sitl`.

use crate::product::{Product, Profile};
use crate::program::VEHICLE;
use crate::progress::Progress;
use crate::release::Release;
use xtask::failure::Failure;
use xtask::files;
use xtask::workspace::Workspace;

/// Builds the vehicle for some platforms, each in a folder that is named after its platform, and prints where and how large.
pub fn make(workspace: &Workspace, progress: &Progress, release: &Release) -> Result<(), Failure> {
    for (platform, built) in release.build(workspace, progress, Product::Vehicle, Profile::Release)? {
        let folder = workspace.vehicles().join(platform.fmi2_folder());
        let program = folder.join(format!("{VEHICLE}{}", platform.program_suffix()));
        files::create_folder(&folder)?;
        let bytes = files::copy(&built, &program)?;
        println!("{} ({:.1} MB)", workspace.shown(&program), bytes as f64 / 1e6);
    }
    Ok(())
}
