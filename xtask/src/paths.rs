//! Paths of the machine that builds, which nobody wants to see in what is built.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::toolchains::Toolchain;
use xtask::cargo::metadata_with_dependencies;
use xtask::failure::Failure;
use xtask::workspace::Workspace;

/// Folders of sources, each with the name that panics show instead: where they lie differs from machine to machine, and is nobody's
/// business.
pub struct Paths {
    shown: Vec<(PathBuf, &'static str)>,
}

impl Paths {
    /// Asks cargo where the sources are.
    pub fn find(workspace: &Workspace) -> Result<Self, Failure> {
        let mut crates: Vec<PathBuf> = metadata_with_dependencies()?
            .packages
            .iter()
            .filter(|package| package.source.is_some())
            .filter_map(|package| Some(package.manifest_path.parent()?.parent()?.to_owned()))
            .collect();
        crates.sort();
        crates.dedup();
        let own = (workspace.root().to_owned(), "lmpc-quadrotor");
        Ok(Self {
            shown: std::iter::once(own).chain(crates.into_iter().map(|folder| (folder, "crates"))).collect(),
        })
    }

    /// The caller's compiler flags, and those that replace the paths, as `CARGO_ENCODED_RUSTFLAGS` takes them.
    pub fn flags(&self, toolchain: &Toolchain) -> OsString {
        const SEPARATOR: &str = "\u{1f}";
        let callers = match std::env::var("CARGO_ENCODED_RUSTFLAGS") {
            Ok(encoded) => encoded.split(SEPARATOR).map(OsString::from).collect(),
            Err(_) => {
                let plain = std::env::var("RUSTFLAGS").unwrap_or_default();
                plain.split_whitespace().map(OsString::from).collect::<Vec<_>>()
            }
        };
        let own = self.shown.iter().map(|(folder, name)| (folder.as_path(), *name));
        let standard_library = toolchain.standard_source().map(|source| (source, "rust"));
        let remapped = own.chain(standard_library).map(|(folder, name)| remap(folder, name));
        let flags: Vec<OsString> =
            callers.into_iter().filter(|flag| !flag.is_empty()).chain(remapped).collect();
        flags.join(SEPARATOR.as_ref())
    }
}

fn remap(from: &Path, to: &str) -> OsString {
    let mut flag = OsString::from("--remap-path-prefix=");
    flag.push(from);
    flag.push("=");
    flag.push(to);
    flag
}

#[cfg(test)]
mod tests {
    use super::{Paths, remap};
    use crate::toolchains::Toolchain;
    use xtask::workspace::Workspace;

    #[test]
    fn the_workspace_and_the_registry_are_renamed() {
        let workspace = Workspace::find().expect("cargo knows the workspace");
        let paths = Paths::find(&workspace).expect("cargo knows the dependencies");
        let toolchain = Toolchain::of_this_machine().expect("a known platform");
        let flags = paths.flags(&toolchain).into_string().expect("text");
        let flags: Vec<&str> = flags.split('\u{1f}').collect();
        let own = remap(workspace.root(), "lmpc-quadrotor").into_string().expect("text");
        assert!(flags.contains(&own.as_str()), "{flags:?}");
        assert!(flags.iter().any(|flag| flag.ends_with("=crates")), "{flags:?}");
    }
}
