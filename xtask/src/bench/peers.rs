//! The peers' Python packages.

use crate::progress::Progress;
use crate::python::Python;
use xtask::failure::Failure;
use xtask::files;
use xtask::workspace::Workspace;

/// File in the environment: what was asked for, and after it the names that could not be installed.
const MADE_FROM: &str = "made-from-peers.txt";
/// Between the two.
const ABSENT: &str = "\nabsent: ";

/// Installs each package by itself, and returns the names of those that cannot be installed.
pub fn install(workspace: &Workspace, progress: &Progress, python: &Python) -> Result<Vec<String>, Failure> {
    let list = files::read_text(&list(workspace))?;
    let made_from = python.folder().join(MADE_FROM);
    if let Ok(found) = std::fs::read_to_string(&made_from)
        && let Some(absent) = absent_of(&found, &list)
    {
        return Ok(absent);
    }
    let mut absent = Vec::new();
    progress.timed("Installing peers (first time; downloads about 700 MB)", || {
        for package in packages(&list) {
            let constraint = workspace.bench().join("python").join("base.txt");
            if !python.installs(package, &constraint)? {
                progress.note(&format!("{package} cannot be installed: it is reported missing"));
                absent.push(name(package).to_owned());
            }
        }
        Ok::<(), Failure>(())
    })?;
    files::write(&made_from, format!("{list}{ABSENT}{}", absent.join(" ")).as_bytes())?;
    Ok(absent)
}

/// Their names without versions.
pub fn names(workspace: &Workspace) -> Result<Vec<String>, Failure> {
    let list = files::read_text(&list(workspace))?;
    Ok(packages(&list).map(|package| name(package).to_owned()).collect())
}

fn list(workspace: &Workspace) -> std::path::PathBuf {
    workspace.bench().join("python").join("peers.txt")
}

fn packages(list: &str) -> impl Iterator<Item = &str> {
    list.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'))
}

/// Without version and options.
fn name(package: &str) -> &str {
    package.split("==").next().unwrap_or(package)
}

/// What was absent when the same list was installed; `None` if it was another.
fn absent_of(found: &str, list: &str) -> Option<Vec<String>> {
    let (asked, absent) = found.rsplit_once(ABSENT)?;
    (asked == list).then(|| absent.split_whitespace().map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::{ABSENT, absent_of, name, packages};

    #[test]
    fn comments_are_no_packages() {
        assert_eq!(packages("# peers\na==1\n\n b==2 \n").collect::<Vec<_>>(), ["a==1", "b==2"]);
        assert_eq!(name("a==1 --no-deps"), "a");
    }

    #[test]
    fn what_was_absent_stays_until_the_list_changes() {
        let found = format!("a==1\nb==2\n{ABSENT}b==2");
        assert_eq!(absent_of(&found, "a==1\nb==2\n").unwrap(), ["b==2"]);
        assert!(absent_of(&found, "a==1\nb==3\n").is_none());
        assert!(absent_of("a==1\n", "a==1\n").is_none());
    }
}
