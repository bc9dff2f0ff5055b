//! `cargo xtask assets`: the vehicle as a release has it.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::bills;
use crate::product::{Product, Profile};
use crate::program::{self, BUNDLE, Beside, VEHICLE};
use crate::progress::Progress;
use crate::python;
use crate::release::Release;
use xtask::failure::Failure;
use xtask::files;
use xtask::process;
use xtask::workspace::Workspace;

/// What the vehicle prints for other programs: its form, and the file that it is in.
const GENERATED: [(&str, &str); 5] = [
    ("man", "man/lmpc-sitl.1"),
    ("complete-bash", "completions/lmpc-sitl.bash"),
    ("complete-zsh", "completions/_lmpc-sitl"),
    ("complete-fish", "completions/lmpc-sitl.fish"),
    ("complete-powershell", "completions/lmpc-sitl.ps1"),
];

/// Writes an archive for each platform, and prints where and how large.
pub fn make(workspace: &Workspace, progress: &Progress, release: &Release) -> Result<(), Failure> {
    let interpreter = python::interpreter()?;
    let mut beside: Vec<(String, PathBuf)> = Vec::new();
    for path in notices(workspace, progress)? {
        beside.push((path.file_name().unwrap_or_default().to_string_lossy().into_owned(), path));
    }
    beside.extend(generated(workspace, progress)?);
    if let Some(bill) = bills::write(workspace, progress)?.into_iter().next() {
        beside.push(("lmpc-sitl.cdx.json".to_owned(), bill));
    }
    for (platform, built) in release.build(workspace, progress, Product::Vehicle, Profile::Release)? {
        let suffix = platform.program_suffix();
        let kind = if suffix.is_empty() { "tar.gz" } else { "zip" };
        let version = env!("CARGO_PKG_VERSION");
        let archive = workspace.assets().join(format!("{VEHICLE}-{version}-{platform}.{kind}"));
        let mut write = interpreter.command();
        write.arg(workspace.python_sources().join("assets.py")).arg(&archive);
        write.arg(named(&format!("{VEHICLE}{suffix}"), &built));
        write.args(beside.iter().map(|(name, path)| named(name, path)));
        progress.timed("Writing the archive", || process::output(&mut write, "writing the archive"))?;
        let bytes = files::read(&archive)?.len();
        println!("{} ({:.1} MB)", workspace.shown(&archive), bytes as f64 / 1e6);
    }
    Ok(())
}

/// Our licences, and the notices of what is linked into the vehicle.
pub fn notices(workspace: &Workspace, progress: &Progress) -> Result<Vec<PathBuf>, Failure> {
    let bundle = progress.timed("Building the program that writes the notices", || {
        program::build(workspace, BUNDLE, Beside::Nothing)
    })?;
    let third_party = workspace.target("notices").join("THIRD-PARTY.txt");
    process::output(Command::new(bundle).arg("vehicle-licenses").arg(&third_party), "writing the notices")?;
    let ours = ["LICENSE-MIT", "LICENSE-APACHE"].map(|name| workspace.root().join(name));
    Ok(ours.into_iter().chain([third_party]).collect())
}

/// Manual page and completions, each with its name in the archive: they are the same on all platforms.
fn generated(workspace: &Workspace, progress: &Progress) -> Result<Vec<(String, PathBuf)>, Failure> {
    let vehicle = progress
        .timed("Building the MAVLink vehicle", || program::build(workspace, VEHICLE, Beside::Nothing))?;
    let folder = workspace.target("generated");
    GENERATED
        .iter()
        .map(|(form, name)| {
            let text =
                process::output(Command::new(&vehicle).args(["--generate", form]), "writing completions")?;
            let path = folder.join(name);
            files::write(&path, &text)?;
            Ok(((*name).to_owned(), path))
        })
        .collect()
}

/// `NAME=FILE`
fn named(name: &str, path: &Path) -> OsString {
    let mut pair = OsString::from(format!("{name}="));
    pair.push(path);
    pair
}
