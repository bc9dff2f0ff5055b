//! The place of a library in an FMU, which depends on the platform.

use crate::failure::Failure;

/// `binaries/<platform>/<identifier>.<extension>` for this machine and the model with this identifier.
pub fn entry(identifier: &str) -> Result<String, Failure> {
    use std::env::consts::{ARCH, DLL_EXTENSION, OS};
    let platform = match (OS, cfg!(target_pointer_width = "64")) {
        ("linux", true) => "linux64",
        ("linux", false) => "linux32",
        ("windows", true) => "win64",
        ("windows", false) => "win32",
        ("macos", true) => "darwin64",
        _ => return Err(Failure::Platform { os: OS, architecture: ARCH }),
    };
    Ok(format!("binaries/{platform}/{identifier}.{DLL_EXTENSION}"))
}
