//! Puts the memory's layout where the linker finds it, and asks for the recording.

use std::path::PathBuf;
use std::{env, fs};

/// The file that `cargo xtask microcontroller` writes.
const RECORDING: &str = "RECORDING";

fn main() {
    println!("cargo::rerun-if-changed=memory.x");
    println!("cargo::rerun-if-env-changed={RECORDING}");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::copy("memory.x", out.join("memory.x")).expect("the output folder can be written");
    println!("cargo::rustc-link-search={}", out.display());
    let Some(recording) = env::var_os(RECORDING) else {
        println!("cargo::error={RECORDING} must name a recording; build with `cargo xtask microcontroller`");
        return;
    };
    println!("cargo::rerun-if-changed={}", recording.display());
}
