//! The book's page about FMUs says what the code does.

use vehicle::foreign::ForeignRole;

use super::map::Map;
use super::signals::{ARMED, Group, INPUTS, OUTPUTS};

const PAGE: &str = include_str!("../../../book/src/vehicle/fmu.md");

/// The first cell of a group's row.
fn cell(group: &Group) -> String {
    let mut parts = group.parts.iter();
    let first = parts.next().map(|part| format!(".{part}")).unwrap_or_default();
    let rest: String = parts.map(|part| format!(", `.{part}`")).collect();
    format!("| `{}{first}`{rest} | {} | ", group.name, group.unit)
}

#[test]
fn the_tables_have_every_signal_with_unit_meaning_and_default_names() {
    for (title, groups) in [("## Inputs", INPUTS.as_slice()), ("## Outputs", OUTPUTS.as_slice())] {
        let section =
            PAGE.split(title).nth(1).and_then(|text| text.split("\n## ").next()).expect("a section");
        let rows = section.lines().filter(|line| line.starts_with("| `")).count();
        assert_eq!(rows, groups.len() + usize::from(title == "## Inputs"), "{title}");
        for group in groups {
            let cell = cell(group);
            let row = section
                .lines()
                .find(|line| line.starts_with(&cell))
                .unwrap_or_else(|| panic!("no row {cell}"));
            let meaning = group.description.split(';').next().unwrap_or_default();
            assert!(row.replace('`', "").contains(meaning), "{row}: {meaning}");
            for (beginning, ends) in group.defaults {
                let name = format!("`{beginning}{}`", ends[0]);
                assert!(row.rsplit('|').nth(1).is_some_and(|names| names.contains(&name)), "{row}: {name}");
            }
        }
    }
    assert!(PAGE.contains(&format!("| `{ARMED}` | true or false | ")));
}

#[test]
fn the_example_is_a_map() {
    let text = PAGE.split("```toml\n").nth(1).and_then(|text| text.split("```").next()).expect("an example");
    let map = Map::parse(text).expect("a map");
    assert_eq!(map.role, Some(ForeignRole::Plant));
    assert_eq!(map.entries.len(), 23);
}
