//! A thousand random flights.

use super::Page;
use crate::figures::{COLOURS, Figure, Line, Panel, Scale, line_chart};
use crate::results::Results;
use crate::robustness::{ARRIVED_M, DRAG_N_S_M, DURATION_S, NOISE, RobustnessResult, START, WIND_M_S};

pub fn section(page: &mut Page, results: &Results) {
    page.heading("Robustness: random flights");
    let count = results.robustness.first().map_or(0, |result| result.flights);
    let [position, velocity, tilt, rate] = START;
    let [position_noise, velocity_noise, attitude_noise, rate_noise] = NOISE;
    page.paragraph(&format!(
        "{count} flights of {DURATION_S} s per controller to (5, 5, 10), all controllers under the same circumstances: start \
         within ±{position} m and ±{velocity} m/s on each axis, ±{tilt} rad of roll and pitch, any heading, ±{rate} rad/s; mass and \
         inertia together 70 to 130 % of what the controllers believe in; a mean wind of up to {WIND_M_S} m/s from anywhere with \
         Dryden gusts of low altitude, on a drag of {DRAG_N_S_M} N·s/m that the controllers do not know; white noise of \
         {position_noise} m, {velocity_noise} m/s, {attitude_noise} rad and {rate_noise} rad/s on what they see. Seeded: the same \
         numbers on every machine and any number of threads."
    ));
    let rows: Vec<Vec<String>> = results
        .robustness
        .iter()
        .map(|result| {
            vec![
                result.controller.clone(),
                result.mission.to_owned(),
                format!("{:.1} %", 100.0 * f64::from(result.arrived) / f64::from(result.flights)),
                format!("{:.3}", result.median_m),
                metres(result.p95_m),
                metres(result.worst_m),
                format!(
                    "{} ({} tilt, {} speed)",
                    result.violations, result.tilt_violations, result.speed_violations
                ),
            ]
        })
        .collect();
    page.table(
        &["controller", "goal", "arrived", "median, m", "95 %, m", "worst, m", "flights beyond a limit"],
        &rows,
    );
    page.paragraph(&format!(
        "Arrived: within {ARRIVED_M} m of the goal during all of the last 2 s. Median, 95 % and worst are of each flight's largest \
         distance from the goal during them. Beyond a limit: more than 1 % above the limit of tilt (0.6 rad) or of speed (8 m/s, 4 up, \
         3 down) at any time from 3 s after the start. “shaped” is the cascade's default; in “step without governor” the \
         controllers alone deal with a goal up to 18 m away."
    ));
    page.figures(vec![distribution(&results.robustness)]);
}

fn metres(value: Option<f64>) -> String {
    value.map_or("lost".to_owned(), |value| format!("{value:.3}"))
}

fn distribution(results: &[RobustnessResult]) -> Figure {
    let mut missions: Vec<&str> = Vec::new();
    for result in results {
        if !missions.contains(&result.mission) {
            missions.push(result.mission);
        }
    }
    let panels: Vec<Panel> = missions
        .into_iter()
        .map(|mission| {
            let of_mission = results.iter().filter(|result| result.mission == mission);
            let lines = of_mission.enumerate().map(|(index, result)| {
                let count = result.distances_m.len() as f64;
                let points = result.distances_m.iter().enumerate();
                let shares = points.map(|(rank, distance)| [*distance, 100.0 * (rank as f64 + 1.0) / count]);
                Line::new(result.controller.clone(), COLOURS[index], shares.collect())
            });
            let panel = Panel::new(
                mission,
                "largest distance in the last 2 s, m",
                "share of flights, %",
                lines.collect(),
            );
            Panel { x_scale: Scale::Logarithmic, ..panel.with_range(0.0, 102.0) }
        })
        .collect();
    Figure {
        name: "robustness".to_owned(),
        caption: "How many flights end how close to the goal.".to_owned(),
        svg: line_chart(
            "robustness",
            "Distribution of the distance from the goal",
            2,
            [520.0, 300.0],
            &panels,
        ),
    }
}
