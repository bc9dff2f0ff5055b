//! The program as a user runs it.

use std::io::pipe;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

/// The paper's altitude model (9) with its N, a and α.
const ALTITUDE: &str = include_str!("altitude.toml");

/// A file of its own for each test.
fn model(name: &str, text: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, text).unwrap();
    path
}

fn gain(model: &PathBuf, stdout: Stdio) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_paper"));
    program.arg("--gain").arg(model).stdout(stdout).stderr(Stdio::piped());
    program.spawn().unwrap().wait_with_output().unwrap()
}

#[test]
fn gain_prints_json_whose_keys_say_what_they_are() {
    let output = gain(&model("named.toml", ALTITUDE), Stdio::piped());
    assert!(output.status.success(), "{output:?}");
    let design: Value = serde_json::from_slice(&output.stdout).unwrap();
    let keys: Vec<&String> = design.as_object().unwrap().keys().collect();
    assert_eq!(
        keys,
        [
            "closed_loop_eigenvalues",
            "condition_unweighted",
            "condition_weighted",
            "k_dlqr",
            "k_lmpc",
            "spectral_radius"
        ]
    );
    let eigenvalues = |controller: &str| -> Vec<[f64; 2]> {
        serde_json::from_value(design["closed_loop_eigenvalues"][controller].clone()).unwrap()
    };
    // numpy.linalg.eigvals(A − B K) with K from scipy.linalg.solve_discrete_are.
    let dlqr = eigenvalues("dlqr");
    assert_eq!((dlqr.len(), eigenvalues("lmpc").len()), (3, 3));
    for [re, im] in [[0.873_177_06, 0.0], [0.927_847_2, 0.109_561_88], [0.927_847_2, -0.109_561_88]] {
        assert!(dlqr.iter().any(|found| (found[0] - re).hypot(found[1] - im) < 1e-4), "{re} {im}: {dlqr:?}");
    }
    let apart = design["closed_loop_eigenvalues"]["max_distance"].as_f64().unwrap();
    assert!(apart < 0.01, "{apart}");
}

/// As in `… | head -0`: the reader is gone before the first line.
#[test]
fn a_closed_pipe_ends_the_program_quietly() {
    let (reader, writer) = pipe().unwrap();
    drop(reader);
    let output = gain(&model("piped.toml", ALTITUDE), writer.into());
    assert!(output.status.success(), "{output:?}");
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

#[test]
fn an_invalid_model_is_reported_in_one_line() {
    let unstable = ALTITUDE.replace("terms = [5]", "terms = [0]");
    let output = gain(&model("invalid.toml", &unstable), Stdio::piped());
    assert_eq!(output.status.code(), Some(1));
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(message, "error: invalid design: the number of Laguerre terms N must be at least 1\n");
}
