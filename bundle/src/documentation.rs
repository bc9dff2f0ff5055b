//! documentation/index.html: the page that all FMUs share, with the model's own part and the generated ones put in.

use crate::failure::Failure;
use crate::product::Product;
use crate::{enumerations, picture, variables};
use xtask::files;
use xtask::workspace::Workspace;

/// Where it lies in an FMU.
pub const PAGE: &str = "documentation/index.html";

/// The page for a version of FMI, with the variables of its description.
pub fn page(
    workspace: &Workspace,
    product: &Product,
    fmi_version: &str,
    description: &str,
) -> Result<String, Failure> {
    let asset = |name: &str| files::read_text(&workspace.fmu_assets().join(name));
    let experiment = product.default_experiment;
    Ok(asset("page.html")?
        .replace("{{model}}", &asset(product.page)?)
        .replace("{{fmi}}", fmi_version)
        .replace("{{import}}", &asset("import.html")?)
        .replace("{{identifier}}", product.identifier)
        .replace("{{shown}}", product.shown)
        .replace("{{stop}}", &experiment.stop_time_s.to_string())
        .replace("{{step}}", &experiment.step_size_s.to_string())
        .replace("{{version}}", env!("CARGO_PKG_VERSION"))
        .replace("{{flight}}", &picture::of_default_flight(experiment.stop_time_s)?)
        .replace("{{enumerations}}", &enumerations::tables(description)?)
        .replace("{{variables}}", &variables::tables(description)?))
}

#[cfg(test)]
mod tests {
    use super::page;
    use crate::product::PRODUCTS;
    use xtask::workspace::Workspace;

    #[test]
    fn every_place_holder_is_filled() {
        let workspace = Workspace::find().expect("cargo knows the workspace");
        for product in &PRODUCTS {
            for (version, description) in [("2.0", product.description), ("3.0", product.description3)] {
                let page = page(&workspace, product, version, &description()).expect("the page is made");
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
