//! Flights on the nonlinear plant: Figures 5–13, and N = 1 … 15.
//!
//! ```text
//! pilot ─► configuration ─┐
//! mission ─► inputs ──────┴─► flight ─► flights[] and their figures
//! ```

mod flight;
mod mission;
mod pilot;

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

pub use flight::{Moment, loops, tilt_rad};
pub use mission::{GOAL_M, HEADING_RAD, Mission};
pub use pilot::Pilot;

use crate::progress::Progress;

/// N of Table 3.
pub const TABLE3_TERMS: [u32; 5] = [1, 3, 5, 7, 9];
/// N_c of Table 3.
const TABLE3_HORIZON: f64 = 30.0;
/// a of the paper's flight.
pub const PAPER_SCALE: f64 = 0.8187;
/// Most terms of the sweep.
const SWEPT_TERMS: u32 = 15;

/// One flight to 5 m north, 5 m east, 10 m up, of 20 s, from rest at the origin.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FlightResult {
    /// "5-7", "8-13" or "sweep".
    pub figure: &'static str,
    /// "smooth", "step" or "step without governor".
    pub mission: &'static str,
    /// Who flew.
    pub controller: String,
    /// N of LMPC with its own N and a for the whole cascade; null otherwise.
    pub n: Option<u32>,
    /// a of the same.
    pub a: Option<f64>,
    /// α of the same; 1 stands for the terminal weight.
    pub alpha: Option<f64>,
    /// Why there was no flight: the design was refused, or the vehicle was lost.
    pub refused: Option<String>,
    /// Root mean square of position minus reference, north, east, down, m.
    pub rms_m: Option<[f64; 3]>,
    /// Distance from the goal at the end, m.
    pub final_m: Option<f64>,
    /// Largest share by which a coordinate went beyond its goal.
    pub overshoot: Option<f64>,
    /// ∫ (F/mg − 1)² + (|τ|/l m g)² dt, s.
    pub effort: Option<f64>,
    /// Largest angle between thrust axis and vertical, rad.
    pub tilt_rad: Option<f64>,
    /// Share of the time with an active limit: altitude, position, attitude controller.
    pub limited: Option<[f64; 3]>,
    /// Most iterations of a sample, of the same.
    pub worst_iterations: Option<[u32; 3]>,
    /// Share of the time with limits relaxed or no solution, of the same.
    pub not_optimal: Option<[f64; 3]>,
    /// Every 50 ms, for the figures.
    #[serde(skip)]
    pub moments: Vec<Moment>,
}

/// All flights, on all cores.
pub fn flights(progress: &Progress) -> Vec<FlightResult> {
    plans()
        .into_par_iter()
        .map(|(figure, mission, pilot)| {
            let result = flown(figure, mission, pilot);
            progress.advance();
            result
        })
        .collect()
}

/// How often [`flights`] reports progress.
pub fn flights_parts() -> u64 {
    plans().len() as u64
}

type Plan = (&'static str, Mission, Pilot);

fn plans() -> Vec<Plan> {
    let mut plans = Vec::new();
    for mission in Mission::ALL {
        let pilots =
            [Pilot::paper(5, PAPER_SCALE), Pilot::default_lmpc(), Pilot::state_space(25), Pilot::regulator()];
        plans.extend(pilots.map(|pilot| ("5-7", mission, pilot)));
        for terms in 1..=SWEPT_TERMS {
            // (58) with N_c = 30: Table 3 is N = 1, 3, 5, 7, 9.
            let scale = (-f64::from(terms) / TABLE3_HORIZON).exp();
            let figure = if TABLE3_TERMS.contains(&terms) { "8-13" } else { "sweep" };
            plans.push((figure, mission, Pilot::paper(terms, scale)));
            plans.push((figure, mission, Pilot::terminal(terms, scale)));
        }
        plans.push(("8-13", mission, Pilot::state_space(30)));
    }
    plans
}

fn flown(figure: &'static str, mission: Mission, pilot: Pilot) -> FlightResult {
    let outcome = flight::fly(&pilot.configuration(mission), mission);
    let refused = outcome.as_ref().err().map(ToString::to_string);
    let flight = outcome.ok();
    let seen = flight.as_ref();
    FlightResult {
        figure,
        mission: mission.name(),
        controller: pilot.name,
        n: pilot.laguerre.map(|[n, ..]| n as u32),
        a: pilot.laguerre.map(|[_, a, _]| a),
        alpha: pilot.laguerre.map(|[.., alpha]| alpha),
        refused,
        rms_m: seen.map(|flight| flight.rms_m),
        final_m: seen.map(|flight| flight.final_m),
        overshoot: seen.map(|flight| flight.overshoot),
        effort: seen.map(|flight| flight.effort),
        tilt_rad: seen.map(|flight| flight.tilt_rad),
        limited: seen.map(|flight| flight.limited),
        worst_iterations: seen.map(|flight| flight.worst_iterations),
        not_optimal: seen.map(|flight| flight.not_optimal),
        moments: flight.map_or(Vec::new(), |flight| flight.moments),
    }
}
