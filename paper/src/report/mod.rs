//! The results as one self-contained page.
//!
//! Each section is a file; `page` is what they write to.

mod bar_figures;
mod bars;
mod claim;
mod cost_figures;
mod flight_figures;
mod flights;
mod gaps;
mod page;
mod published;
mod robustness;
mod trade_off_figures;

pub use page::Page;

use crate::results::Results;

/// report.html and its figures.
pub fn report(results: &Results) -> Page {
    let mut page = Page::new("The paper, recomputed");
    page.paragraph(
        "M. Chipofya, D. J. Lee, K. T. Chong: <i>Trajectory Tracking and Stabilization of a Quadrotor Using Model \
         Predictive Control of Laguerre Functions</i>, Abstract and Applied Analysis, 2015. This program computed everything below in \
         one run; <code>results.json</code> beside this page has the numbers. Times depend on the machine, everything else is \
         the same on every machine.",
    );
    published::tables(&mut page, results);
    published::eigenvalues(&mut page, results);
    claim::section(&mut page, results);
    flights::section(&mut page, results);
    robustness::section(&mut page, results);
    bars::section(&mut page, results);
    gaps::section(&mut page, results);
    page
}
