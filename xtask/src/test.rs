//! `cargo xtask test`: every test there is.

use std::io::{BufRead, BufReader};
use std::ops::AddAssign;
use std::path::Path;
use std::process::Stdio;
use std::thread;

use roxmltree::Document;

use crate::browser::Browser;
use crate::fmu;
use crate::program::{self, Beside, VEHICLE};
use crate::progress::Progress;
use crate::python::{self, Interpreter, Packages, Python};
use crate::threads;
use crate::wheel;
use xtask::cargo::cargo;
use xtask::failure::Failure;
use xtask::files;
use xtask::process;
use xtask::workspace::Workspace;

/// Environment variable by which a test knows that the Python tests follow.
pub const ALL_TESTS: &str = "LMPC_QUADROTOR_ALL_TESTS";

/// Python tests that run at once, per core: most wait for a vehicle most of the time.
const PYTHON_TESTS_PER_CORE: usize = 2;

/// Tests that ran.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Count {
    passed: u32,
    failed: u32,
    skipped: u32,
}

impl AddAssign for Count {
    fn add_assign(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.skipped += other.skipped;
    }
}

/// Runs all tests, the Python ones also when Rust ones failed, and prints one line at the end. Those of the live page need a browser.
pub fn run_all(workspace: &Workspace, progress: &Progress, in_browser: bool) -> Result<(), Failure> {
    // First: what is missing on the machine is said before the long build.
    let interpreter = python::interpreter()?;
    let (python, rust) = thread::scope(|scope| {
        let python = scope.spawn(|| {
            let browser = Browser::provide(workspace, progress, in_browser);
            let python = python::environment(workspace, progress, &interpreter, browser.packages())?;
            Ok::<_, Failure>((python, browser))
        });
        let rust = progress.timed("Running the Rust tests", || rust_tests(workspace));
        (threads::join(python), rust)
    });
    let ((python, browser), (mut count, rust_passed)) = (python?, rust?);

    let fmu = fmu::make(workspace, progress, &[], Beside::Tests)?;
    let sitl = progress
        .timed("Building the MAVLink vehicle", || program::build(workspace, VEHICLE, Beside::Tests))?;
    let mut python_passed = true;
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let processes = (PYTHON_TESTS_PER_CORE * cores).to_string();
    // ROS 2 is left to `cargo xtask ros2`.
    let marks = if in_browser { "not alone and not ros2" } else { "not alone and not ros2 and not browser" };
    let at_once = ["-m", marks, "--numprocesses", &processes, "--dist", "worksteal"];
    // Those that measure the wall clock have the machine to themselves.
    let alone = ["-m", if in_browser { "alone" } else { "alone and not browser" }];
    let runs: [(&str, &[&str]); 2] =
        [("Running the Python tests", &at_once), ("Running the Python tests that measure time", &alone)];
    for (what, options) in runs {
        let (counted, passed) =
            progress.timed(what, || python_tests(workspace, &python, options, &fmu, &sitl))?;
        count += counted;
        python_passed &= passed;
    }

    let (counted, package_passed) = package_tests(workspace, progress, &interpreter, &sitl, Beside::Tests)?;
    count += counted;

    let mut failed = Vec::new();
    if !rust_passed {
        failed.push("Rust tests");
    }
    if !python_passed {
        failed.push("Python tests");
    }
    if !package_passed {
        failed.push("tests of the Python package");
    }
    let Count { passed, failed: count_failed, skipped } = count;
    progress.print_summary();
    if let Some(note) = browser.note() {
        println!("note: {note}");
    }
    println!("note: Windows and Linux on ARM are left to `cargo xtask platforms`");
    println!("total: {passed} passed, {count_failed} failed, {skipped} skipped");
    if failed.is_empty() { Ok(()) } else { Err(Failure::Tests { failed: failed.join(" and ") }) }
}

/// Runs the tests of the Python package alone.
pub fn run_package(workspace: &Workspace, progress: &Progress) -> Result<(), Failure> {
    let interpreter = python::interpreter()?;
    if !workspace.fmu().is_file() {
        fmu::make(workspace, progress, &[], Beside::Nothing)?;
    }
    let sitl = progress
        .timed("Building the MAVLink vehicle", || program::build(workspace, VEHICLE, Beside::Nothing))?;
    let (count, passed) = package_tests(workspace, progress, &interpreter, &sitl, Beside::Nothing)?;
    progress.print_summary();
    println!("total: {} passed, {} failed, {} skipped", count.passed, count.failed, count.skipped);
    if passed { Ok(()) } else { Err(Failure::Tests { failed: "tests of the Python package".to_owned() }) }
}

