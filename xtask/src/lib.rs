//! What the build tooling's programs share: questions to cargo, files, other programs, platforms, and the layout of the repository.

pub mod cargo;
pub mod failure;
pub mod files;
pub mod platform;
pub mod process;
pub mod workspace;
