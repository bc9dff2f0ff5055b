//! Programs and libraries of the machine.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The linker for Windows.
pub const MINGW: &str = "x86_64-w64-mingw32-gcc";
/// The emulator of 64-bit ARM.
pub const QEMU: &str = "qemu-aarch64";
/// Where Debian's package puts the C library of 64-bit ARM.
pub const ARM_LIBRARIES: &str = "/usr/aarch64-linux-gnu";

/// Where Debian's package puts wine, which is not on PATH.
const DEBIANS_WINE: &str = "/usr/lib/wine/wine64";

/// Where a program lies that PATH leads to.
pub fn find(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let name = format!("{name}{}", std::env::consts::EXE_SUFFIX);
    std::env::split_paths(&path).map(|folder| folder.join(&name)).find(|file| file.is_file())
}

/// Names that a Chromium has; the tests of the live page look for the same.
const CHROMIUMS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// Whether there is a Chromium that starts: some packages only have a note where to get one.
pub fn has_chromium() -> bool {
    let Some(program) = CHROMIUMS.into_iter().find_map(find) else { return false };
    let mut command = Command::new(program);
    command.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Wine, wherever it is.
pub fn wine() -> Option<PathBuf> {
    let debians = || Some(PathBuf::from(DEBIANS_WINE)).filter(|file| file.is_file());
    find("wine64").or_else(|| find("wine")).or_else(debians)
}

/// Whether the C library of 64-bit ARM is there.
pub fn has_arm_libraries() -> bool {
    Path::new(ARM_LIBRARIES).join("lib").join("ld-linux-aarch64.so.1").exists()
}
