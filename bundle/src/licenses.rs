//! Our licences, and the notices of what is linked into the library.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

use crate::failure::Failure;
use xtask::cargo::{Package, cargo, metadata_with_dependencies};
use xtask::files;
use xtask::process;
use xtask::workspace::Workspace;

/// Files of the folder `licenses/`, by name.
pub fn texts(workspace: &Workspace) -> Result<Vec<(&'static str, String)>, Failure> {
    let linked = linked_packages(workspace, &["fmu"])?;
    Ok(vec![
        ("license.txt", OVERVIEW.to_owned()),
        ("LICENSE-MIT.txt", files::read_text(&workspace.root().join("LICENSE-MIT"))?),
        ("LICENSE-APACHE.txt", files::read_text(&workspace.root().join("LICENSE-APACHE"))?),
        ("third-party.txt", notices("this FMU", &linked)?),
    ])
}

/// The notices of what is linked into some of our packages together, the vehicle among them; `product` is what they make, for a person.
pub fn of_packages(workspace: &Workspace, product: &str, packages: &[&str]) -> Result<String, Failure> {
    let mut page = notices(product, &linked_packages(workspace, packages)?)?;
    for (name, license) in PAGE_SCRIPTS {
        let text = files::read_text(&workspace.root().join(license))?;
        let _ = write!(page, "\n{}\n{name}\n\n{}\n", "=".repeat(80), text.trim_end());
    }
    Ok(page)
}

/// Scripts of the live page, which are in the vehicle's program, and their licences.
const PAGE_SCRIPTS: [(&str, &str); 2] =
    [("three 0.185.1", "viewer/assets/three/LICENSE"), ("uplot 1.6.32", "viewer/assets/uplot/LICENSE")];

const OVERVIEW: &str = "\
This FMU is licensed under either of

  * the Apache License, Version 2.0 (LICENSE-APACHE.txt)
  * the MIT licence (LICENSE-MIT.txt)

at your option. It contains the libraries that third-party.txt lists with their notices.
";

/// Packages linked into some of ours: neither build tools nor procedural macros.
fn linked_packages(workspace: &Workspace, of: &[&str]) -> Result<Vec<Package>, Failure> {
    let tree = process::output(
        cargo()
            .arg("tree")
            .args(of.iter().flat_map(|package| ["--package", package]))
            .args(["--edges", "normal,no-proc-macro"])
            .args(["--prefix", "none", "--format", "{p}"])
            .current_dir(workspace.root()),
        "cargo tree",
    )?;
    let names = names_and_versions(&String::from_utf8_lossy(&tree));
    let mut packages = metadata_with_dependencies()?.packages;
    packages.retain(|package| {
        package.source.is_some() && names.contains(&(package.name.clone(), package.version.clone()))
    });
    packages.sort_by(|one, other| (&one.name, &one.version).cmp(&(&other.name, &other.version)));
    Ok(packages)
}

/// Reads lines like `nalgebra v0.35.0 (*)`.
fn names_and_versions(tree: &str) -> BTreeSet<(String, String)> {
    tree.lines()
        .filter_map(|line| {
            let mut words = line.split_whitespace();
            let (name, version) = (words.next()?, words.next()?);
            Some((name.to_owned(), version.strip_prefix('v')?.to_owned()))
        })
        .collect()
}

/// The list of packages, and each licence text once with the packages that carry it.
fn notices(product: &str, packages: &[Package]) -> Result<String, Failure> {
    let mut page = format!("Libraries that are linked into {product}.\n\n");
    let mut texts = Texts::default();
    for package in packages {
        let license = package.license.as_deref().unwrap_or("see its text");
        let home = package.repository.as_deref().unwrap_or("");
        // Writing to a String cannot fail.
        let _ = writeln!(page, "{} {}: {license} {home}", package.name, package.version);
        for text in license_texts(package)? {
            texts.add(&package.name, text);
        }
    }
    page.push_str("Rust standard library: MIT OR Apache-2.0 https://github.com/rust-lang/rust\n");
    for (text, names) in texts.by_words.values() {
        let _ = write!(page, "\n{}\n{}\n\n{}\n", "=".repeat(80), names.join(", "), text.trim_end());
    }
    Ok(page)
}

/// Texts of licences with the packages that carry them. Texts of the same words are one, however their lines are broken and indented.
#[derive(Default)]
struct Texts<'a> {
    by_words: BTreeMap<String, (String, Vec<&'a str>)>,
}

impl<'a> Texts<'a> {
    fn add(&mut self, package: &'a str, text: String) {
        let words: Vec<&str> = text.split_whitespace().collect();
        let (_, carriers) = self.by_words.entry(words.join(" ")).or_insert((text, Vec::new()));
        if carriers.last() != Some(&package) {
            carriers.push(package);
        }
    }
}

/// The licence files that a package brings along, with uniform line ends.
fn license_texts(package: &Package) -> Result<Vec<String>, Failure> {
    let Some(folder) = package.manifest_path.parent() else { return Ok(Vec::new()) };
    files::names_in(folder)?
        .iter()
        .filter(|path| path.is_file() && is_license(path))
        .map(|path| {
            let text = files::read(path)?;
            Ok(String::from_utf8_lossy(&text).replace("\r\n", "\n"))
        })
        .collect()
}

fn is_license(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_uppercase();
    ["LICENSE", "LICENCE", "COPYING", "NOTICE", "COPYRIGHT"].iter().any(|start| name.starts_with(start))
}

#[cfg(test)]
mod tests {
    use super::{Texts, names_and_versions};

    #[test]
    fn texts_that_differ_in_spaces_are_one() {
        let mut texts = Texts::default();
        for (package, text) in
            [("a", "No\n  warranty."), ("b", "No warranty.\n"), ("b", "Warranty."), ("b", "Warranty.\n")]
        {
            texts.add(package, text.to_owned());
        }
        let found: Vec<_> = texts.by_words.into_values().collect();
        let expected = [("No\n  warranty.", vec!["a", "b"]), ("Warranty.", vec!["b"])];
        assert_eq!(found, expected.map(|(text, carriers)| (text.to_owned(), carriers)));
    }

    #[test]
    fn reads_names_and_versions_of_a_tree() {
        let tree = "fmu v0.1.0 (/somewhere/fmu)\nlibm v0.2.16\nnalgebra v0.35.0 (*)\n\n";
        let expected = [("fmu", "0.1.0"), ("libm", "0.2.16"), ("nalgebra", "0.35.0")];
        let expected = expected.map(|(name, version)| (name.to_owned(), version.to_owned()));
        assert_eq!(names_and_versions(tree), expected.into());
    }
}
