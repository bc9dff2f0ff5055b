//! The built library through its C interface, as an importer sees it, and its description as a validator
//! reads it. The C types are written again from the headers, not taken from the library.

// Each test target uses its part.
#![allow(dead_code)]

pub mod description;
pub mod instance;
pub mod library;
