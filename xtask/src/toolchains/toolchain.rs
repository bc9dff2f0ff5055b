//! Compiler and linker for a platform.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::python::Python;
use xtask::failure::Failure;
use xtask::platform::Platform;
use xtask::workspace::Workspace;

use super::compiler::Compiler;
use super::linker::Linker;
use super::need::Need;

/// Builds for one platform.
pub struct Toolchain {
    platform: Platform,
    linker: Linker,
    /// None: the machine's own target.
    target: Option<&'static str>,
    compiler: Option<Compiler>,
    /// None: where `cargo build` builds.
    folder: Option<PathBuf>,
}

impl Toolchain {
    /// The plain one, for the platform of this machine and its C library.
    pub fn of_this_machine() -> Result<Self, Failure> {
        let platform = Platform::host().ok_or(Failure::UnknownPlatform)?;
        Ok(Self { platform, linker: Linker::System, target: None, compiler: None, folder: None })
    }

    /// The one whose binaries run on any machine of a platform. Parts of it may be missing; see [`Toolchain::needs`].
    pub fn of(workspace: &Workspace, platform: Platform) -> Result<Self, Failure> {
        let host = Platform::host();
        let linker = Linker::on(host, platform)?;
        let is_own = linker == Linker::System && host == Some(platform);
        let target = (!is_own).then(|| platform.target());
        let compiler = match target {
            Some(target) => Compiler::find(workspace, target)?,
            None => None,
        };
        let folder = Some(workspace.platforms().join(platform.fmi2_folder()));
        Ok(Self { platform, linker, target, compiler, folder })
    }

    /// The one whose programs need nothing of a Linux system: the C library is in them. They load no libraries.
    pub fn with_own_c_library(workspace: &Workspace, platform: Platform) -> Result<Self, Failure> {
        let target = platform.static_target().ok_or(Failure::NoImage { platform })?;
        let linker = Linker::on(Platform::host(), platform)?;
        let compiler = Compiler::find(workspace, target)?;
        let folder = Some(workspace.platforms().join(format!("{}-static", platform.fmi2_folder())));
        Ok(Self { platform, linker, target: Some(target), compiler, folder })
    }

    /// What it builds for.
    pub fn platform(&self) -> Platform {
        self.platform
    }

    /// What is missing on this machine.
    pub fn needs(&self) -> Vec<Need> {
        let standard_library = match (self.target, &self.compiler) {
            (Some(target), None) => Some(Need::StandardLibrary(target)),
            _ => None,
        };
        standard_library.into_iter().chain(self.linker.need()).filter(|need| !need.is_met()).collect()
    }

    /// Whether zig links.
    pub fn uses_zig(&self) -> bool {
        self.linker == Linker::Zig
    }

    /// Source of the standard library that is compiled, or may be.
    pub fn standard_source(&self) -> Option<&Path> {
        self.compiler.as_ref().map(|compiler| compiler.source.as_path())
    }

    /// A command of cargo that builds; what, is still to be said.
    pub fn build(&self, workspace: &Workspace, zig: Option<&Python>) -> Command {
        let mut build = self.linker.cargo(workspace, zig, self.target);
        if let Some(compiler) = &self.compiler {
            compiler.apply(&mut build);
        }
        if let Some(folder) = &self.folder {
            build.arg("--target-dir").arg(folder);
        }
        build.current_dir(workspace.root());
        build
    }
}
