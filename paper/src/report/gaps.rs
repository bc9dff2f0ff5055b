//! What the paper leaves open or misprints, and where its method loses.

use super::Page;

pub fn section(page: &mut Page, _results: &crate::results::Results) {
    page.heading("What the paper does not fix, and our choice");
}
