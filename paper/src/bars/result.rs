//! The bars, as results.json has them.

use schemars::JsonSchema;
use serde::Serialize;

use super::figure::{Figure, bound, figures};
use super::flight::fly;
use super::flyer::Flyer;
use super::plan::Plan;
use super::track::Track;

/// One figure of one flight of one controller.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BarResult {
    /// Row of the table of bars: "cruise", "goal", "path", "beyond-limits", "side-force", "mass", "mass-goal", "rotor-lag", "spin",
    /// "unforeseen", "random" or "sample-time".
    pub row: &'static str,
    /// The flight.
    pub flight: String,
    /// Who flew.
    pub controller: String,
    /// What was measured, with its unit.
    pub figure: &'static str,
    /// Its value; null when it was not reached, or the vehicle was lost.
    pub value: Option<f64>,
    /// What it may be at most; null when it is not judged.
    pub bound: Option<f64>,
    /// Whether it keeps its bound; null when it is not judged.
    pub passed: Option<bool>,
    /// Why there was no flight; null otherwise.
    pub lost: Option<String>,
}

/// A flight of everyone.
#[derive(Clone, Debug, PartialEq)]
pub struct Flown {
    /// Figures of all flyers.
    pub results: Vec<BarResult>,
    /// What was flown.
    pub tracks: Vec<(Flyer, Track)>,
}

/// Flies a plan with some flyers. Comparisons are with those of them that flew.
pub fn flown(plan: &Plan, flyers: &[Flyer]) -> Flown {
    let able = flyers.iter().copied().filter(|flyer| plan.can_be_flown_by(*flyer));
    let mut tracks = Vec::new();
    let mut measured: Vec<(Flyer, Vec<Figure>)> = Vec::new();
    let mut results = Vec::new();
    for flyer in able {
        match fly(plan, flyer) {
            Ok(track) => {
                measured.push((flyer, figures(plan, &track)));
                tracks.push((flyer, track));
            }
            Err(error) => results.push(lost(plan, flyer, error.to_string())),
        }
    }
    for (flyer, figures) in &measured {
        results.extend(figures.iter().map(|figure| judged(plan, *flyer, figure, &measured)));
    }
    Flown { results, tracks }
}

fn lost(plan: &Plan, flyer: Flyer, reason: String) -> BarResult {
    BarResult {
        row: plan.row.name(),
        flight: plan.name.clone(),
        controller: flyer.name().to_owned(),
        figure: "arrived",
        value: None,
        bound: None,
        passed: Some(false),
        lost: Some(reason),
    }
}

fn judged(plan: &Plan, flyer: Flyer, figure: &Figure, measured: &[(Flyer, Vec<Figure>)]) -> BarResult {
    let bound = bound(figure, measured);
    BarResult {
        row: plan.row.name(),
        flight: plan.name.clone(),
        controller: flyer.name().to_owned(),
        figure: figure.name,
        value: Some(figure.value).filter(|value| value.is_finite()),
        bound,
        passed: bound.map(|bound| figure.value <= bound),
        lost: None,
    }
}
