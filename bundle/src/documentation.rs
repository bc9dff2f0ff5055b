//! documentation/index.html: the page that all FMUs share, with the model's own part and the generated ones put in.

use crate::failure::Failure;
use crate::product::{Product, Version};
use crate::{enumerations, variables};
use xtask::files;
use xtask::workspace::Workspace;

/// The page.
pub fn page(workspace: &Workspace, product: &Product, version: Version) -> Result<String, Failure> {
    let asset = |name: &str| files::read_text(&workspace.fmu_assets().join(name));
    let description = product.description(version);
    let experiment = product.default_experiment;
    let page = asset("page.html")?
        .replace("{{model}}", &asset(product.page)?)
        .replace("{{frames}}", &asset("frames.html")?)
        .replace("{{vehicle}}", &asset("vehicle.html")?)
        .replace("{{import}}", &asset("import.html")?);
    Ok(of_version(&page, version)
        .replace("{{prefix}}", version.prefix())
        .replace("{{interface}}", version.name())
        .replace("{{file}}", &format!("{}.fmu", product.identifier))
        .replace("{{identifier}}", product.identifier)
        .replace("{{shown}}", product.shown(version))
        .replace("{{stop}}", &experiment.stop_time_s.to_string())
        .replace("{{step}}", &experiment.step_size_s.to_string())
        .replace("{{version}}", env!("CARGO_PKG_VERSION"))
        .replace("{{flight}}", &(product.picture)(experiment.stop_time_s)?)
        .replace("{{enumerations}}", &enumerations::tables(&description)?)
        .replace("{{variables}}", &variables::tables(&description)?))
}

/// The page without the parts of other versions: those stand between lines of `{{fmi2}}` and `{{/fmi2}}`, or of `{{fmi3}}` and `{{/fmi3}}`.
fn of_version(page: &str, version: Version) -> String {
    let mut text = String::with_capacity(page.len());
    let mut shown = true;
    for line in page.split_inclusive('\n') {
        let mark = line.trim_end();
        let begins = Version::ALL.into_iter().find(|version| mark == format!("{{{{{}}}}}", version.prefix()));
        let ends = Version::ALL.into_iter().any(|version| mark == format!("{{{{/{}}}}}", version.prefix()));
        match begins {
            Some(other) => shown = other == version,
            None if ends => shown = true,
            None if shown => text.push_str(line),
            None => {}
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{of_version, page};
    use crate::product::{PRODUCTS, Version};
    use xtask::workspace::Workspace;

    #[test]
    fn a_page_has_the_parts_of_its_version() {
        let both = "a\n{{fmi2}}\ntwo\n{{/fmi2}}\n{{fmi3}}\nthree\n{{/fmi3}}\nb\n";
        assert_eq!(of_version(both, Version::Two), "a\ntwo\nb\n");
        assert_eq!(of_version(both, Version::Three), "a\nthree\nb\n");
    }

    #[test]
    fn every_place_holder_is_filled() {
        let workspace = Workspace::find().expect("cargo knows the workspace");
        for product in &PRODUCTS {
            for version in Version::ALL {
                let page = page(&workspace, product, version).expect("the page is made");
                assert!(!page.contains("{{") && !page.contains("}}"));
                let other = if version == Version::Two { "fmi3" } else { "fmi2" };
                assert!(!page.contains(other), "a function of the other version");
                // Telephones and narrow windows.
                assert!(page.contains("name=\"viewport\""));
                // Well-formed, so that every browser shows the equations.
                let body = page.split_once("<html").map(|(_, rest)| format!("<html{rest}")).expect("is HTML");
                roxmltree::Document::parse(&body).expect("is well-formed");
            }
        }
    }
}
