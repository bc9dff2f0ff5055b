//! What a platform needs of the machine, and how it gets there.

use std::process::{Command, Stdio};

use crate::progress::Progress;
use xtask::failure::Failure;
use xtask::workspace::Workspace;

use super::compiler::Compiler;
use super::debian;
use super::machine::{self, ARM_LIBRARIES, MINGW, QEMU};

/// A thing that may be missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Need {
    /// The standard library of a target, or a compiler with its source.
    StandardLibrary(&'static str),
    /// The linker for Windows.
    MinGw,
    /// What runs programs of Windows.
    Wine,
    /// What runs programs of 64-bit ARM.
    Qemu,
    /// The C library that these want.
    ArmLibraries,
    /// The browser that the tests of the live page drive.
    Chromium,
}

impl Need {
    /// Whether it is there. Of a standard library only a compiler knows.
    pub fn is_met(self) -> bool {
        match self {
            Self::StandardLibrary(_) => false,
            Self::MinGw => machine::find(MINGW).is_some(),
            Self::Wine => machine::wine().is_some(),
            Self::Qemu => machine::find(QEMU).is_some(),
            Self::ArmLibraries => machine::has_arm_libraries(),
            Self::Chromium => machine::has_chromium(),
        }
    }

    /// Debian's packages with it.
    fn packages(self) -> &'static [&'static str] {
        match self {
            Self::StandardLibrary(_) => &["rustc-web", "rust-web-src"],
            Self::MinGw => &["gcc-mingw-w64-x86-64-win32"],
            Self::Wine => &["wine64"],
            Self::Qemu => &["qemu-user"],
            Self::ArmLibraries => &["libc6-arm64-cross"],
            Self::Chromium => &["chromium"],
        }
    }

    /// What it is, and what to type.
    pub fn remedy(self) -> String {
        let apt = format!("apt-get install {}", self.packages().join(" "));
        match self {
            Self::StandardLibrary(target) => format!(
                "Rust's standard library for {target}: rustup target add {target} (without rustup, on Debian: {apt})"
            ),
            Self::MinGw => format!("the linker {MINGW}: {apt}"),
            Self::Wine => format!("wine, which runs programs of Windows: {apt}"),
            Self::Qemu => format!("{QEMU}, which runs programs of 64-bit ARM: {apt}"),
            Self::ArmLibraries => format!("the C library of 64-bit ARM in {}: {apt}", ARM_LIBRARIES),
            Self::Chromium => format!("a Chromium on PATH: {apt}"),
        }
    }

    /// What rustup can give, it gives.
    fn is_met_by_rustup(self, workspace: &Workspace, progress: &Progress) -> bool {
        let Self::StandardLibrary(target) = self else { return false };
        if machine::find("rustup").is_none() {
            return false;
        }
        let what = format!("Installing Rust's standard library for {target}: rustup target add {target}");
        // If it fails, Debian's packages are tried, or named.
        let added = progress.timed(&what, || {
            let mut command = Command::new("rustup");
            command.args(["target", "add", target]).current_dir(workspace.root());
            command.stdout(Stdio::null()).stderr(Stdio::null()).status()
        });
        added.is_ok_and(|status| status.success())
            && Compiler::find(workspace, target).is_ok_and(|compiler| compiler.is_some())
    }
}

/// Installs what is missing if that is asked for, and fails with what to do if something is still missing.
pub fn provide(
    workspace: &Workspace,
    progress: &Progress,
    mut missing: Vec<Need>,
    install: bool,
) -> Result<(), Failure> {
    missing.sort();
    missing.dedup();
    if install {
        missing.retain(|need| !need.is_met_by_rustup(workspace, progress));
        if !missing.is_empty() && debian::can_install() {
            let mut packages: Vec<_> = missing.iter().flat_map(|need| need.packages()).copied().collect();
            packages.sort_unstable();
            packages.dedup();
            return debian::install(progress, &packages);
        }
    }
    if missing.is_empty() {
        return Ok(());
    }
    let needs = missing.iter().map(|need| format!("\n  {}", need.remedy())).collect();
    Err(Failure::Needs { needs })
}

#[cfg(test)]
mod tests {
    use super::Need;

    #[test]
    fn a_remedy_says_what_to_type() {
        let remedy = Need::StandardLibrary("x86_64-pc-windows-gnu").remedy();
        assert!(remedy.contains("rustup target add x86_64-pc-windows-gnu"), "{remedy}");
        assert!(Need::Wine.remedy().ends_with("apt-get install wine64"));
    }
}
