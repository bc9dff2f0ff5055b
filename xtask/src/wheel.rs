//! `cargo xtask wheel`: the Python package, with what comes with it.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::fmu;
use crate::paths::Paths;
use crate::product::{Product, Profile};
use crate::program::{self, BUNDLE, Beside, VEHICLE};
use crate::progress::Progress;
use crate::python::{self, Interpreter, Packages, Python};
use crate::release::Release;
use crate::toolchains::Toolchain;
use xtask::failure::Failure;
use xtask::files;
use xtask::platform::Platform;
use xtask::process;
use xtask::workspace::Workspace;

/// Folders of the package in which Python keeps what it has compiled.
const COMPILED: [&str; 2] = ["__pycache__", ".mypy_cache"];

/// What the package is built from and for.
struct Package<'a> {
    /// The MAVLink vehicle.
    vehicle: &'a Path,
    /// Where it is put together, a name below the target folder.
    stage: &'a str,
    /// Where the wheel is written.
    wheels: &'a Path,
    beside: Beside,
}

/// Builds the FMUs, the vehicle and the package for any machine of this platform, and prints where it is and how large.
pub fn make(
    workspace: &Workspace,
    progress: &Progress,
    release: &Release,
    host: Platform,
) -> Result<(), Failure> {
    let interpreter = python::interpreter()?;
    fmu::make_for(workspace, progress, release, &[])?;
    let built = release.build(workspace, progress, Product::Vehicle, Profile::Release)?;
    let (_, vehicle) = built.into_iter().next().ok_or(Failure::UnknownPlatform)?;
    let wheels = workspace.wheels();
    let package = Package { vehicle: &vehicle, stage: "wheel", wheels: &wheels, beside: Beside::Nothing };
    let with_zig = release.zig().is_some();
    let packages = if with_zig { Packages::WheelForAll } else { Packages::Wheel };
    let python = python::environment(workspace, progress, &interpreter, packages)?;
    let flags = Paths::find(workspace)?.flags(&Toolchain::of(workspace, host)?);
    let wheel = package.write(workspace, progress, &python, |maturin| {
        maturin.args(["--profile", "release"]).arg("--target-dir");
        maturin.arg(workspace.platforms().join(host.fmi2_folder()));
        if with_zig {
            // The oldest C library that Rust knows.
            maturin.args(["--target", host.target(), "--zig", "--compatibility", "manylinux2014"]);
        }
        maturin.env_remove("RUSTFLAGS").env("CARGO_ENCODED_RUSTFLAGS", &flags);
    })?;
    let bytes = files::read(&wheel)?.len();
    println!("{} ({:.1} MB)", workspace.shown(&wheel), bytes as f64 / 1e6);
    Ok(())
}

/// Builds the package as the tests are built, with the FMUs and the vehicle that there are, and returns its path.
pub fn make_for_tests(
    workspace: &Workspace,
    progress: &Progress,
    interpreter: &Interpreter,
    vehicle: &Path,
    beside: Beside,
) -> Result<PathBuf, Failure> {
    let python = python::environment(workspace, progress, interpreter, Packages::Wheel)?;
    let wheels = workspace.target("wheels-for-tests");
    let package = Package { vehicle, stage: "wheel-for-tests", wheels: &wheels, beside };
    package.write(workspace, progress, &python, |maturin| {
        // With what the tests have compiled: see the feature in the package's Cargo.toml.
        maturin.args(["--profile", "dev", "--compatibility", "linux", "--features", "workspace"]);
        maturin.arg("--target-dir").arg(workspace.target(""));
    })
}

impl Package<'_> {
    /// Puts the package together, has maturin build it with some options, and returns the path of the wheel.
    fn write(
        &self,
        workspace: &Workspace,
        progress: &Progress,
        python: &Python,
        configure: impl FnOnce(&mut Command),
    ) -> Result<PathBuf, Failure> {
        let bundle = progress.timed("Building the program that writes the notices", || {
            program::build(workspace, BUNDLE, self.beside)
        })?;
        let stage = self.stage(workspace, &bundle)?;
        files::remove_folder(self.wheels)?;
        let mut maturin = python.command();
        maturin.args(["-m", "maturin", "build", "--quiet"]).arg("--out").arg(self.wheels);
        // Where maturin looks for zig: as a module of the first `python3` on the PATH.
        let present = std::env::var_os("PATH").unwrap_or_default();
        let folders = std::iter::once(python.programs()).chain(std::env::split_paths(&present));
        if let Ok(path) = std::env::join_paths(folders) {
            maturin.env("PATH", path);
        }
        let cache = workspace.platforms().join("zig");
        maturin.env("CARGO_ZIGBUILD_CACHE_DIR", &cache).env("ZIG_GLOBAL_CACHE_DIR", &cache);
        configure(&mut maturin);
        maturin.current_dir(&stage);
        let status = progress.timed("Building the Python package", || process::status(&mut maturin))?;
        if !status.success() {
            return Err(Failure::Ended { what: "building the Python package".to_owned(), status });
        }
        let wheels = files::names_in(self.wheels)?;
        wheels
            .into_iter()
            .find(|path| path.extension().unwrap_or_default() == "whl")
            .ok_or(Failure::Answer { what: "maturin", detail: "it wrote no wheel".to_owned() })
    }

    /// Copies the sources in Python with all that comes with them into a folder below the target folder.
    fn stage(&self, workspace: &Workspace, bundle: &Path) -> Result<PathBuf, Failure> {
        let (source, stage) = (workspace.python_package(), workspace.target(self.stage));
        files::remove_folder(&stage)?;
        files::copy_folder(&source.join("lmpc_quadrotor"), &stage.join("lmpc_quadrotor"), &COMPILED)?;
        files::copy(&source.join("README.md"), &stage.join("README.md"))?;
        for license in ["LICENSE-MIT", "LICENSE-APACHE"] {
            files::copy(&workspace.root().join(license), &stage.join(license))?;
        }
        let notices =
            process::status(Command::new(bundle).arg("package-licenses").arg(stage.join("THIRD-PARTY.txt")))?;
        if !notices.success() {
            return Err(Failure::Ended { what: "writing the notices".to_owned(), status: notices });
        }
        // The crate stays where its workspace is.
        let manifest = source.join("Cargo.toml").display().to_string();
        let settings = files::read_text(&source.join("pyproject.toml"))?;
        let settings =
            settings.replace("manifest-path = \"Cargo.toml\"", &format!("manifest-path = {manifest:?}"));
        files::write(&stage.join("pyproject.toml"), settings.as_bytes())?;
        files::copy_folder(&workspace.fmus(), &stage.join("lmpc_quadrotor").join("fmu"), &[])?;
        let scripts = stage.join("lmpc_quadrotor.data").join("scripts");
        files::create_folder(&scripts)?;
        files::copy(self.vehicle, &scripts.join(format!("{VEHICLE}{}", std::env::consts::EXE_SUFFIX)))?;
        Ok(stage)
    }
}
