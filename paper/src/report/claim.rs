//! The claim in numbers: tables of cost and time.

use super::cost_figures::cost_and_time;
use super::page::{Page, percent};
use super::trade_off_figures::{placings, scales_and_alphas, scales_and_terms};
use crate::constrained_step::CostResult;
use crate::results::Results;

pub fn section(page: &mut Page, results: &Results) {
    page.heading("The claim in numbers: the cost of using few coefficients under limits");
    page.paragraph(
        "Steps from rest on the linear models that the controllers predict with, with their weights and limits in hover: position over \
         the closed attitude loop, north and east together, under limits of tilt, its rate and acceleration, and speed; altitude over the \
         rotors' lag, under limits of acceleration and speed; roll and pitch together, and yaw, over the rotors' lag, under the thrusts \
         of the four rotors. The optimum is one quadratic program over the whole step of 600 samples under all limits at all \
         samples, solved by Clarabel, an independent interior-point solver.",
    );
    page.subheading("Cost above the optimum");
    excess_table(page, &results.closed_loop_cost);
    page.paragraph(
        "Position, roll, pitch and yaw fly with N = 8 by default, altitude with N = 7; here every N has the default a of its loop. \
         LMPC predicts about a slow stabilizing feedback, over an infinite horizon. “Finite” is the paper's program without that feedback, \
         over N<sub>p</sub> samples, with the Riccati solution as terminal weight or with the paper's α = 1.2 and a = 0.8187. A value \
         below zero means that the controller exceeded a limit, as clipped DLQR does, which has no limits of speed or rates.",
    );
    page.subheading("Time per sample");
    time_table(page, &results.closed_loop_cost);
    page.paragraph(
        "Median and 99th percentile over the whole step, and the median of those samples at which limits were active, in \
         µs, one core, one run; reading the clock takes about 0.03 µs of each. Where no limit is active, LMPC is one \
         matrix–vector product and a check of the limits. State-space MPC uses the same active-set solver as LMPC; \
         Clarabel solves the same program, set up once, with only gradient and bounds replaced.",
    );
    page.figures(vec![cost_and_time(&results.closed_loop_cost)]);
    page.subheading("The whole trade-off");
    let trade_off = &results.trade_off;
    page.figures(vec![scales_and_terms(trade_off), scales_and_alphas(trade_off), placings(trade_off)]);
}

/// Problems in their order.
fn problems(costs: &[CostResult]) -> Vec<&str> {
    let mut problems: Vec<&str> = Vec::new();
    for cost in costs {
        if !problems.contains(&cost.problem.as_str()) {
            problems.push(&cost.problem);
        }
    }
    problems
}

/// Columns of the tables: a name, and what the controller's name begins and ends with.
const COLUMNS: [(&str, &str, &str); 15] = [
    ("LMPC N = 1", "LMPC, N = 1,", ""),
    ("N = 3", "LMPC, N = 3,", ""),
    ("N = 5", "LMPC, N = 5,", ""),
    ("N = 7", "LMPC, N = 7,", ""),
    ("N = 8", "LMPC, N = 8,", ""),
    ("N = 9", "LMPC, N = 9,", ""),
    ("finite, N = 5", "finite LMPC, N = 5,", "terminal weight"),
    ("finite, N = 9", "finite LMPC, N = 9,", "terminal weight"),
    ("finite, α = 1.2, N = 5", "finite LMPC, N = 5,", "α = 1.2"),
    ("finite, α = 1.2, N = 9", "finite LMPC, N = 9,", "α = 1.2"),
    ("SS-MPC, 25 moves", "SS-MPC, N_c = 25", "25"),
    ("50 moves", "SS-MPC, N_c = 50", "50"),
    ("SS-MPC with terminal weight, 25 moves", "SS-MPC, N_c = 25,", "weight"),
    ("50 moves", "SS-MPC, N_c = 50,", "weight"),
    ("DLQR, clipped", "DLQR", ""),
];

/// The result of a column.
fn of<'a>(
    costs: &'a [CostResult],
    problem: &str,
    (_, start, end): (&str, &str, &str),
) -> Option<&'a CostResult> {
    costs.iter().find(|cost| {
        cost.problem == problem && cost.controller.starts_with(start) && cost.controller.ends_with(end)
    })
}

fn excess_table(page: &mut Page, costs: &[CostResult]) {
    let header: Vec<&str> =
        std::iter::once("problem").chain(COLUMNS.iter().map(|(name, ..)| *name)).collect();
    let rows: Vec<Vec<String>> = problems(costs)
        .into_iter()
        .map(|problem| {
            let cell = |column: &(&str, &str, &str)| match of(costs, problem, *column) {
                Some(cost) => percent(cost.ratio_to_optimum),
                None => "–".to_owned(),
            };
            std::iter::once(problem.to_owned()).chain(COLUMNS.iter().map(cell)).collect()
        })
        .collect();
    page.table(&header, &rows);
    for cost in costs.iter().filter(|cost| cost.refused.is_some()) {
        if costs.iter().find(|other| other.controller == cost.controller && other.refused == cost.refused)
            == Some(cost)
        {
            let reason = cost.refused.as_deref().unwrap_or_default();
            page.paragraph(&format!("Rejected: {}, {}: {reason}.", cost.problem, cost.controller));
        }
    }
}

fn time_table(page: &mut Page, costs: &[CostResult]) {
    let shown = |cost: &&CostResult| {
        cost.cost.is_some()
            && ["position step of 5 m", "altitude step of 5 m up", "roll step of 1", "yaw step of 1"]
                .iter()
                .any(|start| cost.problem.starts_with(start))
    };
    let number = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.2}"));
    let rows: Vec<Vec<String>> = costs
        .iter()
        .filter(shown)
        .map(|cost| {
            vec![
                cost.problem.clone(),
                cost.controller.clone(),
                number(cost.median_us),
                number(cost.p99_us),
                number(cost.median_limited_us),
                cost.worst_iterations.map_or(String::new(), |iterations| iterations.to_string()),
            ]
        })
        .collect();
    page.table(
        &["problem", "controller", "median, µs", "99 %, µs", "median at a limit, µs", "most iterations"],
        &rows,
    );
}
