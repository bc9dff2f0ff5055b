//! Compiles the one function that Rust cannot define.

fn main() {
    println!("cargo::rerun-if-changed=src/fmi2/logger.c");
    cc::Build::new().file("src/fmi2/logger.c").warnings(true).extra_warnings(true).compile("importer_logger");
}
