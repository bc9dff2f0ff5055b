//! Figures 5–13 and the sweep over N.

use super::Page;
use super::flight_figures::{activity, axes, effort, errors, path, single_axes, sweep};
use crate::figures::Figure;
use crate::flights::{FlightResult, Mission};
use crate::results::Results;

pub fn section(page: &mut Page, results: &Results) {
    page.heading("Figures 5–7: the flight to (5, 5, 10)");
    page.paragraph(
        "The nonlinear equations (2)–(3) with rotor lag and rotor limits, from rest at the origin to 5 m north, 5 m east, 10 m up \
         (z = −10 in NED), heading from 0 to 0.5 rad, 20 s. The paper gives no time law. We use a fifth-order polynomial \
         over 10 s with feed-forward (“smooth”), and the goal as a step. “N = 5, a = 0.8187, α = 1.2” are the \
         paper's choices for all three controllers, on the paper's models, whose inputs act at once and which know no limits. “Defaults” \
         predicts with the inner loops, over an infinite horizon and under limits, with an N and an a of its own for each controller. \
         State-space MPC and DLQR have the models and weights of the defaults; state-space MPC keeps the regulator's cost as terminal weight.",
    );
    for mission in Mission::ALL {
        page.subheading(title(mission));
        let flown = of(results, "5-7", mission);
        table(page, &flown);
        page.figures(figures_5_to_7(mission, &flown));
    }
    page.paragraph(
        "In the smooth flight no limit is active, and all four controllers stay within millimetres: the paper's claim \
         that LMPC and state-space MPC track equally well holds there, and DLQR does the same with one matrix. Without the \
         governor the step reaches the limits: the paper's recipe, which has none, and DLQR tilt and overshoot far; LMPC and state-space MPC \
         predict what is left to them.",
    );
    second_section(page, results);
}

fn second_section(page: &mut Page, results: &Results) {
    page.heading("Figures 8–13: a control horizon of 30 with N = 1 and N = 9, and all N up to 15");
    page.paragraph(
        "(58) with N<sub>c</sub> = 30 gives a = 0.9672 for N = 1 and a = 0.7408 for N = 9. The paper shows similar flights for both. \
         With its α = 1.2 and our R, the design with N = 1 is rejected, because its closed loop is unstable; the paper gives no R, and with a \
         larger one the loop can be stable. With the Riccati solution as terminal weight it flies, slowly. All of these designs are on the paper's models. The tables list rejected designs.",
    );
    for mission in Mission::ALL {
        page.subheading(title(mission));
        let flown = of(results, "8-13", mission);
        table(page, &flown);
        if mission != Mission::Step {
            page.figures(vec![single_axes(mission, &flown)]);
        }
    }
    page.subheading("N = 1 … 15");
    let both = |result: &&FlightResult| result.figure != "5-7" && result.n.is_some();
    let swept: Vec<&FlightResult> = results.flights.iter().filter(both).collect();
    page.figures(vec![sweep(&swept)]);
}

fn title(mission: Mission) -> &'static str {
    match mission {
        Mission::Smooth => "Smooth time law",
        Mission::Step => "Step with the governor, which limits large errors (the cascade's default)",
        Mission::BareStep => "Step without the governor: the controllers see the whole error",
    }
}

fn of<'a>(results: &'a Results, figure: &str, mission: Mission) -> Vec<&'a FlightResult> {
    results
        .flights
        .iter()
        .filter(|result| result.figure == figure && result.mission == mission.name())
        .collect()
}

fn figures_5_to_7(mission: Mission, flown: &[&FlightResult]) -> Vec<Figure> {
    match mission {
        Mission::Smooth => {
            vec![path(mission, flown), axes(mission, flown), errors(mission, flown), effort(mission, flown)]
        }
        Mission::Step => vec![axes(mission, flown), activity(mission, flown)],
        Mission::BareStep => vec![
            path(mission, flown),
            axes(mission, flown),
            errors(mission, flown),
            effort(mission, flown),
            activity(mission, flown),
        ],
    }
}

fn table(page: &mut Page, flown: &[&FlightResult]) {
    let rows: Vec<Vec<String>> = flown.iter().map(|result| row(result)).collect();
    page.table(
        &[
            "controller",
            "RMS error north, east, down, mm",
            "from the goal at the end, mm",
            "overshoot",
            "effort, s",
            "largest tilt, °",
            "time at a limit: altitude, position, attitude",
            "most iterations",
        ],
        &rows,
    );
}

fn row(result: &FlightResult) -> Vec<String> {
    let mut row = vec![result.controller.clone()];
    if let Some(refused) = &result.refused {
        row.push(format!("rejected: {refused}"));
        row.extend(std::iter::repeat_n(String::new(), 6));
        return row;
    }
    let joined = |values: [f64; 3], show: &dyn Fn(f64) -> String| values.map(show).join(", ");
    let millimetres = |value: f64| {
        let value = 1e3 * value;
        if value < 10.0 { format!("{value:.2}") } else { format!("{value:.0}") }
    };
    row.push(joined(result.rms_m.unwrap_or_default(), &millimetres));
    row.push(result.final_m.map_or(String::new(), millimetres));
    row.push(result.overshoot.map_or(String::new(), |share| format!("{:.1} %", 100.0 * share)));
    row.push(result.effort.map_or(String::new(), |effort| format!("{effort:.3}")));
    row.push(result.tilt_rad.map_or(String::new(), |tilt| format!("{:.1}", tilt.to_degrees())));
    row.push(joined(result.limited.unwrap_or_default(), &|share| format!("{:.0} %", 100.0 * share)));
    row.push(
        result.worst_iterations.map_or(String::new(), |most| most.map(|most| most.to_string()).join(", ")),
    );
    row
}
