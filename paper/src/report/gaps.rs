//! What the paper leaves open or misprints, and where its method loses.

use super::Page;
use super::page::percent;
use crate::constrained_step::{AXES, CostResult};
use crate::flights::Mission;
use crate::results::Results;

pub fn section(page: &mut Page, results: &Results) {
    page.heading("What the paper leaves open, and our choice");
    let rows =
        |rows: &[[&str; 3]]| rows.iter().map(|row| row.map(str::to_owned).to_vec()).collect::<Vec<_>>();
    page.text_table(&["what", "our choice", "why"], &rows(&CHOICES));
    page.heading("Deviations and misprints");
    page.text_table(&["where", "printed", "here"], &rows(&MISPRINTS));
    page.heading("Where Laguerre MPC loses");
    page.paragraph("Figures from this run.");
    page.text_table(&["what", "number"], &losses(results));
}

const CHOICES: [[&str; 3]; 11] = [
    [
        "sample times ΔT",
        "0.05 s altitude and position, 0.01 s attitude",
        "a tenth of the time constant of each loop, or less",
    ],
    [
        "weights Q, R",
        "Figure 4 with Q = CᵀC (the paper's) and R = I; flights with weights of the error, of its rate over ω, of its acceleration over ω² \
         and of the input's rate of change over ω³: 1, 1, 0.5, 1, and 1, 1.25, 1, 1 for the position; the paper's models with the first and the last of them for altitude and position",
        "relative to the bandwidth ω of a loop, 2.7 rad/s for the altitude, from the airframe for the others: all deviations \
         count in the unit of the error, and one default suits every airframe",
    ],
    [
        "prediction horizon N<sub>p</sub>",
        "100 with α = 1.2; infinite with the models that contain the inner loops; 60 (altitude), 150 (position) and 120 (attitude) for \
         state-space MPC",
        "with α = 1.2 the weight is negligible long before the end; state-space MPC's end where the loops have settled",
    ],
    [
        "time law of the flight",
        "10 s³ − 15 s⁴ + 6 s⁵ over 10 s, with feed-forward, and a raw step beside it",
        "the paper's figures show neither a step nor a straight ramp",
    ],
    [
        "sign of z",
        "NED: (5, 5, 10) is z = −10",
        "in (3) gravity enters w with a plus and the thrust with a minus",
    ],
    ["heading", "from 0 to 0.5 rad", "the paper plots ψ but gives no goal"],
    [
        "rotor constants k₁, k₂",
        "2.7·10⁻⁵ N·s² and 6.0·10⁻⁷ N·m·s²",
        "a 12-inch propeller, the largest that clears an arm of 0.275 m",
    ],
    [
        "rotor limits and lag",
        "50 to 450 rad/s, first order with 0.03 s",
        "thrust to weight of 3.2; motors of this size",
    ],
    [
        "limits of the controllers",
        "tilt 0.6 rad, its command 2 rad/s and 8 rad/s²; thrust 0.6 to 2 weights; 8 m/s, 4 m/s up, 3 m/s down; the thrust of each rotor",
        "the paper mentions constraints but gives no values",
    ],
    ["α in the literal recipe", "λ = 1, weights transformed", "see below"],
    [
        "state-space MPC's horizon and noise covariances",
        "in flight the regulator's cost as terminal weight and a disturbance estimate",
        "(34) ends with the horizon: for yaw with N<sub>p</sub> = 60 that loop is unstable",
    ],
];

const MISPRINTS: [[&str; 3]; 9] = [
    ["(3), second row", "p w − r q", "p w − r u"],
    ["(21)", "τ<sub>θ</sub>", "τ<sub>ψ</sub>"],
    ["output matrix under (23)", "a single 1, and rows of different length", "a 1 for each of φ, θ, ψ"],
    ["(35)", "y = C<sub>m</sub> x", "y = C<sub>m</sub> x<sub>m</sub>"],
    ["(44)", "l<sub>j</sub>(k<sub>i</sub>)", "l<sub>j</sub>(k): the functions run over the horizon"],
    ["(50)", "Ψ = φ(m) Q A<sup>m</sup>", "the sum of that over m = 1 … N<sub>p</sub>"],
    [
        "set-point",
        "x = [Δx<sub>m</sub> y]ᵀ, which is driven to zero",
        "the last entries are y − r (Wang 2009, chapter 3)",
    ],
    [
        "(51)–(57)",
        "α > 1 with Q and R unchanged; (57) allows eigenvalues up to α",
        "γ = 1/α, Q<sub>α</sub> = γ²Q + (1 − γ²)P, R<sub>α</sub> = γ²R (Wang 2009, chapter 4): the regulator's own eigenvalues, all inside \
         the unit circle. Literally, the altitude loop has one of magnitude 1.019",
    ],
    [
        "discretization",
        "forward Euler (9), (15), (23)",
        "forward Euler in Figure 4; zero-order hold, which is exact, in flight and on the steps",
    ],
];

