//! What the build tooling's programs share: questions to cargo, files, other programs, and the layout of the repository.

pub mod cargo;
pub mod failure;
pub mod files;
pub mod process;
pub mod workspace;
