//! All results, as results.json has them.

use schemars::JsonSchema;
use serde::Serialize;

use crate::bars::{BarResult, Optimum, OptimumResult, ShownFlight, bars, bars_parts};
use crate::constrained_step::{
    CostResult, TradeOff, closed_loop_cost, closed_loop_cost_parts, trade_off, trade_off_parts,
};
use crate::eigenvalues::{EigenvalueResult, GainResult, eigenvalues_and_gains};
use crate::error::Error;
use crate::flights::{FlightResult, flights, flights_parts};
use crate::progress::Progress;
use crate::robustness::{RobustnessResult, robustness, robustness_parts};
use crate::tables::{ScaleRow, table2, table3};

/// results.json. Fields may be added; existing ones keep their name, unit and meaning.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Results {
    /// Table 2.
    pub table2: Vec<ScaleRow>,
    /// Table 3.
    pub table3: Vec<ScaleRow>,
    /// Figure 4 for three controllers and N = 1 … 15, with condition numbers.
    pub figure4: Vec<EigenvalueResult>,
    /// The gains of the same designs.
    pub gains: Vec<GainResult>,
    /// Cost and time of controllers on steps under limits.
    pub closed_loop_cost: Vec<CostResult>,
    /// What N, a, α and the placing of limits cost.
    pub trade_off: TradeOff,
    /// Flights on the nonlinear plant: Figures 5–13, and N = 1 … 15.
    pub flights: Vec<FlightResult>,
    /// Random flights.
    pub robustness: Vec<RobustnessResult>,
    /// What the closed loop is measured by, with a bar for each figure.
    pub bars: Vec<BarResult>,
    /// The best flights that a nonlinear solver finds for some of them; empty when it was not run.
    pub optimum: Vec<OptimumResult>,
    /// Tracks of the bars' figures.
    #[serde(skip)]
    pub shown: Vec<ShownFlight>,
}

/// Computes all results, with so many random flights of each controller, and measures the optimal flights that are given.
///
/// # Errors
/// [`Error::Design`] when a design that must exist does not, [`Error::Solver`].
pub fn results(random_flights: u32, optima: &[Optimum], progress: &Progress) -> Result<Results, Error> {
    progress.stage("eigenvalues");
    let (figure4, gains) = eigenvalues_and_gains()?;
    progress.stage("steps under limits, timed on one core");
    let closed_loop_cost = closed_loop_cost(progress)?;
    progress.stage("trade-off");
    let trade_off = trade_off(progress)?;
    progress.stage("flights");
    let flights = flights(progress);
    progress.stage("random flights");
    let robustness = robustness(random_flights, progress);
    progress.stage("bars");
    let bars = bars(&robustness, optima, progress);
    Ok(Results {
        table2: table2()?,
        table3: table3()?,
        figure4,
        gains,
        closed_loop_cost,
        trade_off,
        flights,
        robustness,
        bars: bars.results,
        optimum: bars.optima,
        shown: bars.shown,
    })
}

/// How often [`results`] reports progress.
///
/// # Errors
/// As [`results`].
pub fn parts(random_flights: u32) -> Result<u64, Error> {
    let studies = closed_loop_cost_parts()? + trade_off_parts()?;
    Ok(studies + flights_parts() + robustness_parts(random_flights) + bars_parts())
}

/// What results.json contains, as a JSON Schema.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Results).to_value()
}
