//! Eigenvalues in the complex plane, as SVG.

use std::fmt::Write;

use crate::eigenvalues::EigenvalueResult;

/// Pixels from the origin to the unit circle.
const RADIUS: f64 = 190.0;
/// Half of the picture's side.
const CENTRE: f64 = 220.0;

/// One controller's eigenvalues and the regulator's, with the unit circle: Figure 4.
pub fn eigenvalue_figure(result: &EigenvalueResult) -> String {
    let side = 2.0 * CENTRE;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {side} {side}\" width=\"{side}\" height=\"{side}\" \
         role=\"img\" font-family=\"sans-serif\" font-size=\"13\">\
         <title>Closed-loop eigenvalues of the {} controller</title>\
         <rect width=\"{side}\" height=\"{side}\" fill=\"white\"/>\
         <g stroke=\"#ccc\"><path d=\"M0 {CENTRE}H{side}M{CENTRE} 0V{side}\"/></g>\
         <circle cx=\"{CENTRE}\" cy=\"{CENTRE}\" r=\"{RADIUS}\" fill=\"none\" stroke=\"#555\"/>\
         <text x=\"{}\" y=\"{}\" fill=\"#555\">1</text>",
        result.controller,
        CENTRE + RADIUS + 4.0,
        CENTRE - 5.0,
    );
    let at = |[re, im]: [f64; 2]| (CENTRE + RADIUS * re, CENTRE - RADIUS * im);
    for &eigenvalue in &result.dlqr {
        let (x, y) = at(eigenvalue);
        // Writing to a string does not fail.
        let _ = write!(
            svg,
            "<path d=\"M{} {y:.2}h12m-6 -6v12\" stroke=\"#d55e00\" stroke-width=\"2\"/>",
            x - 6.0
        );
    }
    for &eigenvalue in &result.lmpc {
        let (x, y) = at(eigenvalue);
        let _ = write!(
            svg,
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"6\" fill=\"none\" stroke=\"#0072b2\" stroke-width=\"2\"/>"
        );
    }
    let _ = write!(
        svg,
        "<g><circle cx=\"18\" cy=\"18\" r=\"6\" fill=\"none\" stroke=\"#0072b2\" stroke-width=\"2\"/>\
         <text x=\"32\" y=\"23\">LMPC, N = {}</text>\
         <path d=\"M12 40h12m-6 -6v12\" stroke=\"#d55e00\" stroke-width=\"2\"/><text x=\"32\" y=\"45\">DLQR</text></g></svg>",
        result.n
    );
    svg
}