/// Runs `cargo test` for the whole workspace, passing its output on while counting.
fn rust_tests(workspace: &Workspace) -> Result<(Count, bool), Failure> {
    let mut command = cargo();
    command
        .args(["test", "--workspace", "--no-fail-fast"])
        .current_dir(workspace.root())
        .env(ALL_TESTS, "1")
        .stdout(Stdio::piped());
    let mut child = command.spawn().map_err(|source| process::not_started(&command, source))?;
    let mut count = Count::default();
    if let Some(stdout) = child.stdout.take() {
        for line in BufReader::new(stdout).lines().map_while(Result::ok) {
            println!("{line}");
            count += rust_count(&line);
        }
    }
    let status = child.wait().map_err(|source| process::not_started(&command, source))?;
    Ok((count, status.success()))
}

/// Runs Python tests with some options of pytest.
fn python_tests(
    workspace: &Workspace,
    python: &Python,
    options: &[&str],
    fmu: &Path,
    sitl: &Path,
) -> Result<(Count, bool), Failure> {
    let report = workspace.python_report();
    let status = process::status(
        python
            .command()
            .args(["-m", "pytest", "-p", "no:cacheprovider"])
            .args(options)
            .arg(workspace.python_tests())
            .arg(format!("--junitxml={}", report.display()))
            .current_dir(workspace.root())
            .env("LMPC_QUADROTOR_FMU", fmu)
            .env("LMPC_QUADROTOR_EXAMPLES", workspace.examples())
            .env("LMPC_SITL", sitl),
    )?;
    Ok((python_count(&files::read_text(&report)?)?, status.success()))
}

/// Builds the Python package with the FMUs and the vehicle that there are, installs it where nothing else of ours is, and tests it there.
fn package_tests(
    workspace: &Workspace,
    progress: &Progress,
    interpreter: &Interpreter,
    sitl: &Path,
    beside: Beside,
) -> Result<(Count, bool), Failure> {
    let wheel = wheel::make_for_tests(workspace, progress, interpreter, sitl, beside)?;
    let python = python::environment(workspace, progress, interpreter, Packages::Package)?;
    progress.timed("Installing the Python package", || python.install_wheel(&wheel))?;
    let (tests, report) = (workspace.package_tests(), workspace.package_report());
    let status = progress.timed("Testing the Python package", || {
        process::status(
            python
                .command()
                .args(["-m", "pytest", "-p", "no:cacheprovider", "--numprocesses", "2"])
                .arg("-c")
                .arg(tests.join("pytest.ini"))
                .arg(&tests)
                .arg(format!("--junitxml={}", report.display()))
                // Away from the sources, so that nothing is imported from there.
                .current_dir(python.programs())
                .env("LMPC_QUADROTOR_ROOT", workspace.root()),
        )
    })?;
    Ok((python_count(&files::read_text(&report)?)?, status.success()))
}

/// Reads `test result: ok. 3 passed; 0 failed; 1 ignored; …`.
fn rust_count(line: &str) -> Count {
    let mut count = Count::default();
    let Some(result) = line.strip_prefix("test result: ") else { return count };
    for part in result.split(['.', ';']) {
        let mut words = part.split_whitespace();
        let Some(number) = words.next().and_then(|word| word.parse().ok()) else { continue };
        match words.next() {
            Some("passed") => count.passed = number,
            Some("failed") => count.failed = number,
            Some("ignored") => count.skipped = number,
            _ => {}
        }
    }
    count
}

/// Reads the attributes of `<testsuite>` in a JUnit report.
fn python_count(report: &str) -> Result<Count, Failure> {
    let unreadable = |detail: String| Failure::Answer { what: "pytest's report", detail };
    let document = Document::parse(report).map_err(|error| unreadable(error.to_string()))?;
    let suite = document
        .descendants()
        .find(|node| node.has_tag_name("testsuite"))
        .ok_or_else(|| unreadable("it has no test suite".to_owned()))?;
    let number = |name| suite.attribute(name).and_then(|text| text.parse::<u32>().ok()).unwrap_or(0);
    let (failed, skipped) = (number("failures") + number("errors"), number("skipped"));
    Ok(Count { passed: number("tests").saturating_sub(failed + skipped), failed, skipped })
}

#[cfg(test)]
mod tests {
    use super::{Count, python_count, rust_count};

    #[test]
    fn reads_the_line_of_a_rust_suite() {
        let line = "test result: FAILED. 12 passed; 2 failed; 1 ignored; 0 measured; 3 filtered out; finished in 0.10s";
        assert_eq!(rust_count(line), Count { passed: 12, failed: 2, skipped: 1 });
        assert_eq!(rust_count("test lmpc::works ... ok"), Count::default());
    }

    #[test]
    fn reads_the_report_of_pytest() {
        let report = r#"<?xml version="1.0"?><testsuites><testsuite name="pytest" errors="1" failures="2" skipped="3" tests="10"/></testsuites>"#;
        assert_eq!(python_count(report).ok(), Some(Count { passed: 4, failed: 3, skipped: 3 }));
        assert!(python_count("<testsuites/>").is_err());
    }
}
