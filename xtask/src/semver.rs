//! `cargo xtask semver`: whether the versions of the libraries say what has changed in them.

use std::path::Path;
use std::process::Command;

use crate::crates::{PUBLISHED, succeed};
use crate::progress::Progress;
use xtask::cargo;
use xtask::failure::Failure;
use xtask::process;
use xtask::workspace::Workspace;

/// The program that compares. It must know the compiler, so the latest version is the right one.
const PROGRAM: &str = "cargo-semver-checks";

/// Compares the libraries with an earlier revision: the one that is named, or else the last release.
pub fn check(
    workspace: &Workspace,
    progress: &Progress,
    baseline: Option<&str>,
    install: bool,
) -> Result<(), Failure> {
    let Some(baseline) = baseline.map(str::to_owned).or_else(|| last_release(workspace.root())) else {
        println!(
            "No earlier release: there is nothing to compare with. Name another revision with --baseline."
        );
        return Ok(());
    };
    if install {
        let mut bring = cargo::cargo();
        bring.args(["install", PROGRAM, "--locked", "--quiet"]);
        succeed(progress, &format!("Installing {PROGRAM}"), &mut bring)?;
    }
    if process::output(Command::new(PROGRAM).args(["semver-checks", "--version"]), PROGRAM).is_err() {
        return Err(Failure::Missing {
            program: PROGRAM.to_owned(),
            remedy: "run the command with --install; building it takes some minutes",
        });
    }
    let mut compare = cargo::cargo();
    compare.args(["semver-checks", "--baseline-rev", &baseline]).current_dir(workspace.root());
    compare.args(PUBLISHED.iter().flat_map(|name| ["--package", name]));
    succeed(progress, &format!("Comparing the libraries with {baseline}"), &mut compare)
}

/// Tag of the last release before this revision, which may have a tag itself.
fn last_release(root: &Path) -> Option<String> {
    let mut describe = Command::new("git");
    describe.args(["describe", "--tags", "--abbrev=0", "--match", "v*", "HEAD^"]).current_dir(root);
    let answer = describe.output().ok().filter(|answer| answer.status.success())?;
    Some(String::from_utf8_lossy(&answer.stdout).trim().to_owned())
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::process::Command;

    use super::last_release;

    fn git(folder: &Path, arguments: &[&str]) {
        let settings = [
            "-c",
            "user.name=Somebody",
            "-c",
            "user.email=somebody@example.org",
            "-c",
            "commit.gpgsign=false",
        ];
        let status = Command::new("git").args(settings).args(arguments).current_dir(folder).output();
        assert!(status.expect("git is there").status.success(), "{arguments:?}");
    }

    #[test]
    fn the_last_release_is_the_tag_before_this_one() {
        let folder = std::env::temp_dir().join(format!("xtask-semver-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let commit = || git(&folder, &["commit", "--quiet", "--allow-empty", "--message", "a change"]);
        git(&folder, &["init", "--quiet"]);
        commit();
        assert_eq!(last_release(&folder), None);
        git(&folder, &["tag", "v0.1.0"]);
        assert_eq!(last_release(&folder), None, "the first release");
        commit();
        git(&folder, &["tag", "something-else"]);
        commit();
        assert_eq!(last_release(&folder).as_deref(), Some("v0.1.0"));
        git(&folder, &["tag", "v0.2.0"]);
        assert_eq!(last_release(&folder).as_deref(), Some("v0.1.0"), "of the second one");
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
