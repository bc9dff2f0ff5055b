//! `cargo xtask bills`: what is linked into what is released.

use std::path::PathBuf;

use crate::progress::Progress;
use crate::python::{self, Packages};
use xtask::cargo;
use xtask::failure::Failure;
use xtask::files;
use xtask::platform::Platform;
use xtask::process;
use xtask::workspace::Workspace;

/// Our packages, each with the product that it makes.
const PRODUCTS: [(&str, &str); 3] =
    [("sitl", "lmpc-sitl"), ("fmu", "LmpcQuadrotor.fmu"), ("lmpc-quadrotor-python", "lmpc-quadrotor")];

/// Writes a bill for each product, for Linux, Windows and macOS together, and returns their paths in the order of the products.
pub fn write(workspace: &Workspace, progress: &Progress) -> Result<Vec<PathBuf>, Failure> {
    let interpreter = python::interpreter()?;
    let python = python::environment(workspace, progress, &interpreter, Packages::Release)?;
    let script = workspace.python_sources().join("bill.py");
    let lock = workspace.root().join("Cargo.lock");
    let folder = workspace.target("bills");
    let metadata = folder.join("metadata.json");
    let mut known = cargo::cargo();
    known.args(["metadata", "--format-version", "1", "--locked"]);
    known.args(Platform::ALL.iter().flat_map(|platform| ["--filter-platform", platform.target()]));
    known.current_dir(workspace.root());
    files::write(&metadata, &process::output(&mut known, "cargo metadata")?)?;
    let version = env!("CARGO_PKG_VERSION");
    let mut bills = Vec::new();
    for (package, product) in PRODUCTS {
        let tree = folder.join(format!("{package}.txt"));
        let mut linked = cargo::cargo();
        linked.args(["tree", "--locked", "--package", package, "--edges", "normal,no-proc-macro"]);
        linked.args(["--prefix", "none", "--format", "{p}"]);
        linked.args(Platform::ALL.iter().flat_map(|platform| ["--target", platform.target()]));
        linked.current_dir(workspace.root());
        files::write(&tree, &process::output(&mut linked, "cargo tree")?)?;
        let bill = workspace.assets().join(format!("{product}-{version}.cdx.json"));
        let mut write = python.command();
        write.arg(&script).arg(&metadata).arg(&tree).arg(&lock).arg(product).arg(&bill);
        let what = format!("writing the bill of materials of {product}");
        progress.timed(&format!("W{}", &what[1..]), || process::output(&mut write, &what))?;
        println!("{}", workspace.shown(&bill));
        bills.push(bill);
    }
    Ok(bills)
}
