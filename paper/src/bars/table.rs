//! The whole table of bars.

use quadrotor::Configuration;
use rayon::prelude::*;

use super::flyer::Flyer;
use super::plans::plans;
use super::random::judged;
use super::result::{BarResult, flown};
use super::sample_time::sample_times;
use super::track::Track;
use super::{Optimum, OptimumResult};
use crate::progress::Progress;
use crate::robustness::RobustnessResult;

/// Flights whose tracks are kept, for the figures.
pub const SHOWN: [&str; 7] = [
    "300 m, calm",
    "5 m north",
    "20 m north",
    "5 m north, 5 m east, 5 m up",
    "figure-eight of 6 m at 0.85 rad/s",
    "figure-eight of 8 m at 1 rad/s, tilt 1.0 rad, speed 20 m/s",
    "mass believed 0.5 of the true one, full state",
];

/// A flight of the figures.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownFlight {
    /// Its name.
    pub flight: &'static str,
    /// Who flew it, and how.
    pub tracks: Vec<(String, Track)>,
}

/// All bars, and what the figures show.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    /// For results.json.
    pub results: Vec<BarResult>,
    /// The optima of the same flights.
    pub optima: Vec<OptimumResult>,
    /// For the figures.
    pub shown: Vec<ShownFlight>,
}

/// Flies everything with the default configuration.
pub fn bars(random: &[RobustnessResult], optima: &[Optimum], progress: &Progress) -> Bars {
    let configuration = Configuration::default();
    let plans = plans(&configuration);
    let flown: Vec<(Vec<BarResult>, Option<ShownFlight>)> = plans
        .par_iter()
        .map(|plan| {
            let flown = flown(plan, &Flyer::ALL);
            let shown = SHOWN.into_iter().find(|shown| *shown == plan.name);
            let named = |tracks: Vec<(Flyer, Track)>| {
                tracks.into_iter().map(|(flyer, track)| (flyer.name().to_owned(), track)).collect()
            };
            progress.advance();
            (flown.results, shown.map(|flight| ShownFlight { flight, tracks: named(flown.tracks) }))
        })
        .collect();
    let (results, shown): (Vec<_>, Vec<_>) = flown.into_iter().unzip();
    let mut results: Vec<BarResult> = results.into_iter().flatten().collect();
    let mut shown: Vec<ShownFlight> = shown.into_iter().flatten().collect();

    let mut measured = Vec::new();
    for optimum in optima {
        let Some(plan) = plans.iter().find(|plan| plan.name == optimum.flight) else { continue };
        let (result, track) = optimum.measured(plan);
        if let Some(shown) = shown.iter_mut().find(|shown| shown.flight == plan.name) {
            shown.tracks.push((format!("least {}", optimum.objective), track));
        }
        measured.push(result);
    }
    for flyer in Flyer::ALL {
        let shaped =
            |result: &&RobustnessResult| result.mission == "shaped" && result.controller == flyer.pilot();
        results.extend(random.iter().filter(shaped).flat_map(|flights| judged(flights, flyer.name())));
    }
    results.extend(sample_times(&configuration, &Flyer::ALL));
    Bars { results, optima: measured, shown }
}

/// How often [`bars`] reports progress.
pub fn bars_parts() -> u64 {
    plans(&Configuration::default()).len() as u64
}
