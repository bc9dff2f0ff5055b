//! The FMU file: the library, its description, documentation, icon and licences in one archive.

use std::path::PathBuf;

use crate::archive::{Archive, MODEL_DESCRIPTION};
use crate::failure::Failure;
use crate::{documentation, licenses, merge, platform};
use xtask::files;
use xtask::platform::Platform;
use xtask::workspace::Workspace;

/// Writes the FMU and prints its path and size. `others` are FMUs of the same sources from other platforms.
pub fn write(
    workspace: &Workspace,
    libraries: &[(Platform, PathBuf)],
    others: &[PathBuf],
) -> Result<(), Failure> {
    let description = fmi::description::model_description::<fmu::ClosedLoop>();
    let mut archive = Archive::default();
    for (platform, library) in libraries {
        archive.add_binary(&platform::entry(*platform), files::read(library)?);
    }
    archive.add("documentation/index.html", documentation::page(workspace, &description)?.into_bytes());
    archive.add("model.png", files::read(&workspace.fmu_assets().join("model.png"))?);
    for (name, text) in licenses::texts(workspace)? {
        archive.add(&format!("licenses/{name}"), text.into_bytes());
    }
    for other in others {
        merge::binaries(&mut archive, other, &description)?;
    }
    platform::add_stand_ins(&mut archive);
    archive.add(MODEL_DESCRIPTION, description.into_bytes());

    let path = workspace.fmu();
    let bytes = archive.into_bytes().map_err(|source| Failure::Archive { path: path.clone(), source })?;
    files::write(&path, &bytes)?;
    println!("{} ({:.0} kB)", workspace.shown(&path), bytes.len() as f64 / 1000.0);
    Ok(())
}

#[cfg(test)]
mod tests {
    use fmi::Model;
    use fmu::ClosedLoop;
    use xtask::workspace::Workspace;

    /// Importers expect the file to be named after the model.
    #[test]
    fn the_file_is_named_after_the_model() {
        let workspace = Workspace::find().expect("cargo knows the workspace");
        let name = format!("{}.fmu", ClosedLoop::IDENTITY.model_identifier);
        assert_eq!(workspace.fmu().file_name(), Some(name.as_ref()));
    }
}
