//! The trade-off over N, a, α and the placing of limits.

use crate::constrained_step::{ALPHAS, Axis, ExcessCost, LAST, PLACED_TERMS, SCALES, TERMS, TradeOff};
use crate::figures::{COLOURS, Figure, HeatMap, Line, Panel, heat_maps, line_chart};

/// Range of the colours, %.
const RANGE: [f64; 2] = [0.01, 100.0];
const UNIT: &str = "cost above the optimum, %, worst step of the axis";
const EMPTY: &str = "rejected: unstable";

fn of<'a>(trade_off: &'a TradeOff, axis: &Axis, grid: &'a str) -> impl Iterator<Item = &'a ExcessCost> {
    let name = axis.name;
    trade_off.designs.iter().filter(move |design| design.axis == name && design.grid == grid)
}

fn names<T: ToString>(values: &[T]) -> Vec<String> {
    values.iter().map(T::to_string).collect()
}

/// Excess over N and a with the terminal weight.
pub fn scales_and_terms(trade_off: &TradeOff) -> Figure {
    let map = |axis: &Axis| HeatMap {
        title: format!("{}, default a = {}", axis.name, axis.scale),
        x_label: "a".to_owned(),
        y_label: "N".to_owned(),
        columns: names(&SCALES),
        rows: names(&TERMS),
        values: TERMS.map(|n| row(trade_off, axis, "N and a", |design| design.n == n)).to_vec(),
        marked: SCALES.iter().position(|a| *a == axis.scale).map(|column| [4, column]),
    };
    Figure {
        name: "trade-off-terms".to_owned(),
        caption: "Terminal weight, default placing of limits: over N and a. a = 0 is state-space MPC with N moves. Framed: \
                  the default. With few terms a decides everything; more terms at a fixed a do not always cost less, \
                  because limits between the chosen samples and beyond the last one are not seen."
            .to_owned(),
        svg: heat_maps("Excess cost over N and a", UNIT, RANGE, EMPTY, 2, &Axis::all().map(|axis| map(&axis))),
    }
}

/// Excess over α and a for N = 5.
pub fn scales_and_alphas(trade_off: &TradeOff) -> Figure {
    let map = |axis: &Axis| HeatMap {
        title: format!("{}, N = 5", axis.name),
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
        caption: "N = 5, default placing: over α and a; “1, P” is the Riccati solution as terminal weight. Framed: the \
                  paper's α = 1.2 and a = 0.8187."
            .to_owned(),
        svg: heat_maps("Excess cost over α and a", UNIT, RANGE, EMPTY, 2, &Axis::all().map(|axis| map(&axis))),
    }
}

fn row(
    trade_off: &TradeOff,
    axis: &Axis,
    grid: &str,
    in_row: impl Fn(&ExcessCost) -> bool,
) -> Vec<Option<f64>> {
    SCALES
        .iter()
        .map(|a| {
            of(trade_off, axis, grid)
                .find(|design| design.a == *a && in_row(design))
                .and_then(|design| design.worst_excess_percent)
        })
        .collect()
}

/// Excess over the last sample with limits.
pub fn placings(trade_off: &TradeOff) -> Figure {
    let mut panels = Vec::new();
    for axis in Axis::all() {
        for (recipe, terminal) in [("terminal weight", true), ("α = 1.2, a = 0.8187", false)] {
            let of_recipe = |n: usize| {
                of(trade_off, &axis, "placing").filter(move |d| d.n == n && (d.alpha == 1.0) == terminal)
            };
            let mut lines = Vec::new();
            for (index, n) in PLACED_TERMS.into_iter().enumerate() {
                let value = |design: &ExcessCost| design.worst_excess_percent.unwrap_or(f64::NAN).max(1e-3);
                let contiguous: Vec<[f64; 2]> = LAST
                    .iter()
                    .filter_map(|last| {
                        of_recipe(n).find(|design| design.limited.iter().copied().eq(0..=*last))
                    })
                    .map(|design| [design.limited.len() as f64, value(design)])
                    .collect();
                lines.push(Line::new(format!("N = {n}"), COLOURS[index], contiguous).marked());
                if let Some(own) = of_recipe(n).find(|design| design.limited == axis.limited) {
                    let across = [1.0, LAST[LAST.len() - 1] as f64 + 1.0].map(|x| [x, value(own)]);
                    lines.push(Line::new("", COLOURS[index], across.to_vec()).dashed());
                }
            }
            let panel = Panel::new(
                format!("{}, {recipe}", axis.name),
                "limits on the first … samples",
                "cost above optimum, %",
                lines,
            );
            panels.push(panel.logarithmic().with_range(7e-4, 1000.0));
        }
    }
    Figure {
        name: "trade-off-placing".to_owned(),
        caption: "Over the placing of limits: solid on the first samples without a gap, dashed on the default list of samples. \
                  Left with the terminal weight and the default a, right with the paper's α and a."
            .to_owned(),
        svg: line_chart("placing", "Excess cost over the placing of limits", 2, [490.0, 260.0], &panels),
    }
}
