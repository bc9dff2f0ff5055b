//! An FMU of version 3.0, from that of version 2.0 of the same model: the same libraries under other names of platforms, another
//! description, and the documentation that belongs to it.

use crate::archive::{Archive, MODEL_DESCRIPTION};
use crate::documentation::{self, PAGE};
use crate::failure::Failure;
use crate::platform_tuple;
use crate::product::Product;
use xtask::workspace::Workspace;

/// The archive of version 3.0. A library of an unknown platform is an error.
pub fn from_version_2(
    workspace: &Workspace,
    product: &Product,
    second: &Archive,
) -> Result<Archive, Failure> {
    let mut third = Archive::default();
    for (path, bytes, is_library) in second.entries() {
        if is_library {
            let file = path.rsplit('/').next().unwrap_or(path);
            let tuples = platform_tuple::of_library(bytes);
            if tuples.is_empty() {
                return Err(Failure::UnknownLibrary { path: path.to_owned() });
            }
            for tuple in tuples {
                third.add_binary(&format!("binaries/{tuple}/{file}"), bytes.to_vec());
            }
        } else {
            third.add(path, bytes.to_vec());
        }
    }
    let description = (product.description3)();
    let page = documentation::page(workspace, product, "3.0", &description)?;
    third.add(PAGE, page.into_bytes());
    third.add(MODEL_DESCRIPTION, description.into_bytes());
    Ok(third)
}

#[cfg(test)]
mod tests {
    use xtask::workspace::Workspace;

    use super::from_version_2;
    use crate::archive::Archive;
    use crate::failure::Failure;
    use crate::product::CLOSED_LOOP;

    #[test]
    fn libraries_lie_under_their_platform_tuples() {
        let workspace = Workspace::find().expect("cargo knows the workspace");
        let own = std::fs::read(std::env::current_exe().expect("it runs")).expect("it is a file");
        let mut second = Archive::default();
        second.add_binary("binaries/any/LmpcQuadrotor.so", own.clone());
        second.add("licenses/MIT.txt", b"MIT".to_vec());
        second.add("modelDescription.xml", b"of 2.0".to_vec());
        let third = from_version_2(&workspace, &CLOSED_LOOP, &second).expect("it is made");
        if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
            assert!(third.has_folder("binaries/x86_64-linux"));
        }
        let paths: Vec<&str> = third.entries().map(|(path, ..)| path).collect();
        assert_eq!(paths.len(), 4, "{paths:?}");
        let text = |wanted: &str| {
            let (_, bytes, _) = third.entries().find(|(path, ..)| *path == wanted).expect("it is there");
            String::from_utf8(bytes.to_vec()).expect("it is text")
        };
        assert!(text("modelDescription.xml").contains("fmiVersion=\"3.0\""));
        assert!(text("documentation/index.html").contains("<code>position[3]</code></td><td>m</td>"));
        assert_eq!(text("licenses/MIT.txt"), "MIT");

        second.add_binary("binaries/other/LmpcQuadrotor.so", b"no library".to_vec());
        let refused = from_version_2(&workspace, &CLOSED_LOOP, &second);
        assert!(matches!(refused, Err(Failure::UnknownLibrary { .. })));
    }
}
