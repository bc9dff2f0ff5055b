//! Times the controllers, the engine and the FMU, and writes figures as JSON: a program that `cargo xtask bench` runs several times.
//!
//! ```text
//! programs ─► the shipped programs along flights, for solvers in Python      control ─► ours and solvers in C, sample by sample
//! search   ─► the state that takes each solver the longest                   growth  ─► cost against the size of a program
//! engine   ─► the closed loop and the plant                                  fmu     ─► an FMU, step by step
//! recording ─► the shipped controllers with flights, as a microcontroller reads them
//! ```

mod adversary;
mod clarabel_solver;
mod control;
mod engine;
mod flight;
mod fmu;
mod growth;
mod median;
mod peer;
mod pick;
mod program;
mod recording;
mod reference;
mod shipped;
mod solver;
mod stopwatch;

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use serde::Serialize;

/// What went wrong; it is told once, at the end.
type Failure = Box<dyn Error>;

/// Times the controllers, the engine and the FMU; `cargo xtask bench` runs it.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
    /// File that the figures are written into (JSON)
    #[arg(long, global = true, default_value = "figures.json")]
    out: PathBuf,
    /// Seed of the order in which things are measured
    #[arg(long, global = true, default_value_t = 1)]
    seed: u64,
    /// Measures less of everything
    #[arg(long, global = true)]
    quick: bool,
}

#[derive(Subcommand)]
enum Task {
    /// Writes the shipped programs along flights
    Programs,
    /// Times ours and peers on each sample of these flights
    Control {
        /// Libraries with peers, as `bench/peers/peer.h` describes them; can be repeated
        #[arg(long)]
        peer: Vec<PathBuf>,
        /// Compares solutions with the reference, too
        #[arg(long)]
        judge: bool,
    },
    /// Searches the state that takes each solver the longest
    Search {
        /// Libraries with peers
        #[arg(long)]
        peer: Vec<PathBuf>,
    },
    /// Times programs of growing sizes
    Growth,
    /// Times the engine
    Engine,
    /// Writes the shipped controllers with flights for a microcontroller
    Recording,
    /// Times an FMU of FMI 2.0
    Fmu {
        /// The file
        file: PathBuf,
        /// Names of the real outputs that are read after a step, at most twelve; can be repeated
        #[arg(long)]
        output: Vec<String>,
    },
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (out, seed, quick) = (&arguments.out, arguments.seed, arguments.quick);
    match &arguments.task {
        Task::Programs => write(out, &control::programs(quick)?),
        Task::Control { peer, judge } => {
            write(out, &control::measure(&peer::load_all(peer)?, seed, quick, *judge)?)
        }
        Task::Search { peer } => write(out, &adversary::search(&peer::load_all(peer)?, seed, quick)?),
        Task::Growth => write(out, &growth::measure(quick)?),
        Task::Engine => write(out, &engine::measure(quick)?),
        Task::Recording => Ok(fs::write(out, recording::record()?)?),
        Task::Fmu { file, output } => write(out, &fmu::measure(file, output, quick)?),
    }
}

fn write(path: &Path, figures: &impl Serialize) -> Result<(), Failure> {
    Ok(fs::write(path, serde_json::to_vec(figures)?)?)
}
