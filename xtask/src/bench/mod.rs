//! `cargo xtask bench`: builds what is measured, brings peers into an environment of its own, measures all in one run.

mod figures;
mod peers;
mod readme;

use std::path::{Path, PathBuf};
use std::process::Command;

use clap::{Args, ValueEnum};

use crate::fmu;
use crate::program::{Beside, VEHICLE};
use crate::progress::Progress;
use crate::python::{self, Packages, Python};
use xtask::cargo::cargo;
use xtask::failure::Failure;
use xtask::files;
use xtask::process;
use xtask::workspace::Workspace;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Part {
    /// The control step beside solvers of quadratic programs.
    Control,
    /// The engine beside other simulators.
    Engine,
    /// The FMU.
    Fmu,
    /// The MAVLink vehicle.
    Sitl,
    /// Cost against sizes.
    Growth,
}

impl Part {
    fn name(self) -> &'static str {
        match self {
            Self::Control => "control",
            Self::Engine => "engine",
            Self::Fmu => "fmu",
            Self::Sitl => "sitl",
            Self::Growth => "growth",
        }
    }
}

/// How it is measured.
#[derive(Args)]
pub struct Options {
    /// Measures less of everything: for a look, in about two minutes after the build.
    #[arg(long)]
    quick: bool,
    /// Measures the kernels of `cargo bench` first, and includes them.
    #[arg(long, conflicts_with = "quick")]
    all: bool,
    /// Measures only this part; can be repeated.
    #[arg(long, value_name = "PART")]
    only: Vec<Part>,
    /// Builds with this profile of cargo instead of release: `dev` compiles sooner and runs slower.
    #[arg(long, value_name = "PROFILE", default_value = "release")]
    profile: String,
    /// Keeps the results in bench/results and writes README's table of figures from them.
    #[arg(long, conflicts_with = "only")]
    publish: bool,
    /// Measures nothing: writes README's table of figures from bench/results.
    #[arg(long, conflicts_with_all = ["quick", "all", "only", "publish"])]
    table: bool,
    /// Measures nothing: fails if README's table of figures is not what bench/results says.
    #[arg(long, conflicts_with_all = ["quick", "all", "only", "publish", "table"])]
    check: bool,
}

/// Measures, or checks what was measured.
pub fn run(workspace: &Workspace, progress: &Progress, options: &Options) -> Result<(), Failure> {
    if options.check {
        return readme::check(workspace);
    }
    if options.table {
        return readme::write(workspace);
    }
    let (python, absent) = environment(workspace, progress)?;
    let programs = progress
        .timed("Building what is measured; in release the first time takes several minutes", || {
            build(workspace, &options.profile)
        })?;
    let fmu = if options.only.is_empty() || options.only.contains(&Part::Fmu) {
        fmu::make(workspace, progress, &[], Beside::Nothing)?
    } else {
        workspace.fmu()
    };
    if options.all {
        let mut kernels = cargo();
        kernels.args(["bench", "--quiet", "--package", "lmpc", "--package", "quadrotor"]);
        progress.timed("Measuring kernels", || ended(&mut kernels, "cargo bench"))?;
    }
    let out = workspace.target("bench");
    progress
        .timed("Measuring", || measure(workspace, &python, options, (&programs, &fmu), (&absent, &out)))?;
    for file in ["report.html", "report.md", "results.json"] {
        println!("{}", workspace.shown(&out.join(file)));
    }
    if options.publish {
        files::copy(&out.join("results.json"), &readme::results(workspace))?;
        readme::write(workspace)?;
    }
    progress.print_summary();
    Ok(())
}

/// A Python with the peers, and the names of those that cannot be installed.
pub fn environment(workspace: &Workspace, progress: &Progress) -> Result<(Python, Vec<String>), Failure> {
    let interpreter = python::interpreter()?;
    let python = python::environment(workspace, progress, &interpreter, Packages::Bench)?;
    let absent = peers::install(workspace, progress, &python)?;
    Ok((python, absent))
}

/// The programs that measure and are measured: our own, and the vehicle.
fn build(workspace: &Workspace, profile: &str) -> Result<[PathBuf; 2], Failure> {
    let mut build = cargo();
    build.args(["build", "--quiet", "--profile", profile, "--package", "bench", "--package", "sitl"]);
    build.args(["--bin", "bench", "--bin", VEHICLE]).current_dir(workspace.root());
    ended(&mut build, "building what is measured")?;
    let folder = workspace.target(if profile == "dev" { "debug" } else { profile });
    Ok(["bench", VEHICLE].map(|name| folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX))))
}

fn measure(
    workspace: &Workspace,
    python: &Python,
    options: &Options,
    ([program, vehicle], fmu): (&[PathBuf; 2], &Path),
    (absent, out): (&[String], &Path),
) -> Result<(), Failure> {
    let mut command = python.command();
    command.arg(workspace.bench().join("python").join("run.py"));
    command.arg("--program").arg(program).arg("--sitl").arg(vehicle).arg("--fmu").arg(fmu);
    command.arg("--root").arg(workspace.root()).arg("--out").arg(out);
    command.arg("--libraries").arg(workspace.target("bench").join("peers"));
    command.arg("--packages").arg(peers::names(workspace)?.join(",")).arg("--build").arg(&options.profile);
    for name in absent {
        command.arg("--absent").arg(name);
    }
    for part in &options.only {
        command.args(["--only", part.name()]);
    }
    if options.quick {
        command.arg("--quick");
    }
    if options.all {
        command.arg("--criterion").arg(workspace.target("criterion"));
    }
    ended(&mut command, "measuring")
}

fn ended(command: &mut Command, what: &str) -> Result<(), Failure> {
    let status = process::status(command)?;
    if status.success() { Ok(()) } else { Err(Failure::Ended { what: what.to_owned(), status }) }
}
