//! A compiler with the standard library of a target, or with its source.

use std::path::{Path, PathBuf};
use std::process::Command;

use xtask::failure::Failure;
use xtask::process;
use xtask::workspace::Workspace;

/// Debian's compiler, which comes with the source of the standard library that belongs to it.
const DEBIAN: &str = "/usr/bin/rustc";

/// A compiler that can build for a target.
pub struct Compiler {
    program: PathBuf,
    /// Where its source of the standard library lies, whose paths nobody wants to see in a library.
    pub source: PathBuf,
    /// Parts of the standard library that are compiled first, if any.
    compiles: Option<&'static str>,
}

impl Compiler {
    /// The first of this project's compiler and Debian's that has the target's standard library; else the first that has its source.
    pub fn find(workspace: &Workspace, target: &str) -> Result<Option<Self>, Failure> {
        let own = std::env::var_os("RUSTC").map_or_else(|| "rustc".into(), PathBuf::from);
        let mut known = Vec::new();
        for program in [own, PathBuf::from(DEBIAN)] {
            if program.is_absolute() && !program.is_file() {
                continue;
            }
            if is_new_enough(&answer(workspace, &program, &["--version"])?) {
                let sysroot = PathBuf::from(answer(workspace, &program, &["--print", "sysroot"])?.trim());
                known.push((program, sysroot.join("lib").join("rustlib")));
            }
        }
        let found = |builds_standard_library| {
            move |(program, libraries): &(PathBuf, PathBuf)| {
                let source = libraries.join("src").join("rust");
                let is_there = if builds_standard_library {
                    source.join("library").join("Cargo.lock").is_file()
                } else {
                    has_standard_library(libraries, target)
                };
                let compiles = builds_standard_library.then(|| parts(target));
                is_there.then(|| Self { program: program.clone(), source, compiles })
            }
        };
        Ok(known.iter().find_map(found(false)).or_else(|| known.iter().find_map(found(true))))
    }

    /// Has a command of cargo use it.
    pub fn apply(&self, build: &mut Command) {
        build.env("RUSTC", &self.program);
        if let Some(parts) = self.compiles {
            // Stable compilers refuse -Z without this. The default features have backtraces, which nobody would see.
            build
                .args([&format!("-Zbuild-std={parts}"), "-Zbuild-std-features=panic-unwind"])
                .env("RUSTC_BOOTSTRAP", "1");
        }
    }
}

/// What there is of the standard library for a target.
fn parts(target: &str) -> &'static str {
    if has_system(target) { "std,panic_unwind" } else { "core,alloc" }
}

/// Whether programs of a target run under an operating system.
fn has_system(target: &str) -> bool {
    !target.contains("-none-")
}

fn answer(workspace: &Workspace, program: &Path, question: &[&str]) -> Result<String, Failure> {
    // rustup chooses a toolchain by the folder.
    let output =
        process::output(Command::new(program).args(question).current_dir(workspace.root()), "the compiler")?;
    Ok(String::from_utf8_lossy(&output).into_owned())
}

fn has_standard_library(libraries: &Path, target: &str) -> bool {
    let library = if has_system(target) { "libstd-" } else { "libcore-" };
    libraries.join(target).join("lib").read_dir().is_ok_and(|mut files| {
        files.any(|file| file.is_ok_and(|file| file.file_name().to_string_lossy().starts_with(library)))
    })
}

/// Whether `rustc 1.96.0 (…)` can compile this workspace.
fn is_new_enough(version: &str) -> bool {
    let number = |text: &str| -> Option<(u32, u32)> {
        let mut parts = text.split('.').map(|part| part.parse().ok());
        Some((parts.next()??, parts.next()??))
    };
    let word = version.split_whitespace().nth(1).unwrap_or_default();
    number(word) >= number(env!("CARGO_PKG_RUST_VERSION")) && number(word).is_some()
}

#[cfg(test)]
mod tests {
    use super::is_new_enough;

    #[test]
    fn a_compiler_must_know_the_language() {
        assert!(is_new_enough("rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball)"));
        assert!(is_new_enough("rustc 1.89.0 (29483883e 2025-08-04)"));
        assert!(!is_new_enough("rustc 1.63.0"));
        assert!(!is_new_enough(""));
    }
}
