//! Rows that several models have in their tables of variables.
//!
//! A row is generic over its model: what it reads and writes is reached through a small trait that the model's parameters,
//! inputs or outputs implement.

pub(crate) mod arrays;
pub(crate) mod disturbances;
pub(crate) mod figures;
pub(crate) mod ground;
pub(crate) mod identity;
pub(crate) mod motion;
pub(crate) mod numbers;
pub(crate) mod parameters;
pub(crate) mod ranges;
pub(crate) mod references;
pub(crate) mod rows;
pub(crate) mod steering;
pub(crate) mod terminals;
