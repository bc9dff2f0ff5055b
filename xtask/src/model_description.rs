//! `cargo xtask model-description`.

use crate::failure::Failure;
use crate::files;
use crate::workspace::Workspace;

/// Rewrites modelDescription.xml at the root of the repository.
pub fn write(workspace: &Workspace) -> Result<(), Failure> {
    let path = workspace.model_description();
    files::write(&path, fmi::description::model_description::<fmu::ClosedLoop>().as_bytes())?;
    println!("{}", workspace.shown(&path));
    Ok(())
}
