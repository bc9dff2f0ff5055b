//! The built libraries through its C interface, as an importer sees it, and their descriptions as a validator
//! reads it. The C types are written again from the headers, not taken from the libraries.

// Each test target uses its part.
#![allow(dead_code)]

pub mod description;
pub mod fmi3;
pub mod instance;
pub mod library;
pub mod loading;
mod plant_sample;
pub mod subject;
