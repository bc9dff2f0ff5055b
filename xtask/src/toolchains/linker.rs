//! What links for a platform.

use std::path::PathBuf;
use std::process::Command;

use crate::progress::Progress;
use crate::python::{self, Packages, Python};
use xtask::cargo::cargo;
use xtask::failure::Failure;
use xtask::platform::Platform;
use xtask::process;
use xtask::workspace::Workspace;

use super::machine::MINGW;
use super::need::Need;

/// The oldest C library that Linux binaries run with: of CentOS 7 and the `manylinux2014` of Python packages.
const OLDEST_GLIBC: &str = "2.17";

/// A linker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Linker {
    /// The one that the compiler takes of itself.
    System,
    /// zig through cargo-zigbuild, which links with the symbols of an old C library.
    Zig,
    /// mingw's.
    MinGw,
}

impl Linker {
    /// What links for a platform on a host.
    pub fn on(host: Option<Platform>, platform: Platform) -> Result<Self, Failure> {
        if platform.is_linux() {
            return Ok(Self::Zig);
        }
        if host == Some(platform) || platform.is_darwin() && host.is_some_and(Platform::is_darwin) {
            return Ok(Self::System);
        }
        if platform.is_darwin() { Err(Failure::OnlyOnMac { platform }) } else { Ok(Self::MinGw) }
    }

    /// What it needs of the machine.
    pub fn need(self) -> Option<Need> {
        (self == Self::MinGw).then_some(Need::MinGw)
    }

    /// The cargo that builds with it, for a target.
    pub fn cargo(self, workspace: &Workspace, zig: Option<&Python>, target: Option<&str>) -> Command {
        let mut build = match zig {
            Some(zig) if self == Self::Zig => zig_build(workspace, zig),
            _ => {
                let mut build = cargo();
                build.arg("build");
                build
            }
        };
        let Some(target) = target else { return build };
        build.arg("--target");
        match self {
            Self::Zig if target.ends_with("musl") => build.arg(target),
            Self::Zig => build.arg(format!("{target}.{OLDEST_GLIBC}")),
            Self::MinGw => build.arg(target).env(linker_variable(target), MINGW),
            Self::System => build.arg(target),
        };
        build
    }
}

/// The environment with zig, created if it is not there.
pub fn zig_environment(workspace: &Workspace, progress: &Progress) -> Result<Python, Failure> {
    python::environment(workspace, progress, &python::interpreter()?, Packages::Zig)
}

/// The licence of musl, the C library in static programs: in the package of zig.
pub fn c_library_notice(zig: &Python) -> Result<PathBuf, Failure> {
    let mut ask = zig.command();
    ask.args(["-c", "import ziglang; print(ziglang.__path__[0])"]);
    let folder = process::output(&mut ask, "asking for the folder of zig")?;
    let folder = PathBuf::from(String::from_utf8_lossy(&folder).trim());
    Ok(folder.join("lib").join("libc").join("musl").join("COPYRIGHT"))
}

fn zig_build(workspace: &Workspace, zig: &Python) -> Command {
    let mut build = Command::new(zig.program("cargo-zigbuild"));
    build.arg("zigbuild");
    // It asks the Python of PATH for zig.
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(zig.programs()).chain(std::env::split_paths(&path));
    if let Ok(path) = std::env::join_paths(folders) {
        build.env("PATH", path);
    }
    let cache = workspace.platforms().join("zig");
    build.env("CARGO_ZIGBUILD_CACHE_DIR", &cache).env("ZIG_GLOBAL_CACHE_DIR", &cache);
    build
}

/// Environment variable by which cargo takes a linker.
fn linker_variable(target: &str) -> String {
    format!("CARGO_TARGET_{}_LINKER", target.replace('-', "_").to_uppercase())
}

#[cfg(test)]
mod tests {
    use xtask::platform::Platform;

    use super::{Linker, linker_variable};

    #[test]
    fn each_platform_has_a_linker_but_darwin_elsewhere() {
        let on_linux = |platform| Linker::on(Some(Platform::X86_64Linux), platform).ok();
        assert_eq!(on_linux(Platform::X86_64Linux), Some(Linker::Zig));
        assert_eq!(on_linux(Platform::Aarch64Linux), Some(Linker::Zig));
        assert_eq!(on_linux(Platform::X86_64Windows), Some(Linker::MinGw));
        assert_eq!(on_linux(Platform::Aarch64Darwin), None);
        let on_mac = |platform| Linker::on(Some(Platform::Aarch64Darwin), platform).ok();
        assert_eq!(on_mac(Platform::X86_64Darwin), Some(Linker::System));
        let on_windows = |platform| Linker::on(Some(Platform::X86_64Windows), platform).ok();
        assert_eq!(on_windows(Platform::X86_64Windows), Some(Linker::System));
    }

    /// As cargo's reference writes it.
    #[test]
    fn the_linker_is_named_by_a_variable() {
        assert_eq!(linker_variable("x86_64-pc-windows-gnu"), "CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER");
    }
}
