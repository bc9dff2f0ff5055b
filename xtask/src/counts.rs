//! `cargo xtask counts`: whether work takes more instructions than it took.
//!
//! Times of a shared machine say little, instructions are nearly the same each time. The program `counts` does a piece of work as often as
//! it is told; valgrind counts, and the difference between two numbers of times is the work without what prepares it.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde::{Deserialize, Serialize};

use crate::program::{self, Beside};
use crate::progress::Progress;
use xtask::cargo;
use xtask::failure::Failure;
use xtask::files;
use xtask::process;
use xtask::workspace::Workspace;

/// The program whose instructions are counted.
const PROGRAM: &str = "counts";
/// What counts instructions.
const VALGRIND: &str = "valgrind";
/// By how much a count may exceed its reference.
const MOST: f64 = 1.1;
/// From which share of its reference on a count is worth a new one.
const LITTLE: f64 = 0.9;

/// What work takes, and what it was compiled with: another compiler makes other instructions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Counts {
    /// Version and machine, as the compiler says them.
    compiler: String,
    /// Instructions of each piece of work, done once.
    instructions: BTreeMap<String, u64>,
}

/// Counts, and compares with the reference or, on `update`, replaces it.
pub fn run(workspace: &Workspace, progress: &Progress, update: bool) -> Result<(), Failure> {
    let program = progress
        .timed("Building what is counted", || program::build_as_in_ci(workspace, PROGRAM, Beside::Nothing))?;
    let counts = progress.timed("Counting instructions", || count(&program))?;
    let file = workspace.root().join("counts").join("reference.json");
    if update {
        let json = serde_json::to_string_pretty(&counts).unwrap_or_default() + "\n";
        files::write(&file, json.as_bytes())?;
        println!("{}", workspace.shown(&file));
        return Ok(());
    }
    let reference: Counts = serde_json::from_str(&files::read_text(&file)?)
        .map_err(|error| Failure::Answer { what: "counts/reference.json", detail: error.to_string() })?;
    let (table, exceeded) = compared(&reference, &counts);
    print!("{table}");
    if exceeded.is_empty() {
        return Ok(());
    }
    Err(Failure::MoreInstructions { exceeded: exceeded.join(", "), remedy: remedy(&reference, &counts) })
}

/// Counts all pieces of work.
fn count(program: &Path) -> Result<Counts, Failure> {
    let listed = process::output(&mut Command::new(program), PROGRAM)?;
    let listed = String::from_utf8_lossy(&listed).into_owned();
    let mut instructions = BTreeMap::new();
    for line in listed.lines() {
        let no_times =
            || Failure::Answer { what: PROGRAM, detail: format!("no number of times in {line:?}") };
        let (name, times) = line.split_once('\t').ok_or_else(no_times)?;
        let times: u64 = times.parse().map_err(|_| no_times())?;
        let (once, more) = (counted(program, name, times)?, counted(program, name, 2 * times)?);
        instructions.insert(name.to_owned(), more.saturating_sub(once) / times);
    }
    Ok(Counts { compiler: cargo::compiler()?, instructions })
}

/// All instructions of the program that does a piece of work so often.
fn counted(program: &Path, name: &str, times: u64) -> Result<u64, Failure> {
    let mut command = Command::new(VALGRIND);
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]);
    command.arg(program).arg(name).arg(times.to_string()).stdout(Stdio::null());
    let Output { status, stderr, .. } = command.output().map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => Failure::Missing {
            program: VALGRIND.to_owned(),
            remedy: "on Debian and Ubuntu: apt-get install valgrind",
        },
        _ => process::not_started(&command, source),
    })?;
    let said = String::from_utf8_lossy(&stderr);
    if !status.success() {
        eprint!("{said}");
        return Err(Failure::Ended { what: format!("counting {name}"), status });
    }
    total(&said).ok_or_else(|| Failure::Answer {
        what: VALGRIND,
        detail: "its output has no line “Collected”".to_owned(),
    })
}

/// The number in valgrind's line "==7== Collected : 1234".
fn total(said: &str) -> Option<u64> {
    said.lines().find_map(|line| line.split_once("Collected : ")?.1.trim().parse().ok())
}

/// A table of both, and what takes too many, with both numbers.
fn compared(reference: &Counts, counts: &Counts) -> (String, Vec<String>) {
    let mut table = format!("{:<26} {:>12} {:>12} {:>8}\n", "instructions", "reference", "now", "change");
    let mut exceeded = Vec::new();
    for (name, now) in &counts.instructions {
        let Some(before) = reference.instructions.get(name) else {
            exceeded.push(format!("{name}: {now}, but the reference has no entry"));
            continue;
        };
        let ratio = *now as f64 / *before as f64;
        let note = if ratio < LITTLE { "  (make it the reference: --update)" } else { "" };
        table += &format!("{name:<26} {before:>12} {now:>12} {:>+7.1}%{note}\n", 100.0 * (ratio - 1.0));
        if ratio > MOST {
            exceeded.push(format!("{name}: {now} instructions, {before} in the reference"));
        }
    }
    let lost = reference.instructions.keys().filter(|name| !counts.instructions.contains_key(*name));
    exceeded.extend(lost.map(|name| format!("{name}: in the reference, but not counted")));
    (table, exceeded)
}

fn remedy(reference: &Counts, counts: &Counts) -> String {
    let update = "if that is wanted, run cargo xtask counts --update and commit counts/reference.json";
    if reference.compiler == counts.compiler {
        return update.to_owned();
    }
    let (before, now) = (&reference.compiler, &counts.compiler);
    format!("the reference was made with another compiler, {before}; this one is {now}; {update}")
}

#[cfg(test)]
mod tests {
    use super::{Counts, compared, remedy, total};

    fn counts(compiler: &str, numbers: &[(&str, u64)]) -> Counts {
        let instructions = numbers.iter().map(|(name, number)| ((*name).to_owned(), *number)).collect();
        Counts { compiler: compiler.to_owned(), instructions }
    }

    #[test]
    fn valgrind_tells_the_total() {
        let said = "==7== Callgrind\n==7== \n==7== Events    : Ir\n==7== Collected : 1234567\n==7== \n";
        assert_eq!(total(said), Some(1_234_567));
        assert_eq!(total("valgrind: no such file"), None);
    }

    #[test]
    fn a_tenth_more_is_too_much_and_is_told_with_both_numbers() {
        let reference = counts("rustc 1", &[("step", 1000), ("tick", 2000)]);
        assert!(compared(&reference, &counts("rustc 1", &[("step", 1100), ("tick", 1500)])).1.is_empty());
        let (table, exceeded) = compared(&reference, &counts("rustc 1", &[("step", 1101), ("tick", 2000)]));
        assert_eq!(exceeded, ["step: 1101 instructions, 1000 in the reference"]);
        assert!(table.contains("+10.1%"), "{table}");
    }

    #[test]
    fn what_is_counted_is_what_there_is_a_reference_of() {
        let reference = counts("rustc 1", &[("step", 1000), ("tick", 2000)]);
        let (_, exceeded) = compared(&reference, &counts("rustc 1", &[("step", 1000), ("second", 5)]));
        assert_eq!(exceeded.len(), 2, "{exceeded:?}");
    }

    #[test]
    fn another_compiler_is_named() {
        let (one, other) = (counts("rustc 1", &[]), counts("rustc 2", &[]));
        assert!(!remedy(&one, &one).contains("compiler"));
        let told = remedy(&one, &other);
        assert!(told.contains("rustc 1") && told.contains("rustc 2") && told.contains("--update"), "{told}");
    }
}
