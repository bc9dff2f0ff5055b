//! The trade-off over N, a, α and the placing of limits.

use crate::constrained_step::{ALPHAS, AXES, ExcessCost, LAST, PLACED_TERMS, SCALES, TERMS, TradeOff};
use crate::figures::{COLOURS, Figure, HeatMap, Line, Panel, heat_maps, line_chart};

/// Range of the colours, %.
const RANGE: [f64; 2] = [0.01, 100.0];
const UNIT: &str = "cost above the optimum, %, worst step of the axis";
const EMPTY: &str = "rejected: unstable";

/// The column of the scaling factor closest to a.
fn nearest(a: f64) -> Option<usize> {
    let distance = |column: &usize| (SCALES[*column] - a).abs();
    (0..SCALES.len()).min_by(|one, other| distance(one).total_cmp(&distance(other)))
}

fn names<T: ToString>(values: &[T]) -> Vec<String> {
    values.iter().map(T::to_string).collect()
}

/// Excess over N and a.
pub fn scales_and_terms(trade_off: &TradeOff) -> Figure {
    let map = |axis: &str| {
        let (n, a) = trade_off.default_of(axis).map_or((0, f64::NAN), |design| (design.n, design.a));
        let marked_row = TERMS.iter().position(|terms| *terms == n);
        HeatMap {
            title: format!("{axis}, default N = {n}, a = {a:.2}"),
            x_label: "a".to_owned(),
            y_label: "N".to_owned(),
            columns: names(&SCALES),
            rows: names(&TERMS),
            values: TERMS.map(|n| row(trade_off, axis, "N and a", |design| design.n == n)).to_vec(),
            marked: marked_row.zip(nearest(a)).map(|(row, column)| [row, column]),
        }
    };
    Figure {
        name: "trade-off-terms".to_owned(),
        caption: "Default placing of limits: over N and a. a = 0 moves N times beside the stabilizing feedback. Framed: the \
                  default N, in the column closest to the default a. Limits between the chosen samples are not seen, so that more terms do not always cost less."
            .to_owned(),
        svg: heat_maps("Excess cost over N and a", UNIT, RANGE, EMPTY, 2, &AXES.map(map)),
    }
}

/// Excess over α and a for N = 5.
pub fn scales_and_alphas(trade_off: &TradeOff) -> Figure {
    let map = |axis: &str| HeatMap {
        title: format!("{axis}, N = 5"),
        x_label: "a".to_owned(),
        y_label: "α".to_owned(),
        columns: names(&SCALES),
        rows: ALPHAS
            .iter()
            .map(|alpha| if *alpha == 1.0 { "1, P".to_owned() } else { alpha.to_string() })
            .collect(),
        values: ALPHAS.map(|alpha| row(trade_off, axis, "α and a", |design| design.alpha == alpha)).to_vec(),
        marked: SCALES.iter().position(|a| *a == 0.8187).map(|column| [7, column]),
    };
    Figure {
        name: "trade-off-alpha".to_owned(),
        caption: "The paper's program over a finite horizon, without stabilizing feedback, on the same models and limits, N = 5: over α and \
                  a; “1, P” is the Riccati solution as terminal weight. Framed: the paper's α = 1.2 and a = 0.8187."
            .to_owned(),
        svg: heat_maps("Excess cost of the paper's program over α and a", UNIT, RANGE, EMPTY, 2, &AXES.map(map)),
    }
}

fn row(
    trade_off: &TradeOff,
    axis: &str,
    grid: &str,
    in_row: impl Fn(&ExcessCost) -> bool,
) -> Vec<Option<f64>> {
    SCALES
        .iter()
        .map(|a| {
            trade_off
                .grid(axis, grid)
                .find(|design| design.a == *a && in_row(design))
                .and_then(|design| design.worst_excess_percent)
        })
        .collect()
}

/// Excess over the last sample with limits.
pub fn placings(trade_off: &TradeOff) -> Figure {
    let panels: Vec<Panel> = AXES
        .into_iter()
        .map(|axis| {
            let value = |design: &ExcessCost| design.worst_excess_percent.unwrap_or(f64::NAN).max(1e-3);
            let mut lines = Vec::new();
            for (index, n) in PLACED_TERMS.into_iter().enumerate() {
                let designs = || trade_off.grid(axis, "placing").filter(move |design| design.n == n);
                let contiguous: Vec<[f64; 2]> = designs()
                    .filter_map(|design| Some([design.limited.as_ref()?.len() as f64, value(design)]))
                    .collect();
                lines.push(Line::new(format!("N = {n}"), COLOURS[index], contiguous).marked());
                if let Some(own) = designs().find(|design| design.limited.is_none()) {
                    let across = [1.0, LAST[LAST.len() - 1] as f64 + 1.0].map(|x| [x, value(own)]);
                    lines.push(Line::new("", COLOURS[index], across.to_vec()).dashed());
                }
            }
            Panel::new(axis, "limits on the first … samples", "cost above optimum, %", lines)
                .logarithmic()
                .with_range(7e-4, 1000.0)
        })
        .collect();
    Figure {
        name: "trade-off-placing".to_owned(),
        caption: "Over the placing of limits: solid on the first samples without a gap, dashed on the samples that fly.".to_owned(),
        svg: line_chart("placing", "Excess cost over the placing of limits", 2, [490.0, 260.0], &panels),
    }
}
