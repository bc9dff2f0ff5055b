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
    Ok(asset("page.html")?
        .replace("{{model}}", &asset(product.page)?)
        .replace("{{frames}}", &asset("frames.html")?)
        .replace("{{vehicle}}", &asset("vehicle.html")?)
        .replace("{{import}}", &asset("import.html")?)
        .replace("{{interface}}", version.name())
        .replace("{{file}}", &format!("{}.fmu", product.identifier))
        .replace("{{identifier}}", product.identifier)
        .replace("{{shown}}", product.shown)
        .replace("{{stop}}", &experiment.stop_time_s.to_string())
        .replace("{{step}}", &experiment.step_size_s.to_string())
        .replace("{{version}}", env!("CARGO_PKG_VERSION"))
        .replace("{{flight}}", &(product.picture)(experiment.stop_time_s)?)
        .replace("{{enumerations}}", &enumerations::tables(&description)?)
        .replace("{{variables}}", &variables::tables(&description)?))
}

#[cfg(test)]
mod tests {
    use super::page;
    use crate::product::{PRODUCTS, Version};
    use xtask::workspace::Workspace;

    #[test]
    fn every_place_holder_is_filled() {
        let workspace = Workspace::find().expect("cargo knows the workspace");
        for product in &PRODUCTS {
            for version in Version::ALL {
                let page = page(&workspace, product, version).expect("the page is made");
                assert!(!page.contains("{{") && !page.contains("}}"));
                // Telephones and narrow windows.
                assert!(page.contains("name=\"viewport\""));
                // Well-formed, so that every browser shows the equations.
                let body = page.split_once("<html").map(|(_, rest)| format!("<html{rest}")).expect("is HTML");
                roxmltree::Document::parse(&body).expect("is well-formed");
            }
        }
    }
}
