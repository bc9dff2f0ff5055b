//! `cargo xtask image`.

use std::process::Command;

use crate::assets::notices;
use crate::product::{Product, Profile};
use crate::progress::Progress;
use crate::python;
use crate::release::Release;
use crate::toolchains;
use xtask::failure::Failure;
use xtask::files;
use xtask::platform::Platform;
use xtask::process;
use xtask::workspace::Workspace;

/// Builds the vehicle with a C library of its own, writes an image for each platform, and prints where and how large. What this machine
/// can run is flown.
pub fn make(
    workspace: &Workspace,
    progress: &Progress,
    platforms: &[Platform],
    install: bool,
    profile: Profile,
) -> Result<(), Failure> {
    // Its scripts need Python alone.
    let interpreter = python::interpreter()?;
    let release = Release::prepare_static(workspace, progress, platforms, install)?;
    // Linux is linked with zig, whose package has the licence.
    let c_library = toolchains::c_library_notice(&toolchains::zig_environment(workspace, progress)?)?;
    let notices = notices(workspace, progress)?;
    for (platform, program) in release.build(workspace, progress, Product::Vehicle, profile)? {
        let (architecture, version) = (platform.container_architecture(), env!("CARGO_PKG_VERSION"));
        let (folder, any_size) = match profile {
            Profile::Release => (workspace.assets(), None),
            Profile::Trial | Profile::Draft => (workspace.platforms(), Some("--any-size")),
        };
        let image = folder.join(format!("lmpc-sitl-{version}-image-{architecture}.tar"));
        let mut write = interpreter.command();
        write.arg(workspace.python_sources().join("image.py")).args(any_size);
        write.arg(&program).args([architecture, version]).arg(&image).arg(&c_library).args(&notices);
        progress.timed("Writing the image", || process::output(&mut write, "writing the image"))?;
        if Some(platform) == Platform::host() {
            let mut flight = Command::new(&program);
            flight.args(["--link", "udpin:127.0.0.1:0", "--speed", "max", "--duration", "20"]);
            progress
                .timed("Flying what is in the image", || process::output(&mut flight, "flying the image"))?;
        }
        let bytes = files::read(&image)?.len();
        println!("{} ({:.1} MB)", workspace.shown(&image), bytes as f64 / 1e6);
    }
    Ok(())
}
