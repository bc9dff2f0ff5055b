//! What the wind acts through: a drag that nobody has asked for is said.

use std::process::Command;

use clap::Parser;
use sitl::configuration::{Arguments, MemberSettings, Settings};
use sitl::hil::HilSettings;
use vehicle::{Notice, Severity};

fn arguments(line: &str) -> Arguments {
    Arguments::try_parse_from(std::iter::once("lmpc-sitl").chain(line.split_whitespace())).expect(line)
}

fn settings(line: &str) -> Settings {
    Settings::resolve(&arguments(line)).expect(line)
}

fn drag_n_s_m(own: &MemberSettings) -> [f64; 3] {
    own.vehicle.configuration.airframe.drag_n_s_m
}

/// What is said without a warning.
fn infos(notes: Vec<Notice>) -> Vec<String> {
    notes.into_iter().filter(|note| note.severity == Severity::Info).map(|note| note.text).collect()
}

const PROVIDED: &str =
    "wind needs drag: FRAME_DRAG_X, FRAME_DRAG_Y, FRAME_DRAG_Z set to 0.15 N·s/m; change it with --set";
const NO_DRAG: &str = "wind has no effect: FRAME_DRAG_X, FRAME_DRAG_Y, FRAME_DRAG_Z are 0";

#[test]
fn a_drag_that_nobody_has_asked_for_is_said_and_another_is_left_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        path.display().to_string()
    };
    let (draggy, without) = (
        file("draggy.params", "FRAME_DRAG_X 0.3\nFRAME_DRAG_Y 0.3\nFRAME_DRAG_Z 0.4\n"),
        file("without.params", "FRAME_DRAG_X 0\nFRAME_DRAG_Y 0\nFRAME_DRAG_Z 0\n"),
    );
    let of_y_and_z = PROVIDED.replace("FRAME_DRAG_X, ", "");
    let usual = "--set FRAME_DRAG_X=0.15 --set FRAME_DRAG_Y=0.15 --set FRAME_DRAG_Z=0.15";
    for (line, drag, expected) in [
        ("--seed 3", [0.0; 3], None),
        ("--wind 0,90 --gusts 0", [0.0; 3], None),
        ("--wind 5", [0.15; 3], Some(PROVIDED)),
        ("--gusts 1 --set FRAME_MASS=0.8", [0.15; 3], Some(PROVIDED)),
        ("--wind 5 --vehicles 3 --autopilot ardupilot", [0.15; 3], Some(PROVIDED)),
        ("--wind 5 --set FRAME_DRAG_X=0", [0.0, 0.15, 0.15], Some(of_y_and_z.as_str())),
        (&format!("--wind 5 {usual}"), [0.15; 3], None),
        (
            "--wind 5 --set airframe.drag.x=1 --set airframe.drag.y=1 --set FRAME_DRAG_Z=2",
            [1.0, 1.0, 2.0],
            None,
        ),
        (&format!("--wind 5 --parameters {draggy}"), [0.3, 0.3, 0.4], None),
        (&format!("--wind 5 --parameters {without}"), [0.0; 3], Some(NO_DRAG)),
        (&format!("--gusts 2 --parameters {draggy} {}", usual.replace("0.15", "0")), [0.0; 3], Some(NO_DRAG)),
        (&format!("--parameters {without}"), [0.0; 3], None),
    ] {
        let settings = settings(line);
        assert!(settings.vehicles.iter().all(|own| drag_n_s_m(own) == drag), "{line}");
        assert_eq!(infos(settings.notes), Vec::from_iter(expected), "{line}");
    }
    let hil = HilSettings::resolve(&arguments("--wind 5"), "0").expect("settings");
    assert_eq!(infos(hil.notes), [PROVIDED]);
}

/// Parameter files of their own may differ.
#[test]
fn vehicles_that_differ_are_told_apart() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("a-2.params"), "FRAME_DRAG_X 1\nFRAME_DRAG_Y 1\nFRAME_DRAG_Z 1\n")
        .expect("written");
    let line = format!("--vehicles 3 --wind 5 --parameters {}", folder.path().join("a.params").display());
    let expected = [1, 3].map(|system| format!("system {system}: {PROVIDED}"));
    assert_eq!(infos(settings(&line).notes), expected);
}

#[test]
fn it_is_a_line_of_the_programs_log() {
    let log = |line: &str| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_lmpc-sitl"));
        program.args("--link udpin:0 --duration 0".split(' ')).args(line.split_whitespace());
        let done = program.output().expect("the program runs");
        let log = String::from_utf8(done.stderr).expect("text");
        assert!(done.status.success(), "{log}");
        log
    };
    let windy = log("--wind 5,90");
    assert!(windy.lines().any(|line| line.contains("INFO") && line.ends_with(PROVIDED)), "{windy}");
    assert_eq!(log("").lines().filter(|line| line.contains("drag")).count(), 0);
}
