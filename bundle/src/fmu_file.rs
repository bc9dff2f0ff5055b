//! An FMU file: the library, its description, documentation, icon and licences in one archive.

use std::path::{Path, PathBuf};

use crate::archive::{Archive, MODEL_DESCRIPTION};
use crate::failure::Failure;
use crate::product::{PRODUCTS, Product};
use crate::{documentation, licenses, merge, platform};
use xtask::files;
use xtask::platform::Platform;
use xtask::workspace::Workspace;

/// Writes all FMUs and prints their paths and sizes. `others` are FMUs of the same sources from other platforms: each goes into the
/// FMU of the same name.
pub fn write_all(
    workspace: &Workspace,
    libraries: &[(Platform, PathBuf)],
    others: &[PathBuf],
) -> Result<(), Failure> {
    let of =
        |product: &Product, other: &Path| other.file_stem().is_some_and(|stem| stem == product.identifier);
    if let Some(path) = others.iter().find(|other| !PRODUCTS.iter().any(|product| of(product, other))) {
        return Err(Failure::OtherModel { path: path.clone() });
    }
    let licences = licenses::texts(workspace)?;
    for product in &PRODUCTS {
        let others = others.iter().filter(|other| of(product, other));
        write(workspace, product, libraries, &licences, others)?;
    }
    Ok(())
}

fn write<'a>(
    workspace: &Workspace,
    product: &Product,
    libraries: &[(Platform, PathBuf)],
    licences: &[(&str, String)],
    others: impl Iterator<Item = &'a PathBuf>,
) -> Result<(), Failure> {
    let description = (product.description)();
    let mut archive = Archive::default();
    for (platform, library) in libraries {
        archive.add_binary(&platform::entry(*platform, product.identifier), files::read(library)?);
    }
    let page = documentation::page(workspace, product, &description)?;
    archive.add("documentation/index.html", page.into_bytes());
    archive.add("model.png", files::read(&workspace.fmu_assets().join("model.png"))?);
    for (name, text) in licences {
        archive.add(&format!("licenses/{name}"), text.clone().into_bytes());
    }
    for other in others {
        merge::binaries(&mut archive, other, &description)?;
    }
    platform::add_stand_ins(&mut archive);
    archive.add(MODEL_DESCRIPTION, description.into_bytes());

    let path = workspace.fmus().join(format!("{}.fmu", product.identifier));
    let bytes = archive.into_bytes().map_err(|source| Failure::Archive { path: path.clone(), source })?;
    files::write(&path, &bytes)?;
    println!("{} ({:.0} kB)", workspace.shown(&path), bytes.len() as f64 / 1000.0);
    Ok(())
}
