//! The tables from equation to file name every equation of the paper, and files and types that exist.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const LAST_EQUATION: u32 = 58;

/// What stands between backquotes.
fn quoted(cell: &str) -> impl Iterator<Item = &str> {
    cell.split('`').skip(1).step_by(2)
}

/// "(5)–(8), (10)" is 5, 6, 7, 8, 10.
fn equations(cell: &str) -> Vec<u32> {
    cell.split(", ")
        .flat_map(|range| {
            let mut ends = range.split('–').map(|end| end.trim_matches(['(', ')']).parse::<u32>().unwrap());
            let first = ends.next().unwrap();
            first..=ends.next().unwrap_or(first)
        })
        .collect()
}

#[test]
fn every_equation_has_a_file_and_a_type() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let table = fs::read_to_string(root.join("lmpc/src/equations.md")).unwrap();
    let mut named = BTreeSet::new();
    for line in table.lines().filter(|line| line.starts_with("| ") && line.contains('`')) {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let [equation, _, files, types] = cells[..] else { panic!("{line}") };
        if equation.starts_with('(') {
            named.extend(equations(equation));
        }
        let sources: Vec<String> = quoted(files)
            .map(|file| fs::read_to_string(root.join(file)).unwrap_or_else(|error| panic!("{file}: {error}")))
            .collect();
        assert!(!sources.is_empty(), "{line}");
        for name in quoted(types) {
            let defined = ["fn", "struct", "enum"].map(|kind| format!("{kind} {name}"));
            let is_defined = |source: &String| defined.iter().any(|definition| source.contains(definition));
            assert!(sources.iter().any(is_defined), "{name} is not defined in {files}");
        }
        assert!(quoted(types).count() > 0, "{line}");
    }
    assert_eq!(named, (1..=LAST_EQUATION).collect());
}
