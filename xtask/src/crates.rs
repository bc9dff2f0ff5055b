//! `cargo xtask crates`: the libraries as a registry would get them.

use std::path::Path;
use std::process::Command;

use crate::progress::Progress;
use xtask::cargo;
use xtask::failure::Failure;
use xtask::files;
use xtask::process;
use xtask::workspace::Workspace;

/// The crates that stand on their own, each after those that it depends on.
pub const PUBLISHED: [&str; 3] = ["lmpc", "quadrotor", "fmi"];

/// Packages the libraries, and compiles what was packed with the oldest versions of its dependencies that it allows.
pub fn check(workspace: &Workspace, progress: &Progress) -> Result<(), Failure> {
    let metadata = cargo::metadata_without_dependencies()?;
    let mut package = cargo::cargo();
    // What was packed is compiled below.
    package.args(["package", "--quiet", "--no-verify"]).current_dir(workspace.root());
    package.args(PUBLISHED.iter().flat_map(|name| ["--package", name]));
    succeed(progress, "Packaging the libraries", &mut package)?;

    // Beside what is compiled of it, which stays for the next time.
    let unpacked = workspace.target("crates").join("source");
    files::remove_folder(&unpacked)?;
    files::create_folder(&unpacked)?;
    let mut folders = Vec::new();
    for package in metadata.packages.iter().filter(|package| PUBLISHED.contains(&package.name.as_str())) {
        let folder = format!("{}-{}", package.name, package.version);
        let archive = workspace.target("package").join(format!("{folder}.crate"));
        let mut unpack = Command::new("tar");
        unpack.arg("-xzf").arg(&archive).arg("-C").arg(&unpacked);
        process::output(&mut unpack, "unpacking a crate")?;
        println!("{}", workspace.shown(&archive));
        folders.push((package.name.as_str(), folder));
    }
    files::write(&unpacked.join("Cargo.toml"), manifest(&folders).as_bytes())?;
    oldest_versions(progress, workspace, &unpacked)
}

/// Compiles a workspace with the oldest versions that it allows of what it names.
fn oldest_versions(progress: &Progress, workspace: &Workspace, folder: &Path) -> Result<(), Failure> {
    let mut update = cargo::cargo();
    // Only nightly toolchains choose the oldest versions, unless they are told to.
    update.args(["update", "--quiet", "-Z", "direct-minimal-versions"]).env("RUSTC_BOOTSTRAP", "1");
    succeed(progress, "Choosing the oldest versions", update.current_dir(folder))?;
    for features in ["--all-features", "--no-default-features"] {
        let mut check = cargo::cargo();
        check.args(["check", "--quiet", "--workspace", features, "--target-dir"]);
        check.arg(workspace.target("crates").join("target")).current_dir(folder);
        succeed(progress, "Compiling what was packed", &mut check)?;
    }
    Ok(())
}

/// A workspace of unpacked crates that use each other.
fn manifest(folders: &[(&str, String)]) -> String {
    let members: Vec<String> = folders.iter().map(|(_, folder)| format!("{folder:?}")).collect();
    let patches: String =
        folders.iter().map(|(name, folder)| format!("{name} = {{ path = {folder:?} }}\n")).collect();
    format!(
        "[workspace]\nresolver = \"3\"\nmembers = [{}]\n\n[patch.crates-io]\n{patches}",
        members.join(", ")
    )
}

/// Runs a program that says itself why it fails.
pub fn succeed(progress: &Progress, text: &str, command: &mut Command) -> Result<(), Failure> {
    let status = progress.timed(text, || process::status(command))?;
    if status.success() { Ok(()) } else { Err(Failure::Ended { what: text.to_lowercase(), status }) }
}
