//! Writes what is generated from the FMU's model. `cargo xtask` builds and runs it; a program of its own, so that `cargo xtask`
//! starts without waiting for the engine to compile.
//!
//! ```text
//! modelDescription.xml        fmi::description of a model of fmu: product
//! model.png                   fmu/assets
//! binaries/linux64/….so       platform, merge; platform_tuple in FMI 3.0
//! documentation/index.html    documentation ◄─ variables, enumerations, picture
//! terminalsAndIcons/          fmi::description
//! licenses/                   licenses
//! LmpcQuadrotor.ssp           ssp: two of the FMUs, wired
//! ```

mod archive;
mod chart;
mod documentation;
mod enumerations;
mod failure;
mod fmu_file;
mod html;
mod licenses;
mod merge;
mod picture;
mod platform;
mod product;
mod ssp;
mod variables;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand, ValueEnum};

use failure::Failure;
use product::Version;
use xtask::files;
use xtask::platform::Platform;
use xtask::workspace::Workspace;

/// Writes the FMU and its description. Run it through `cargo xtask fmu` and `cargo xtask model-description`.
#[derive(Parser)]
#[command(name = "bundle", disable_help_subcommand = true)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Writes the FMUs into target/fmu, those of FMI 3.0 into target/fmu/fmi3.
    Fmu {
        /// A built library with the platform that it is for; may be repeated.
        #[arg(long, required = true, value_name = "PLATFORM=FILE", value_parser = library)]
        library: Vec<(Platform, PathBuf)>,
        /// An FMU of the same sources, built on another platform, whose binaries are added; may be repeated.
        #[arg(long, value_name = "OTHER.fmu")]
        merge: Vec<PathBuf>,
    },
    /// Rewrites modelDescription.xml at the root of the repository.
    ModelDescription,
    /// Writes the notices of the libraries that are linked into the Python package.
    PackageLicenses {
        /// File to write.
        file: PathBuf,
    },
    /// Writes the notices of the libraries that are linked into the MAVLink vehicle.
    VehicleLicenses {
        /// File to write.
        file: PathBuf,
    },
}

/// Reads `linux64=target/release/libfmu.so`.
fn library(text: &str) -> Result<(Platform, PathBuf), String> {
    let (platform, file) = text.split_once('=').ok_or("expected PLATFORM=FILE")?;
    Ok((Platform::from_str(platform, false)?, PathBuf::from(file)))
}

fn main() -> ExitCode {
    match run(&Arguments::parse().task) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}

fn run(task: &Task) -> Result<(), Failure> {
    let workspace = Workspace::find()?;
    match task {
        Task::Fmu { library, merge } => {
            fmu_file::write_all(&workspace, library, merge)?;
            ssp::write(&workspace)
        }
        Task::PackageLicenses { file } => {
            let notices =
                licenses::of_packages(&workspace, "this package", &["sitl", "fmu", "lmpc-quadrotor-python"])?;
            Ok(files::write(file, notices.as_bytes())?)
        }
        Task::VehicleLicenses { file } => {
            let notices = licenses::of_packages(&workspace, "lmpc-sitl", &["sitl"])?;
            Ok(files::write(file, notices.as_bytes())?)
        }
        Task::ModelDescription => {
            let path = workspace.model_description();
            files::write(&path, product::CLOSED_LOOP.description(Version::Two).as_bytes())?;
            println!("{}", workspace.shown(&path));
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn arguments_are_consistent() {
        super::Arguments::command().debug_assert();
    }
}
