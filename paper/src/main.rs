//! `cargo xtask paper`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use paper::{Error, ModelFile, report, results};

/// Computes the paper's tables and eigenvalues again, or designs a controller for any model.
#[derive(Parser)]
#[command(name = "paper", bin_name = "cargo xtask paper")]
struct Arguments {
    /// Prints gains, eigenvalues and condition numbers of the model in this TOML file as JSON, and does nothing
    /// else.
    #[arg(long, value_name = "MODEL.toml")]
    gain: Option<PathBuf>,
    /// Folder for report.html and results.json.
    #[arg(long, value_name = "FOLDER", default_value = "target/paper")]
    out: PathBuf,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match &arguments.gain {
        Some(path) => print_gain(path),
        None => write_results(&arguments.out),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn print_gain(path: &Path) -> Result<(), Error> {
    let text = fs::read_to_string(path).map_err(|source| Error::File { path: path.to_owned(), source })?;
    let result = ModelFile::parse(&text)?.design()?;
    println!("{}", json(&result));
    Ok(())
}

fn write_results(out: &Path) -> Result<(), Error> {
    let results = results(&paper::Progress::hidden())?;
    let write = |name: &str, text: &str| {
        let path = out.join(name);
        fs::write(&path, text).map_err(|source| Error::File { path: path.clone(), source })?;
        println!("{}", path.display());
        Ok(())
    };
    fs::create_dir_all(out).map_err(|source| Error::File { path: out.to_owned(), source })?;
    write("results.json", &json(&results))?;
    write("report.html", &report(&results))
}

fn json(value: &impl serde::Serialize) -> String {
    // Numbers, lists and names always serialize; NaN and infinities become null.
    serde_json::to_string_pretty(value).unwrap_or_default()
}
