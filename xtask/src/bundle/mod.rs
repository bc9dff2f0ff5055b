//! The FMU: an archive of the library, its description, documentation, icon and licences.
//!
//! ```text
//! modelDescription.xml        fmi::description of fmu::ClosedLoop
//! model.png                   fmu/assets
//! binaries/linux64/….so       library, merge
//! documentation/index.html    documentation ◄─ variables, picture
//! licenses/                   licenses
//! ```

mod archive;
mod chart;
mod documentation;
mod library;
mod licenses;
mod merge;
mod picture;
mod variables;

use std::path::PathBuf;

use crate::failure::Failure;
use crate::files;
use crate::progress::Progress;
use crate::workspace::Workspace;
use archive::Archive;

/// Builds the FMU, prints its path and size, and returns its path.
pub fn make(workspace: &Workspace, progress: &Progress, others: &[PathBuf]) -> Result<PathBuf, Failure> {
    progress.step("Building the FMU");
    let description = fmi::description::model_description::<fmu::ClosedLoop>();
    let library = library::build(workspace)?;

    let mut archive = Archive::default();
    archive.add_binary(&library.entry, library.bytes);
    archive.add("documentation/index.html", documentation::page(workspace, &description)?.into_bytes());
    archive.add("model.png", files::read(&workspace.fmu_assets().join("model.png"))?);
    for (name, text) in licenses::texts(workspace)? {
        archive.add(&format!("licenses/{name}"), text.into_bytes());
    }
    for other in others {
        merge::binaries(&mut archive, other, &description)?;
    }
    archive.add(archive::MODEL_DESCRIPTION, description.into_bytes());

    let path = workspace.fmu();
    let bytes = archive.into_bytes().map_err(|source| Failure::Archive { path: path.clone(), source })?;
    files::write(&path, &bytes)?;
    println!("{} ({:.0} kB)", workspace.shown(&path), bytes.len() as f64 / 1000.0);
    Ok(path)
}
