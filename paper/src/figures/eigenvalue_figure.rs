//! Eigenvalues in the complex plane.

use super::svg::{Anchor, Svg};
use super::{COLOURS, LIMIT};
use crate::eigenvalues::EigenvalueResult;

/// Half of the side of each of the two views, px.
const HALF: f64 = 205.0;
/// Half of what the whole view shows.
const WHOLE: f64 = 1.2;
/// Points of the unit circle.
const ARC: usize = 720;

/// A square part of the complex plane.
struct View {
    left: f64,
    centre: [f64; 2],
    half: f64,
}

impl View {
    fn at(&self, [re, im]: [f64; 2]) -> [f64; 2] {
        let zoom = HALF / self.half;
        [self.left + HALF + zoom * (re - self.centre[0]), HALF - zoom * (im - self.centre[1])]
    }
}

/// One controller's eigenvalues and the regulator's, with the unit circle, whole and close: Figure 4.
pub fn eigenvalue_figure(result: &EigenvalueResult) -> String {
    let title = format!("Closed-loop eigenvalues of the {} controller", result.controller);
    let mut svg = Svg::new(&title, 4.0 * HALF + 20.0, 2.0 * HALF);
    let whole = View { left: 0.0, centre: [0.0; 2], half: WHOLE };
    let close = close_view(result);
    for (name, view) in [("whole", &whole), ("close", &close)] {
        let name = format!("{}-{name}", result.controller);
        svg.clip(&name, [view.left, 0.0], [2.0 * HALF, 2.0 * HALF]);
        draw(&mut svg, view, result);
        svg.unclip();
        svg.rectangle([view.left, 0.0], [2.0 * HALF, 2.0 * HALF], "none", "#ccc");
    }
    for (value, name) in [([-1.0, 0.0], "−1"), ([1.0, 0.0], "1"), ([0.0, 1.0], "i"), ([0.0, -1.0], "−i")]
    {
        let [x, y] = whole.at(value);
        svg.text([x + 9.0, y - 5.0], Anchor::Middle, "#333", name);
    }
    let ends = [close.centre[0] - close.half, close.centre[0] + close.half];
    let range = format!("close: real part {:.2} to {:.2}", ends[0], ends[1]);
    svg.text([close.left + 10.0, 2.0 * HALF - 10.0], Anchor::Start, "#333", &range);
    svg.circle([18.0, 18.0], 6.0, "none", COLOURS[0], 2.0);
    svg.text([32.0, 22.0], Anchor::Start, "#333", &format!("LMPC, N = {}", result.n));
    cross(&mut svg, [18.0, 40.0]);
    svg.text([32.0, 44.0], Anchor::Start, "#333", "DLQR");
    svg.finish()
}

/// The square around all eigenvalues, with a margin.
fn close_view(result: &EigenvalueResult) -> View {
    let all = || result.lmpc.iter().chain(&result.dlqr);
    let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value[0]), high.max(value[0]))
    });
    let tall = all().fold(0.0_f64, |tall, value| tall.max(value[1].abs()));
    let half = 1.25 * tall.max((high - low) / 2.0).max(0.02);
    View { left: 2.0 * HALF + 20.0, centre: [(low + high) / 2.0, 0.0], half }
}

fn draw(svg: &mut Svg, view: &View, result: &EigenvalueResult) {
    svg.line(&[view.at([-9.0, 0.0]), view.at([9.0, 0.0])], "#ccc", 1.0, "");
    svg.line(&[view.at([0.0, -9.0]), view.at([0.0, 9.0])], "#ccc", 1.0, "");
    let angle = |index: usize| std::f64::consts::TAU * index as f64 / ARC as f64;
    let arc: Vec<[f64; 2]> =
        (0..=ARC).map(|index| view.at([angle(index).cos(), angle(index).sin()])).collect();
    svg.line(&arc, LIMIT, 1.0, "");
    for &eigenvalue in &result.dlqr {
        cross(svg, view.at(eigenvalue));
    }
    for &eigenvalue in &result.lmpc {
        svg.circle(view.at(eigenvalue), 6.0, "none", COLOURS[0], 2.0);
    }
}

fn cross(svg: &mut Svg, [x, y]: [f64; 2]) {
    svg.line(&[[x - 6.0, y], [x + 6.0, y]], COLOURS[1], 2.0, "");
    svg.line(&[[x, y - 6.0], [x, y + 6.0]], COLOURS[1], 2.0, "");
}
