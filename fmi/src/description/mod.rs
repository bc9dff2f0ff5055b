//! `modelDescription.xml` in both versions, written from the table of variables.
//!
//! `fmi2` and `fmi3` write the documents, `terminals` the groups of variables that are connected together; they share `document` (what
//! surrounds the variables), `units`, `dependencies` and `numbers`.

mod dependencies;
mod document;
mod fmi2;
mod fmi3;
mod numbers;
mod terminals;
mod units;

pub use fmi2::model_description;
pub use fmi3::model_description3;
pub use terminals::{TERMINALS_AND_ICONS, terminals_and_icons, terminals_and_icons3};
