//! Libraries for both processors of Macs in one file.

use std::path::PathBuf;
use std::process::Command;

use xtask::failure::Failure;
use xtask::files;
use xtask::platform::Platform;
use xtask::process;
use xtask::workspace::Workspace;

/// If both are there, the library for x86 has that for Apple silicon in it: importers on Apple silicon look for it in the folder for
/// x86. Joined by `lipo`, which is where the linker for Macs is.
pub fn on_macs(
    workspace: &Workspace,
    mut libraries: Vec<(Platform, PathBuf)>,
) -> Result<Vec<(Platform, PathBuf)>, Failure> {
    let place = |wanted| libraries.iter().position(|(platform, _)| *platform == wanted);
    let (Some(x86), Some(arm)) = (place(Platform::X86_64Darwin), place(Platform::Aarch64Darwin)) else {
        return Ok(libraries);
    };
    let folder = workspace.platforms().join("universal");
    files::create_folder(&folder)?;
    let universal = folder.join("libfmu.dylib");
    let mut lipo = Command::new("lipo");
    lipo.arg("-create").arg("-output").arg(&universal).args([&libraries[x86].1, &libraries[arm].1]);
    process::output(&mut lipo, "joining the libraries for Macs")?;
    libraries[x86].1 = universal;
    Ok(libraries)
}
