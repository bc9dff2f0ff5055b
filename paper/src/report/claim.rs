//! The claim in numbers: tables of cost and time.

use super::cost_figures::cost_and_time;
use super::page::{Page, percent};
use super::trade_off_figures::{placings, scales_and_alphas, scales_and_terms};
use crate::constrained_step::CostResult;
use crate::results::Results;

pub fn section(page: &mut Page, results: &Results) {
    page.heading("The claim in numbers: the cost of using few coefficients under limits");
    page.paragraph(
        "Steps from rest on one axis of the linear models, with the cascade's default weights and limits: tilt, its \
         increments and speed of the position; acceleration and speed of the altitude; torques of the attitude. The optimum \
         is one quadratic program over the whole step of 1500 samples under all limits at all samples, solved by Clarabel, \
         an independent interior-point solver. The last problem has both horizontal axes at once, with the tilt \
         limited jointly; its optimum has 80 free moves per input.",
    );
    page.subheading("Cost above the optimum");
    excess_table(page, &results.closed_loop_cost);
    page.paragraph(
        "“α = 1.2” is the paper's recipe with its a = 0.8187; the other LMPC columns have the Riccati solution as terminal \
         weight and the default a of their controller. A value below zero means that the controller exceeded a limit: clipped \
         DLQR has no speed limits.",
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
const COLUMNS: [(&str, &str, &str); 12] = [
    ("LMPC N = 1", "LMPC, N = 1,", "terminal weight"),
    ("N = 3", "LMPC, N = 3,", "terminal weight"),
    ("N = 5", "LMPC, N = 5,", "terminal weight"),
    ("N = 7", "LMPC, N = 7,", "terminal weight"),
    ("N = 9", "LMPC, N = 9,", "terminal weight"),
    ("α = 1.2, N = 5", "LMPC, N = 5,", "α = 1.2"),
    ("α = 1.2, N = 9", "LMPC, N = 9,", "α = 1.2"),
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
            && ["position step of 5", "altitude step of 5 m up", "roll step of 1", "yaw step of 1"]
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
