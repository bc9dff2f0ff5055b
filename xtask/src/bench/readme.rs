//! README's table of figures: between two marks, written from the results that the repository keeps.

use std::path::PathBuf;

use super::figures;
use xtask::failure::Failure;
use xtask::files;
use xtask::workspace::Workspace;

const BEGIN: &str = "<!-- written by `cargo xtask bench --publish` -->\n";
const END: &str = "<!-- end -->\n";

/// The results that the repository keeps.
pub fn results(workspace: &Workspace) -> PathBuf {
    workspace.bench().join("results").join("results.json")
}

/// Writes the table.
pub fn write(workspace: &Workspace) -> Result<(), Failure> {
    let (text, wanted) = texts(workspace)?;
    if text == wanted { Ok(()) } else { files::write(&file(workspace), wanted.as_bytes()) }
}

/// Fails if the table is another than the results make.
pub fn check(workspace: &Workspace) -> Result<(), Failure> {
    let (text, wanted) = texts(workspace)?;
    if text == wanted {
        return Ok(());
    }
    let detail = "has a table of figures that differs from bench/results/results.json; run `cargo xtask bench --table`";
    Err(Failure::Figures { file: "README.md", detail: detail.to_owned() })
}

fn file(workspace: &Workspace) -> PathBuf {
    workspace.root().join("README.md")
}

/// README as it is, and as it is wanted.
fn texts(workspace: &Workspace) -> Result<(String, String), Failure> {
    let results = files::read(&results(workspace))?;
    let results = serde_json::from_slice(&results).map_err(|error| Failure::Figures {
        file: "bench/results/results.json",
        detail: error.to_string(),
    })?;
    let text = files::read_text(&file(workspace))?;
    let marked = text.split_once(BEGIN).and_then(|(before, rest)| Some((before, rest.split_once(END)?.1)));
    let (before, after) = marked.ok_or_else(|| Failure::Figures {
        file: "README.md",
        detail: format!(
            "lacks the lines around the table of figures; put back {} and {}",
            BEGIN.trim(),
            END.trim()
        ),
    })?;
    let wanted = format!("{before}{BEGIN}{}{END}{after}", figures::table(&results)?);
    Ok((text, wanted))
}

#[cfg(test)]
mod tests {
    use xtask::workspace::Workspace;

    #[test]
    fn the_table_is_that_of_the_kept_results() {
        let workspace = Workspace::find().expect("cargo knows the workspace");
        super::check(&workspace).expect("README has the figures of the kept results");
    }
}
