//! `modelDescription.xml` in both versions, written from the table of variables.
//!
//! `fmi2` and `fmi3` write the documents; they share `document` (what surrounds the variables), `units`, `dependencies` and `numbers`.

mod dependencies;
mod document;
mod fmi2;
mod fmi3;
mod numbers;
mod units;

pub use fmi2::model_description;
pub use fmi3::model_description3;
