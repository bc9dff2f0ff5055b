//! The FMU's library: built for release, without the paths of the machine that built it.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use xtask::cargo::{cargo, metadata_with_dependencies};
use xtask::failure::Failure;
use xtask::process;
use xtask::workspace::Workspace;

/// One message of `cargo build --message-format=json`, as far as it is used here.
#[derive(Deserialize)]
struct Message {
    reason: String,
    target: Option<Target>,
    #[serde(default)]
    filenames: Vec<PathBuf>,
}

#[derive(Deserialize)]
struct Target {
    name: String,
}

/// Builds the library for this machine and returns its path.
pub fn build(workspace: &Workspace) -> Result<PathBuf, Failure> {
    let messages = process::output(
        cargo()
            .args(["build", "--quiet", "--release", "--package", "fmu"])
            .arg("--message-format=json-render-diagnostics")
            .env_remove("RUSTFLAGS")
            .env("CARGO_ENCODED_RUSTFLAGS", flags(workspace)?)
            .current_dir(workspace.root()),
        "building the FMU's library",
    )?;
    built(&messages)
}

/// The file that cargo says it has built.
fn built(messages: &[u8]) -> Result<PathBuf, Failure> {
    let unreadable = |detail: String| Failure::Answer { what: "cargo build", detail };
    for line in String::from_utf8_lossy(messages).lines() {
        let message: Message = serde_json::from_str(line).map_err(|error| unreadable(error.to_string()))?;
        let ours = message.reason == "compiler-artifact"
            && message.target.is_some_and(|target| target.name == "fmu");
        let library = |path: &&PathBuf| {
            path.extension().is_some_and(|extension| extension == std::env::consts::DLL_EXTENSION)
        };
        if let (true, Some(path)) = (ours, message.filenames.iter().find(library)) {
            return Ok(path.clone());
        }
    }
    Err(unreadable("it names no library".to_owned()))
}

/// The caller's compiler flags, and those that replace paths which panics would show: where the sources of
/// the dependencies lie differs from machine to machine, and is nobody's business.
fn flags(workspace: &Workspace) -> Result<OsString, Failure> {
    const SEPARATOR: &str = "\u{1f}";
    let mut flags: Vec<OsString> = match std::env::var("CARGO_ENCODED_RUSTFLAGS") {
        Ok(encoded) => encoded.split(SEPARATOR).map(OsString::from).collect(),
        Err(_) => {
            let plain = std::env::var("RUSTFLAGS").unwrap_or_default();
            plain.split_whitespace().map(OsString::from).collect()
        }
    };
    let mut remap = |from: &Path, to: &str| {
        let mut flag = OsString::from("--remap-path-prefix=");
        flag.push(from);
        flag.push("=");
        flag.push(to);
        flags.push(flag);
    };
    remap(workspace.root(), "lmpc-quadrotor");
    let mut folders: Vec<PathBuf> = metadata_with_dependencies()?
        .packages
        .iter()
        .filter(|package| package.source.is_some())
        .filter_map(|package| Some(package.manifest_path.parent()?.parent()?.to_owned()))
        .collect();
    folders.sort();
    folders.dedup();
    for folder in &folders {
        remap(folder, "crates");
    }
    flags.retain(|flag| !flag.is_empty());
    Ok(flags.join(SEPARATOR.as_ref()))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::built;

    #[test]
    fn finds_the_library_among_the_messages() {
        let file = format!("/t/release/libfmu.{}", std::env::consts::DLL_EXTENSION);
        let messages = format!(
            "{}\n{}\n{}",
            r#"{"reason":"build-script-executed","package_id":"x"}"#,
            r#"{"reason":"compiler-artifact","target":{"name":"quadrotor"},"filenames":["/t/libquadrotor.rlib"]}"#,
            format_args!(
                r#"{{"reason":"compiler-artifact","target":{{"name":"fmu"}},"filenames":["/t/libfmu.rlib","{file}"]}}"#
            ),
        );
        assert_eq!(built(messages.as_bytes()).ok().as_deref(), Some(Path::new(&file)));
        assert!(built(br#"{"reason":"build-finished","success":true}"#).is_err());
    }
}
