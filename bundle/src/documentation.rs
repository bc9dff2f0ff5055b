//! documentation/index.html: the template with the generated parts put in.

use crate::failure::Failure;
use crate::product::Product;
use crate::{picture, variables};
use xtask::files;
use xtask::workspace::Workspace;

/// The page.
pub fn page(workspace: &Workspace, product: &Product, description: &str) -> Result<String, Failure> {
    let template = files::read_text(&workspace.fmu_assets().join(product.template))?;
    Ok(template
        .replace("{{version}}", env!("CARGO_PKG_VERSION"))
        .replace("{{flight}}", &picture::of_default_flight()?)
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
            let page = page(&workspace, product, &(product.description)()).expect("the page is made");
            assert!(!page.contains("{{") && !page.contains("}}"));
            // Well-formed, so that every browser shows the equations.
            let body = page.split_once("<html").map(|(_, rest)| format!("<html{rest}")).expect("is HTML");
            roxmltree::Document::parse(&body).expect("is well-formed");
        }
    }
}
