//! Cost against time, per axis.

use crate::constrained_step::CostResult;
use crate::figures::{COLOURS, Figure, Line, Panel, Scale, line_chart};

/// One step of each axis, on which limits are active.
const SHOWN: [&str; 4] =
    ["position step of 20 m", "altitude step of 5 m up", "roll step of 1 rad", "yaw step of 1 rad"];
/// What is cheaper than this share above the optimum is drawn at it.
const LEAST_PERCENT: f64 = 1e-3;

/// A family of controllers: its name, colour, and what their names begin and end with.
type Family = (&'static str, &'static str, &'static str, &'static [&'static str]);

const FAMILIES: [Family; 4] = [
    ("LMPC, N = 1, 3, 5, 7, 8, 9", COLOURS[0], "LMPC", &[""]),
    ("finite LMPC, terminal weight, N = 5, 9", COLOURS[2], "finite LMPC", &["terminal weight"]),
    ("SS-MPC, 25 and 50 moves", COLOURS[1], "SS-MPC", &["25", "50"]),
    ("SS-MPC with terminal weight, 25 and 50 moves", COLOURS[3], "SS-MPC", &["terminal weight"]),
];

/// Cost above the optimum over the time of a sample at a limit.
pub fn cost_and_time(costs: &[CostResult]) -> Figure {
    let panels: Vec<Panel> = SHOWN
        .iter()
        .map(|problem| {
            let of = |(name, colour, start, end): Family| {
                let points = costs
                    .iter()
                    .filter(|cost| cost.problem == *problem && cost.controller.starts_with(start))
                    .filter(|cost| end.iter().any(|end| cost.controller.ends_with(end)))
                    .filter_map(|cost| {
                        let time = cost.p99_us?;
                        let percent = 100.0 * (cost.ratio_to_optimum? - 1.0);
                        Some([time, percent.max(LEAST_PERCENT)])
                    });
                Line::new(name, colour, points.collect()).marked()
            };
            let lines = FAMILIES.into_iter().map(of).collect();
            let panel = Panel::new(
                *problem,
                "99th percentile of the time per sample, µs",
                "cost above the optimum, %",
                lines,
            );
            Panel { x_scale: Scale::Logarithmic, ..panel.logarithmic().with_range(7e-4, 500.0) }
        })
        .collect();
    Figure {
        name: "cost-and-time".to_owned(),
        caption: "Cost against time; lower left is better. Each line connects increasing numbers of unknowns. What is \
                  less than 0.001 % above the optimum is drawn there."
            .to_owned(),
        svg: line_chart("cost-and-time", "Cost against time", 2, [490.0, 300.0], &panels),
    }
}
