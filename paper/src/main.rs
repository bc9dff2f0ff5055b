//! `cargo xtask paper`.

use std::fs;
use std::io::{ErrorKind, Write, stdout};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use paper::bars::Optimum;
use paper::{Error, FLIGHTS, ModelFile, Progress, parts, png, report, results, schema, tune};
use quadrotor::Configuration;
use rayon::prelude::*;

/// Recomputes the paper's tables and figures, or designs a controller for any model.
#[derive(Parser)]
#[command(name = "paper", bin_name = "cargo xtask paper")]
struct Arguments {
    /// Prints gains, closed-loop eigenvalues and condition numbers for the model in this TOML file as JSON, and exits.
    #[arg(long, value_name = "MODEL.toml")]
    gain: Option<PathBuf>,
    /// Prints the JSON Schema of results.json, and exits.
    #[arg(long, conflicts_with = "gain")]
    schema: bool,
    /// Compares N, a, the stabilizing feedback and the samples of limits of the loops by their cost in flight, and exits.
    #[arg(long, conflicts_with_all = ["gain", "schema"])]
    tune: bool,
    /// Optimal flights that xtask/python/optimum.py found, to compare with.
    #[arg(long, value_name = "OPTIMUM.json", conflicts_with_all = ["gain", "schema"])]
    optimum: Option<PathBuf>,
    /// Random flights of each controller; fewer for a first look.
    #[arg(long, value_name = "FLIGHTS", default_value_t = FLIGHTS, value_parser = clap::value_parser!(u32).range(1..))]
    random: u32,
    /// Directory for report.html, results.json and PNG copies of the figures.
    #[arg(long, value_name = "DIR", default_value = "target/paper")]
    out: PathBuf,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match &arguments.gain {
        Some(path) => print_gain(path),
        None if arguments.tune => tune(&Configuration::default()).and_then(|page| print(page.trim_end())),
        None if arguments.schema => print(&json(&schema())),
        None => write_results(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn read(path: &Path) -> Result<String, Error> {
    fs::read_to_string(path).map_err(|source| Error::File { path: path.to_owned(), source })
}

fn print_gain(path: &Path) -> Result<(), Error> {
    let result = ModelFile::parse(&read(path)?)?.design()?;
    print(&json(&result))
}

/// Prints a line. A reader that has closed the pipe, such as `head`, has read enough: that is no error.
fn print(line: &str) -> Result<(), Error> {
    match writeln!(stdout(), "{line}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Error::Output(error)),
        _ => Ok(()),
    }
}

fn write_results(arguments: &Arguments) -> Result<(), Error> {
    let out = &arguments.out;
    let optima = match &arguments.optimum {
        Some(path) => Optimum::parse(&read(path)?)?,
        None => Vec::new(),
    };
    let progress = Progress::shown(parts(arguments.random)?);
    let results = results(arguments.random, &optima, &progress)?;
    progress.stage("figures");
    let page = report(&results);
    let figures = page.all_figures();
    let pictures = figures
        .par_iter()
        .map(|figure| Ok((format!("{}.png", figure.name), png(&figure.name, &figure.svg)?)))
        .collect::<Result<Vec<_>, Error>>()?;
    progress.finish();

    let write = |name: &str, bytes: &[u8]| {
        let path = out.join(name);
        fs::write(&path, bytes).map_err(|source| Error::File { path: path.clone(), source })?;
        print(&path.display().to_string())
    };
    fs::create_dir_all(out).map_err(|source| Error::File { path: out.to_owned(), source })?;
    for (name, picture) in &pictures {
        write(name, picture)?;
    }
    write("results.schema.json", json(&schema()).as_bytes())?;
    write("results.json", json(&results).as_bytes())?;
    write("report.html", page.html().as_bytes())
}

fn json(value: &impl serde::Serialize) -> String {
    // Numbers, lists and names always serialize; NaN and infinities become null.
    serde_json::to_string_pretty(value).unwrap_or_default()
}
