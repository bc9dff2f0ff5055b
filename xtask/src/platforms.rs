//! `cargo xtask platforms`: the FMU and the vehicle are built for other platforms, and run as on these.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;

use crate::fmu;
use crate::product::{Product, Profile};
use crate::progress::Progress;
use crate::python::{self, Packages};
use crate::release::Release;
use crate::toolchains::Emulator;
use xtask::failure::Failure;
use xtask::platform::Platform;
use xtask::process;
use xtask::workspace::Workspace;

/// Platforms whose programs a Linux machine on x86 can build and run. The first of them is what the others are compared with.
pub const CHECKED: [Platform; 3] = [Platform::X86_64Linux, Platform::Aarch64Linux, Platform::X86_64Windows];

/// Builds for the platforms and runs the tests of tests/python/platforms, or only those of the FMU. A machine that cannot is an error,
/// never a silent gap.
pub fn check(
    workspace: &Workspace,
    progress: &Progress,
    platforms: &[Platform],
    install: bool,
    fmu_only: bool,
) -> Result<(), Failure> {
    let interpreter = python::interpreter()?;
    let needs = platforms.iter().flat_map(|platform| Emulator::needs(*platform)).collect();
    let release = Release::prepare(workspace, progress, platforms, needs, install)?;
    let emulators: Vec<(Platform, Emulator)> = platforms
        .iter()
        .map(|platform| {
            let emulator = Emulator::of(workspace, *platform);
            Ok((*platform, emulator.ok_or(Failure::NoEmulator { platform: *platform })?))
        })
        .collect::<Result<_, Failure>>()?;
    // The host that loads the libraries is written in C, and zig compiles C for all platforms.
    let zig = match release.zig() {
        Some(zig) => zig,
        None => &crate::toolchains::zig_environment(workspace, progress)?,
    };
    let fmu = fmu::make_for(workspace, progress, &release, &[])?;
    let programs = if fmu_only {
        Vec::new()
    } else {
        release.build(workspace, progress, Product::Vehicle, Profile::Trial)?
    };
    let python = python::environment(workspace, progress, &interpreter, Packages::Tests)?;

    let mut tests = python.command();
    tests
        .args(["-m", "pytest", "-p", "no:cacheprovider"])
        .arg(workspace.python_tests().join("platforms"))
        .current_dir(workspace.root())
        .env("LMPC_QUADROTOR_FMU", fmu)
        .env("LMPC_QUADROTOR_ZIG", zig.program("python"))
        .env("ZIG_GLOBAL_CACHE_DIR", workspace.platforms().join("zig"))
        .env("LMPC_QUADROTOR_PLATFORMS", names(platforms));
    for (platform, emulator) in &emulators {
        emulated(&mut tests, *platform, emulator);
    }
    if fmu_only {
        tests.args(["-k", "not vehicle"]);
    }
    for (platform, program) in programs {
        tests.env(variable("LMPC_SITL", platform), program);
    }
    let status = progress.timed("Running what was built", || process::status(&mut tests))?;
    progress.print_summary();
    if status.success() { Ok(()) } else { Err(Failure::Tests { failed: "tests of platforms".to_owned() }) }
}

fn names(platforms: &[Platform]) -> String {
    platforms.iter().map(|platform| platform.fmi2_folder()).collect::<Vec<_>>().join(" ")
}

/// `LMPC_SITL_WIN64`.
fn variable(what: &str, platform: Platform) -> String {
    format!("{what}_{}", platform.fmi2_folder().replace('-', "_").to_uppercase())
}

/// Tells the tests what runs programs of a platform: its words, each in a line.
fn emulated(tests: &mut Command, platform: Platform, emulator: &Emulator) {
    let words: Vec<OsString> = emulator.command.iter().map(PathBuf::clone).map(OsString::from).collect();
    tests.env(variable("LMPC_QUADROTOR_EMULATOR", platform), words.join("\n".as_ref()));
    for (name, value) in &emulator.environment {
        tests.env(name, value);
    }
}
