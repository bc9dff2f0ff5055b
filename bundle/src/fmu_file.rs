//! An FMU file: the library, its description, documentation, icon and licences in one archive.

use std::path::{Path, PathBuf};

use crate::archive::{Archive, MODEL_DESCRIPTION};
use crate::failure::Failure;
use crate::product::{PRODUCTS, Product};
use crate::{documentation, fmi3_file, licenses, merge, platform};
use xtask::files;
use xtask::workspace::Workspace;

/// Writes all FMUs and prints their paths and sizes. `others` are FMUs of the same sources from other platforms: each goes into the
/// FMU of the same name.
pub fn write_all(workspace: &Workspace, library: &Path, others: &[PathBuf]) -> Result<(), Failure> {
    let of =
        |product: &Product, other: &Path| other.file_stem().is_some_and(|stem| stem == product.identifier);
    if let Some(path) = others.iter().find(|other| !PRODUCTS.iter().any(|product| of(product, other))) {
        return Err(Failure::OtherModel { path: path.clone() });
    }
    let licences = licenses::texts(workspace)?;
    for product in &PRODUCTS {
        let others = others.iter().filter(|other| of(product, other));
        write(workspace, product, library, &licences, others)?;
    }
    Ok(())
}

fn write<'a>(
    workspace: &Workspace,
    product: &Product,
    library: &Path,
    licences: &[(&str, String)],
    others: impl Iterator<Item = &'a PathBuf>,
) -> Result<(), Failure> {
    let description = (product.description)();
    let mut archive = Archive::default();
    archive.add_binary(&platform::entry(product.identifier)?, files::read(library)?);
    let page = documentation::page(workspace, product, "2.0", &description)?;
    archive.add(documentation::PAGE, page.into_bytes());
    archive.add("model.png", files::read(&workspace.fmu_assets().join("model.png"))?);
    for (name, text) in licences {
        archive.add(&format!("licenses/{name}"), text.clone().into_bytes());
    }
    for other in others {
        merge::binaries(&mut archive, other, &description)?;
    }
    archive.add(MODEL_DESCRIPTION, description.into_bytes());

    let third = fmi3_file::from_version_2(workspace, product, &archive)?;
    let name = format!("{}.fmu", product.identifier);
    save(workspace, archive, workspace.fmus().join(&name))?;
    save(workspace, third, workspace.fmus3().join(&name))
}

fn save(workspace: &Workspace, archive: Archive, path: PathBuf) -> Result<(), Failure> {
    let bytes = archive.into_bytes().map_err(|source| Failure::Archive { path: path.clone(), source })?;
    files::write(&path, &bytes)?;
    println!("{} ({:.0} kB)", workspace.shown(&path), bytes.len() as f64 / 1000.0);
    Ok(())
}
