//! Questions to cargo.

use std::path::PathBuf;
use std::process::Command;

use serde::Deserialize;

use crate::failure::Failure;
use crate::process;

/// What `cargo metadata` tells, as far as it is used here.
#[derive(Deserialize)]
pub struct Metadata {
    /// Root of the repository.
    pub workspace_root: PathBuf,
    /// Where cargo builds.
    pub target_directory: PathBuf,
    /// All packages, in no particular order.
    pub packages: Vec<Package>,
}

/// A package of the dependency graph.
#[derive(Deserialize)]
pub struct Package {
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
    /// Its licence, an SPDX expression.
    pub license: Option<String>,
    /// Where its source is kept.
    pub repository: Option<String>,
    /// Its Cargo.toml.
    pub manifest_path: PathBuf,
    /// Registry it comes from; none for our own.
    pub source: Option<String>,
}

/// The cargo that runs this task.
pub fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Metadata of the workspace's own packages.
///
/// # Errors
///
/// If cargo does not start, fails or gives an answer that cannot be read.
pub fn metadata_without_dependencies() -> Result<Metadata, Failure> {
    metadata(&["--no-deps"])
}

/// Metadata of the whole dependency graph on this platform; others would have to be downloaded.
///
/// # Errors
///
/// If cargo does not start, fails or gives an answer that cannot be read.
pub fn metadata_with_dependencies() -> Result<Metadata, Failure> {
    metadata(&["--filter-platform", &host()?])
}

fn metadata(arguments: &[&str]) -> Result<Metadata, Failure> {
    // The folder of this package, so that it does not matter where the task was started.
    let json = process::output(
        cargo()
            .args(["metadata", "--format-version", "1"])
            .args(arguments)
            .current_dir(env!("CARGO_MANIFEST_DIR")),
        "cargo metadata",
    )?;
    serde_json::from_slice(&json)
        .map_err(|error| Failure::Answer { what: "cargo metadata", detail: error.to_string() })
}

/// Target triple of this machine, as cargo names it.
fn host() -> Result<String, Failure> {
    let version = process::output(cargo().arg("-vV"), "cargo -vV")?;
    String::from_utf8_lossy(&version)
        .lines()
        .find_map(|line| line.strip_prefix("host: ").map(str::to_owned))
        .ok_or_else(|| Failure::Answer { what: "cargo -vV", detail: "it names no host".to_owned() })
}

/// The compiler that cargo uses: its version, and the machine that it compiles for.
///
/// # Errors
///
/// If it does not start or fails.
pub fn compiler() -> Result<String, Failure> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = process::output(Command::new(rustc).arg("-V"), "rustc -V")?;
    Ok(format!("{} for {}", String::from_utf8_lossy(&version).trim(), host()?))
}
