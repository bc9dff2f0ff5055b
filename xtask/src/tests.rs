//! What holds of the commands and of what is printed of them.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{CommandFactory, Parser};

use xtask::files;

use super::Workspace;

#[test]
fn arguments_are_consistent() {
    super::Arguments::command().debug_assert();
}

/// The lines of each block of Rust in a document.
fn rust_blocks(workspace: &Workspace, document: &str) -> Vec<Vec<String>> {
    let text = files::read_text(&workspace.root().join(document)).expect("is there");
    let blocks = text.split("```rust\n").skip(1).map(|rest| rest.split_once("```").expect("the code ends").0);
    blocks.map(|code| code.lines().filter(|line| !line.is_empty()).map(str::to_owned).collect()).collect()
}

/// What the README and the book print is an example of a crate's documentation, which is compiled and run.
#[test]
fn rust_code_of_readme_and_book_is_a_documentation_test() {
    let workspace = Workspace::find().expect("cargo knows the workspace");
    let (front, fleet) = ("quadrotor/README.md", "quadrotor/src/fleet.rs");
    let recording = "microcontroller/recording/src/lib.rs";
    let documents = [
        ("README.md", &[front][..]),
        ("book/src/library/simulate.md", &[front, fleet]),
        ("book/src/library/microcontroller.md", &[recording, recording]),
    ];
    for (document, sources) in documents {
        let blocks = rust_blocks(&workspace, document);
        assert_eq!(blocks.len(), sources.len(), "{document}");
        for (code, source) in blocks.iter().zip(sources) {
            let text = files::read_text(&workspace.root().join(source)).expect("is there");
            let documented: Vec<&str> =
                text.lines().map(|line| line.trim_start_matches("/// ").trim_start_matches("//! ")).collect();
            for line in code {
                assert!(documented.contains(&line.as_str()), "{document}: not in {source}: {line}");
            }
        }
    }
}

/// All pages of Markdown in a folder.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let within = |path: PathBuf| if path.is_dir() { pages(&path) } else { vec![path] };
    let files = files::names_in(folder).expect("is there").into_iter().flat_map(within);
    files.filter(|path| path.extension().is_some_and(|extension| extension == "md")).collect()
}

/// Each `cargo xtask …` in a block of a page or between backticks is a command that there is, with flags that it has.
#[test]
fn commands_that_are_printed_are_understood() {
    let workspace = Workspace::find().expect("cargo knows the workspace");
    let root = workspace.root();
    let mut printed = 0;
    let own = ["README.md", "CONTRIBUTING.md", "ARCHITECTURE.md"].map(|name| root.join(name));
    for page in own.into_iter().chain(pages(&root.join("book/src"))) {
        let text = files::read_text(&page).expect("is text");
        for (start, _) in text.match_indices("cargo xtask ") {
            // A command ends with its line, a comment or a backtick.
            let command = text[start..].split(['\n', '#', '`']).next().expect("a part");
            let words = command.split_whitespace().filter(|word| *word != "…").skip(1);
            let parsed = super::Arguments::try_parse_from(words);
            assert!(parsed.is_ok(), "{}: {command}: {}", page.display(), parsed.err().expect("a refusal"));
            printed += 1;
        }
    }
    assert!(printed > 50, "{printed}");
}

/// Says what plain `cargo test` leaves out; directly, because output of passing tests is not shown.
#[test]
fn python_tests_are_left_to_cargo_xtask_test() {
    let workspace = Workspace::find().expect("cargo knows the workspace");
    let files = files::names_in(&workspace.python_tests()).expect("is there");
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let count = files.iter().filter(|path| name(path).starts_with("test_")).count();
    assert!(count > 0, "the Python tests have moved");
    if std::env::var_os(super::test::ALL_TESTS).is_none() {
        let _ = writeln!(
            std::io::stderr(),
            "note: {count} files of tests in tests/python are left to `cargo xtask test`"
        );
    }
}