/// Costs of those whose name begins and ends so.
fn costs<'a>(results: &'a Results, start: &'a str, end: &'a str) -> impl Iterator<Item = &'a CostResult> {
    let fits = move |cost: &&CostResult| cost.controller.starts_with(start) && cost.controller.ends_with(end);
    results.closed_loop_cost.iter().filter(fits)
}

/// From the least to the largest excess, and where that is.
fn range<'a>(costs: impl Iterator<Item = &'a CostResult>) -> String {
    let mut flown: Vec<(f64, &str)> =
        costs.filter_map(|cost| Some((cost.ratio_to_optimum?, cost.problem.as_str()))).collect();
    flown.sort_by(|one, other| one.0.total_cmp(&other.0));
    match (flown.first(), flown.last()) {
        (Some(least), Some(most)) => {
            format!("{} to {} ({})", percent(Some(least.0)), percent(Some(most.0)), most.1)
        }
        _ => "–".to_owned(),
    }
}

fn losses(results: &Results) -> Vec<Vec<String>> {
    let of = |start: &str, end: &str| range(costs(results, start, end));
    let mut rows: Vec<[String; 2]> = [
        ("One coefficient is too few: cost above the optimum with N = 1", "LMPC, N = 1,", ""),
        ("Three", "LMPC, N = 3,", ""),
        ("Five", "LMPC, N = 5,", ""),
        ("Seven, the default of the altitude", "LMPC, N = 7,", ""),
        ("Eight, the default of the other loops", "LMPC, N = 8,", ""),
        ("Nine", "LMPC, N = 9,", ""),
        ("Without the stabilizing feedback, terminal weight, N = 5", "finite LMPC, N = 5,", "terminal weight"),
        ("The paper's α = 1.2 and a = 0.8187, N = 5", "finite LMPC, N = 5,", "α = 1.2"),
        ("State-space MPC with 25 moves and the same terminal weight", "SS-MPC, N_c = 25,", "weight"),
        ("… and with 50 moves", "SS-MPC, N_c = 50,", "weight"),
        ("Clipped DLQR, which exceeds the limits of speed and rates, so that a cost below the optimum is no gain", "DLQR", ""),
    ]
    .into_iter()
    .map(|(what, start, end)| [what.to_owned(), of(start, end)])
    .collect();
    rows.push([
        "Other choices than the default N and a: the worst of N ± 1 and a ± 0.05, above the optimum"
            .to_owned(),
        neighbours(results),
    ]);
    rows.extend(flown_losses(results));
    rows.into_iter().map(Vec::from).collect()
}

/// The largest excess among the designs beside the defaults, and that of the default.
fn neighbours(results: &Results) -> String {
    let trade_off = &results.trade_off;
    let beside = |axis: &str| {
        let designs = trade_off.grid(axis, "beside the default");
        let worst =
            designs.map(|design| design.worst_excess_percent.unwrap_or(f64::INFINITY)).fold(0.0, f64::max);
        let own =
            trade_off.default_of(axis).and_then(|design| design.worst_excess_percent).unwrap_or(f64::NAN);
        format!("{axis} {worst:.2} % (default {own:.2} %)")
    };
    AXES.map(beside).join(", ")
}

fn flown_losses(results: &Results) -> Vec<[String; 2]> {
    let mut rows = Vec::new();
    let step = |name: &str| {
        let flights = results.flights.iter().filter(|flight| flight.mission == Mission::BareStep.name());
        flights
            .filter(|flight| flight.figure == "5-7" && flight.controller.starts_with(name))
            .filter_map(|flight| flight.overshoot)
            .map(|overshoot| format!("{:.1} %", 100.0 * overshoot))
            .collect::<Vec<_>>()
            .join(" and ")
    };
    rows.push([
        "Overshoot of the raw step without governor: LMPC (the paper's models, defaults), state-space MPC, DLQR"
            .to_owned(),
        format!("{}; {}; {}", step("LMPC"), step("SS-MPC"), step("DLQR")),
    ]);
    let refused = results.flights.iter().find(|flight| flight.refused.is_some());
    if let Some(refused) = refused {
        let reason = refused.refused.clone().unwrap_or_default();
        rows.push([format!("Rejected: {}", refused.controller), reason]);
    }
    let shown: Vec<String> = results
        .robustness
        .iter()
        .filter(|result| result.mission == "shaped")
        .map(|result| format!("{}: {:.3} m", result.controller, result.median_m))
        .collect();
    rows.push(["Random flights, median distance, shaped".to_owned(), shown.join("; ")]);
    rows
}
