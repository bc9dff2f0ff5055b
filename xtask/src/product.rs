//! What is shipped: built for release, without the paths of the machine that built it.

use std::path::PathBuf;

use serde::Deserialize;

use crate::paths::Paths;
use crate::program::VEHICLE;
use crate::python::Python;
use crate::toolchains::Toolchain;
use xtask::failure::Failure;
use xtask::platform::Platform;
use xtask::process;
use xtask::workspace::Workspace;

/// What is shipped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Product {
    /// The FMU's library.
    Library,
    /// The MAVLink vehicle.
    Vehicle,
}

impl std::fmt::Display for Product {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Library => "the FMU's library",
            Self::Vehicle => "the MAVLink vehicle",
        })
    }
}

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

/// How it is compiled. The numbers are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Profile {
    /// As it is shipped.
    Release,
    /// To be tried and thrown away.
    Trial,
    /// Slow, to see that it runs at all.
    Draft,
}

impl Profile {
    /// What cargo calls it.
    fn name(self) -> &'static str {
        match self {
            Self::Release => "release",
            Self::Trial => "trial",
            Self::Draft => "draft",
        }
    }
}

impl Product {
    /// What cargo is asked for.
    fn selection(self) -> &'static [&'static str] {
        match self {
            Self::Library => &["--package", "fmu", "--lib"],
            Self::Vehicle => &["--package", "sitl", "--bin", VEHICLE],
        }
    }

    /// What cargo calls it.
    fn target(self) -> &'static str {
        match self {
            Self::Library => "fmu",
            Self::Vehicle => VEHICLE,
        }
    }

    /// Extension of its file.
    fn extension(self, platform: Platform) -> &'static str {
        match self {
            Self::Library => platform.library_extension(),
            Self::Vehicle => platform.program_suffix().trim_start_matches('.'),
        }
    }

    /// The file of it that cargo says it has built.
    fn built(self, platform: Platform, messages: &[u8]) -> Result<PathBuf, Failure> {
        let unreadable = |detail: String| Failure::Answer { what: "cargo build", detail };
        let extension = self.extension(platform);
        for line in String::from_utf8_lossy(messages).lines() {
            let message: Message =
                serde_json::from_str(line).map_err(|error| unreadable(error.to_string()))?;
            let ours = message.reason == "compiler-artifact"
                && message.target.is_some_and(|target| target.name == self.target());
            let is_it = |path: &&PathBuf| path.extension().unwrap_or_default() == extension;
            if let (true, Some(path)) = (ours, message.filenames.iter().find(is_it)) {
                return Ok(path.clone());
            }
        }
        Err(unreadable(format!("it names no file of {}", self.target())))
    }
}

/// Builds it and returns its path. A toolchain with zig needs the environment with it.
pub fn build(
    workspace: &Workspace,
    toolchain: &Toolchain,
    zig: Option<&Python>,
    paths: &Paths,
    product: Product,
    profile: Profile,
) -> Result<PathBuf, Failure> {
    let platform = toolchain.platform();
    let mut build = toolchain.build(workspace, zig);
    build
        .args(["--quiet", "--profile", profile.name()])
        .args(product.selection())
        .arg("--message-format=json-render-diagnostics")
        .env_remove("RUSTFLAGS")
        .env("CARGO_ENCODED_RUSTFLAGS", paths.flags(toolchain));
    let messages = process::output(&mut build, &format!("building {product} for {platform}"))?;
    product.built(platform, &messages)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::Product;
    use xtask::platform::Platform;

    fn artifact(target: &str, files: &str) -> String {
        format!(r#"{{"reason":"compiler-artifact","target":{{"name":"{target}"}},"filenames":[{files}]}}"#)
    }

    #[test]
    fn finds_the_file_among_the_messages() {
        let messages = [
            r#"{"reason":"build-script-executed","package_id":"x"}"#.to_owned(),
            artifact("quadrotor", r#""/t/libquadrotor.rlib""#),
            artifact("fmu", r#""/t/fmu.dll","/t/libfmu.rlib","/t/libfmu.dll.a""#),
            artifact("lmpc-sitl", r#""/t/lmpc-sitl.exe""#),
        ]
        .join("\n");
        let built = |product: Product| product.built(Platform::X86_64Windows, messages.as_bytes()).ok();
        assert_eq!(built(Product::Library).as_deref(), Some(Path::new("/t/fmu.dll")));
        assert_eq!(built(Product::Vehicle).as_deref(), Some(Path::new("/t/lmpc-sitl.exe")));

        let messages = [
            artifact("fmu", r#""/t/libfmu.so","/t/libfmu.rlib""#),
            artifact("lmpc-sitl", r#""/t/lmpc-sitl""#),
        ];
        let messages = messages.join("\n");
        let built = |product: Product| product.built(Platform::X86_64Linux, messages.as_bytes()).ok();
        assert_eq!(built(Product::Library).as_deref(), Some(Path::new("/t/libfmu.so")));
        assert_eq!(built(Product::Vehicle).as_deref(), Some(Path::new("/t/lmpc-sitl")));

        let nothing = br#"{"reason":"build-finished","success":true}"#;
        assert!(Product::Library.built(Platform::X86_64Linux, nothing).is_err());
    }
}
