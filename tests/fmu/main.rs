//! The built FMU library, loaded and called through its C interface.

#[path = "../common/mod.rs"]
mod common;

mod description;
mod flight;
mod input_derivatives;
mod lifecycle;
mod logging;
mod misuse;
mod parameters;
mod state;
mod stepping;
mod symbols;
mod threads;
mod values;

use std::sync::OnceLock;

use common::library::Library;

/// The library, loaded once for all tests of this executable.
fn library() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(Library::load)
}
