//! Tables 2 and 3 and Figure 4.

use super::Page;
use crate::figures::{COLOURS, Figure, Line, Panel, eigenvalue_figure, line_chart};
use crate::results::Results;
use crate::tables::ScaleRow;

/// N of the paper's Figure 4.
const FIGURE_TERMS: usize = 5;
const CONTROLLERS: [&str; 3] = ["altitude", "position", "attitude"];

pub fn tables(page: &mut Page, results: &Results) {
    page.heading("Tables 2 and 3: the scaling factor for a control horizon");
    page.paragraph("(58): a ≈ e<sup>−N/N<sub>c</sub></sup>. All printed digits agree.");
    scale_table(page, "Table 2: N = 5", &results.table2);
    scale_table(page, "Table 3: a control horizon of 30", &results.table3);
}

fn scale_table(page: &mut Page, title: &str, rows: &[ScaleRow]) {
    page.subheading(title);
    let rows: Vec<Vec<String>> = rows
        .iter()
        .map(|row| {
            vec![
                row.n_c.to_string(),
                row.n.to_string(),
                format!("{:.5}", row.a),
                format!("{:.4}", row.printed),
            ]
        })
        .collect();
    page.table(&["N<sub>c</sub>", "N", "a", "a, printed"], &rows);
}

pub fn eigenvalues(page: &mut Page, results: &Results) {
    page.heading("Figure 4: eigenvalues of LMPC and DLQR, α = 1.2, a = 0.8187");
    page.paragraph(
        "The paper shows the altitude controller; here are all three, with its Q = CᵀC, and with ΔT = 0.05 s (altitude, position), 0.01 s \
         (attitude), R = I and N<sub>p</sub> = 100, which it does not give. The weights are transformed so that \
         α = 1.2 keeps the regulator's optimum (Wang 2009, chapter 4): with the literal recipe of (51)–(57) the altitude loop \
         is unstable, its largest eigenvalue has magnitude 1.019.",
    );
    let shown = results.figure4.iter().filter(|result| result.n == FIGURE_TERMS);
    let figures = shown.map(|result| Figure {
        name: format!("figure4-{}", result.controller),
        caption: format!("{}: at most {:.1e} apart", result.controller, result.max_distance),
        svg: eigenvalue_figure(result),
    });
    page.figures(figures.collect());
    page.subheading("The same for N = 1 … 15");
    page.figures(vec![sweep_figure(results)]);
    if results.figure4.len() < 3 * 15 {
        page.paragraph(
            "Missing rows: with so few terms and our R, the closed loop is unstable, and the design is rejected.",
        );
    }
    let rows: Vec<Vec<String>> = results
        .figure4
        .iter()
        .map(|result| {
            vec![
                result.controller.to_owned(),
                result.n.to_string(),
                format!("{:.4}", result.spectral_radius),
                format!("{:.1e}", result.max_distance),
                format!("{:.3}", result.condition_weighted),
                format!("{:.1e}", result.condition_unweighted),
            ]
        })
        .collect();
    page.table(
        &[
            "controller",
            "N",
            "spectral radius",
            "largest distance to DLQR",
            "condition of Ω",
            "… without weighting",
        ],
        &rows,
    );
}

fn sweep_figure(results: &Results) -> Figure {
    let line = |index: usize, label: String, value: &dyn Fn(&crate::eigenvalues::EigenvalueResult) -> f64| {
        let points = results
            .figure4
            .iter()
            .filter(|result| result.controller == CONTROLLERS[index])
            .map(|result| [result.n as f64, value(result)]);
        Line::new(label, COLOURS[index], points.collect()).marked()
    };
    let name = |index: usize| CONTROLLERS[index].to_owned();
    let distance = (0..3).map(|index| line(index, name(index), &|result| result.max_distance));
    let weighted = (0..3).map(|index| line(index, name(index), &|result| result.condition_weighted));
    let unweighted = (0..3).map(|index| {
        line(index, format!("{}, not weighted", CONTROLLERS[index]), &|result| result.condition_unweighted)
            .dashed()
    });
    let panels = [
        Panel::new("distance of the eigenvalues from DLQR's", "N", "largest distance", distance.collect())
            .logarithmic(),
        Panel::new("conditioning", "N", "condition number of Ω", weighted.chain(unweighted).collect())
            .logarithmic(),
    ];
    Figure {
        name: "figure4-sweep".to_owned(),
        caption: "Figure 4 for N = 1 … 15: LMPC converges to DLQR as N grows; exponential weighting keeps Ω well conditioned."
            .to_owned(),
        svg: line_chart("sweep", "Eigenvalues and conditioning over N", 2, [480.0, 320.0], &panels),
    }
}
