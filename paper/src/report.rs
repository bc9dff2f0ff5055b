//! The results as one self-contained page.

use std::fmt::Write;

use crate::eigenvalue_figure::eigenvalue_figure;
use crate::results::Results;
use crate::tables::ScaleRow;

/// N of the paper's Figure 4.
const FIGURE_TERMS: usize = 5;

/// report.html.
pub fn report(results: &Results) -> String {
    let mut page = String::from(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>The paper, computed again</title>\n\
         <style>body{font-family:sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;line-height:1.5}\
         table{border-collapse:collapse;margin:1rem 0}td,th{border:1px solid #ccc;padding:.2rem .6rem;text-align:right}\
         .figures{display:flex;flex-wrap:wrap}figure{margin:0 1rem 1rem 0}figcaption{text-align:center}</style></head><body>\n\
         <h1>The paper, computed again</h1>\n\
         <p>Chipofya, Lee, Chong 2015. What the paper leaves open is ours: sample times of 0.05 s (altitude, position) and 0.01 s \
         (attitude), Q = CᵀC, R = I, N_p = 100. The weights are transformed so that α = 1.2 keeps the regulator's optimum \
         (Wang 2009, chapter 4); the literal recipe is unstable for the altitude controller.</p>\n",
    );
    scale_table(&mut page, "Table 2: a for N = 5", &results.table2);
    scale_table(&mut page, "Table 3: a for a control horizon of 30", &results.table3);
    page.push_str(
        "<h2>Figure 4: eigenvalues of LMPC and DLQR, α = 1.2, a = 0.8187</h2>\n<div class=\"figures\">\n",
    );
    for result in results.figure4.iter().filter(|result| result.n == FIGURE_TERMS) {
        let _ = writeln!(
            page,
            "<figure>{}<figcaption>{}: at most {:.1e} apart</figcaption></figure>",
            eigenvalue_figure(result),
            result.controller,
            result.max_distance,
        );
    }
    page.push_str("</div>\n<h2>The same for N = 1 … 15</h2>\n");
    sweep_table(&mut page, results);
    cost_table(&mut page, results);
    page.push_str("</body></html>\n");
    page
}

fn cost_table(page: &mut String, results: &Results) {
    page.push_str(
        "<h2>What a few coefficients cost</h2>\n\
         <p>A position step of 5 m north and 5 m east with the tilt limited to 0.3 rad jointly and its increments to 0.1 rad, \
         over the first 15 samples, on the linear model; times of one run. The optimum has 60 free moves per input under limits \
         on all of them.</p>\n\
         <table><tr><th>controller</th><th>unknowns per input</th><th>cost over the optimum</th><th>median, µs</th>\
         <th>99 %, µs</th><th>most iterations</th></tr>\n",
    );
    for result in &results.closed_loop_cost {
        let _ = writeln!(
            page,
            "<tr><td>{}</td><td>{}</td><td>{:+.2} %</td><td>{:.1}</td><td>{:.1}</td><td>{}</td></tr>",
            result.controller,
            result.n,
            100.0 * (result.ratio_to_optimum.unwrap_or(f64::NAN) - 1.0),
            result.median_us.unwrap_or(f64::NAN),
            result.p99_us.unwrap_or(f64::NAN),
            result.worst_iterations.unwrap_or(0),
        );
    }
    page.push_str("</table>\n");
}

fn scale_table(page: &mut String, title: &str, rows: &[ScaleRow]) {
    let _ = writeln!(
        page,
        "<h2>{title}</h2>\n<table><tr><th>N_c</th><th>N</th><th>a</th><th>a, printed</th></tr>"
    );
    for row in rows {
        let _ = writeln!(
            page,
            "<tr><td>{}</td><td>{}</td><td>{:.5}</td><td>{:.4}</td></tr>",
            row.n_c, row.n, row.a, row.printed
        );
    }
    page.push_str("</table>\n");
}

fn sweep_table(page: &mut String, results: &Results) {
    page.push_str(
        "<p>Missing rows: with so few terms the closed loop is not stable, and the design is refused.</p>\n\
         <table><tr><th>controller</th><th>N</th><th>spectral radius</th><th>largest distance to DLQR</th>\
         <th>condition of Ω</th><th>… without weighting</th></tr>\n",
    );
    for result in &results.figure4 {
        let _ = writeln!(
            page,
            "<tr><td>{}</td><td>{}</td><td>{:.4}</td><td>{:.1e}</td><td>{:.3}</td><td>{:.1e}</td></tr>",
            result.controller,
            result.n,
            result.spectral_radius,
            result.max_distance,
            result.condition_weighted,
            result.condition_unweighted,
        );
    }
    page.push_str("</table>\n");
}
