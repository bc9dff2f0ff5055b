//! Products for any machine of some platforms.

use std::path::PathBuf;
use std::thread;

use crate::paths::Paths;
use crate::product::{self, Product, Profile};
use crate::progress::Progress;
use crate::python::Python;
use crate::threads;
use crate::toolchains::{self, Need, Toolchain};
use xtask::failure::Failure;
use xtask::platform::Platform;
use xtask::workspace::Workspace;

/// The toolchains of some platforms, with all that they need.
pub struct Release {
    toolchains: Vec<Toolchain>,
    zig: Option<Python>,
    paths: Paths,
}

impl Release {
    /// Finds the toolchains, and installs what is missing if that is asked for; `also` is needed beside them.
    pub fn prepare(
        workspace: &Workspace,
        progress: &Progress,
        platforms: &[Platform],
        also: Vec<Need>,
        install: bool,
    ) -> Result<Self, Failure> {
        Self::with(workspace, progress, also, install, || {
            platforms.iter().map(|platform| Toolchain::of(workspace, *platform)).collect()
        })
    }

    /// The same for programs that need nothing of a Linux system.
    pub fn prepare_static(
        workspace: &Workspace,
        progress: &Progress,
        platforms: &[Platform],
        install: bool,
    ) -> Result<Self, Failure> {
        Self::with(workspace, progress, Vec::new(), install, || {
            let each = |platform: &Platform| Toolchain::with_own_c_library(workspace, *platform);
            platforms.iter().map(each).collect()
        })
    }

    fn with(
        workspace: &Workspace,
        progress: &Progress,
        also: Vec<Need>,
        install: bool,
        find: impl Fn() -> Result<Vec<Toolchain>, Failure>,
    ) -> Result<Self, Failure> {
        let missing = |toolchains: &[Toolchain]| toolchains.iter().flat_map(Toolchain::needs).collect();
        let mut toolchains = find()?;
        let mut needs: Vec<Need> = missing(&toolchains);
        needs.extend(also);
        if !needs.is_empty() {
            toolchains::provide(workspace, progress, needs, install)?;
            toolchains = find()?;
            // Nothing is missing now, unless a package did not bring what it should.
            toolchains::provide(workspace, progress, missing(&toolchains), false)?;
        }
        let zig = if toolchains.iter().any(Toolchain::uses_zig) {
            Some(toolchains::zig_environment(workspace, progress)?)
        } else {
            None
        };
        Ok(Self { toolchains, zig, paths: Paths::find(workspace)? })
    }

    /// The environment with zig, if a platform is linked with it.
    pub fn zig(&self) -> Option<&Python> {
        self.zig.as_ref()
    }

    /// Builds a product for each platform, all at once: each ends with minutes in which its linker keeps one core busy.
    pub fn build(
        &self,
        workspace: &Workspace,
        progress: &Progress,
        product: Product,
        profile: Profile,
    ) -> Result<Vec<(Platform, PathBuf)>, Failure> {
        let build = |toolchain: &Toolchain| {
            let platform = toolchain.platform();
            progress.timed(&format!("Building {product} for {platform}"), || {
                Ok((
                    platform,
                    product::build(workspace, toolchain, self.zig(), &self.paths, product, profile)?,
                ))
            })
        };
        thread::scope(|scope| {
            let running: Vec<_> =
                self.toolchains.iter().map(|toolchain| scope.spawn(move || build(toolchain))).collect();
            // All of them before any error, so that none is left running.
            let results: Vec<_> = running.into_iter().map(threads::join).collect();
            results.into_iter().collect()
        })
    }
}
