//! An FMU file: the library, its description, documentation, icon and licences in one archive.

use std::path::{Path, PathBuf};

use fmi::description::TERMINALS_AND_ICONS;

use crate::archive::{Archive, MODEL_DESCRIPTION};
use crate::failure::Failure;
use crate::product::{PRODUCTS, Product, Version};
use crate::{documentation, licenses, merge, platform};
use xtask::files;
use xtask::platform::Platform;
use xtask::workspace::Workspace;

/// Everything that FMUs have in common.
struct Parts<'a> {
    workspace: &'a Workspace,
    libraries: &'a [(Platform, PathBuf)],
    licences: Vec<(&'static str, String)>,
    icon: Vec<u8>,
}

/// Writes all FMUs and prints their paths and sizes. `others` are FMUs of the same sources from other platforms: each goes into the
/// one that has the same description.
pub fn write_all(
    workspace: &Workspace,
    libraries: &[(Platform, PathBuf)],
    others: &[PathBuf],
) -> Result<(), Failure> {
    let licences = licenses::texts(workspace)?;
    let icon = files::read(&workspace.fmu_assets().join("model.png"))?;
    let parts = Parts { workspace, libraries, licences, icon };
    let products: Vec<_> =
        PRODUCTS.iter().flat_map(|product| Version::ALL.map(|version| (product, version))).collect();
    let descriptions: Vec<String> =
        products.iter().map(|(product, version)| product.description(*version)).collect();
    let places = others.iter().map(|other| place(other, &descriptions)).collect::<Result<Vec<_>, _>>()?;
    for (place, ((product, version), description)) in products.iter().zip(&descriptions).enumerate() {
        let same = others.iter().zip(&places).filter(|(_, other)| **other == place);
        let same: Vec<&Path> = same.map(|(path, _)| path.as_path()).collect();
        parts.write(product, *version, description, &same)?;
    }
    Ok(())
}

/// Which of the descriptions an FMU has.
fn place(other: &Path, descriptions: &[String]) -> Result<usize, Failure> {
    let description = merge::description(other)?;
    let same = descriptions.iter().position(|ours| *ours == description);
    same.ok_or_else(|| Failure::OtherModel { path: other.to_owned() })
}

impl Parts<'_> {
    fn write(
        &self,
        product: &Product,
        version: Version,
        description: &str,
        others: &[&Path],
    ) -> Result<(), Failure> {
        let mut archive = Archive::default();
        for (platform, library) in self.libraries {
            let entry = platform::entry(version, *platform, product.identifier);
            archive.add_binary(&entry, files::read(library)?);
        }
        let page = documentation::page(self.workspace, product, version)?;
        archive.add("documentation/index.html", page.into_bytes());
        archive.add(icon_path(version), self.icon.clone());
        if let Some(terminals) = product.terminals(version) {
            archive.add(TERMINALS_AND_ICONS, terminals.into_bytes());
        }
        for (name, text) in &self.licences {
            archive.add(&format!("{}/{name}", licences_folder(version)), text.clone().into_bytes());
        }
        for other in others {
            merge::binaries(&mut archive, other)?;
        }
        if version == Version::Two {
            platform::add_stand_ins(&mut archive);
        }
        archive.add(MODEL_DESCRIPTION, description.into());

        let path = product.path(self.workspace, version);
        let bytes = archive.into_bytes().map_err(|source| Failure::Archive { path: path.clone(), source })?;
        files::write(&path, &bytes)?;
        println!("{} ({:.0} kB)", self.workspace.shown(&path), bytes.len() as f64 / 1000.0);
        Ok(())
    }
}

/// FMI 2.0.4, section 2.3, and FMI 3.0.2, section 2.5.1: the icon belongs to the terminals there.
fn icon_path(version: Version) -> &'static str {
    match version {
        Version::Two => "model.png",
        Version::Three => "terminalsAndIcons/icon.png",
    }
}

/// The same sections.
fn licences_folder(version: Version) -> &'static str {
    match version {
        Version::Two => "licenses",
        Version::Three => "documentation/licenses",
    }
}

#[cfg(test)]
mod tests {
    use super::{Archive, Failure, files, place};

    #[test]
    fn an_fmu_belongs_to_the_one_with_its_description() {
        let mut archive = Archive::default();
        archive.add("modelDescription.xml", b"<b/>".to_vec());
        let path = std::env::temp_dir().join(format!("bundle-place-{}.fmu", std::process::id()));
        files::write(&path, &archive.into_bytes().expect("writes to memory")).expect("writes to a file");
        let descriptions = ["<a/>".to_owned(), "<b/>".to_owned()];
        let (found, missing) = (place(&path, &descriptions), place(&path, &descriptions[..1]));
        std::fs::remove_file(&path).expect("removes its own file");
        assert_eq!(found.ok(), Some(1));
        assert!(matches!(missing, Err(Failure::OtherModel { .. })));
    }
}
