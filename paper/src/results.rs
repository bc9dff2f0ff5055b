//! All results, as results.json has them.

use serde::Serialize;

use crate::constrained_step::{CostResult, TradeOff, closed_loop_cost, trade_off};
use crate::eigenvalues::{EigenvalueResult, GainResult, eigenvalues_and_gains};
use crate::error::Error;
use crate::progress::Progress;
use crate::tables::{ScaleRow, table2, table3};

/// results.json. Fields are only ever added.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Results {
    /// Table 2.
    pub table2: Vec<ScaleRow>,
    /// Table 3.
    pub table3: Vec<ScaleRow>,
    /// Figure 4 for three controllers and N = 1 … 15, with condition numbers.
    pub figure4: Vec<EigenvalueResult>,
    /// The gains of the same designs.
    pub gains: Vec<GainResult>,
    /// Cost and time of constrained controllers on one step.
    pub closed_loop_cost: Vec<CostResult>,
    /// What N, a, α and the placing of limits cost.
    pub trade_off: TradeOff,
}

/// Computes all results.
///
/// # Errors
/// [`DesignError`] when a design that must exist does not.
pub fn results(progress: &Progress) -> Result<Results, Error> {
    let (figure4, gains) = eigenvalues_and_gains()?;
    Ok(Results {
        table2: table2()?,
        table3: table3()?,
        figure4,
        gains,
        closed_loop_cost: closed_loop_cost(progress)?,
        trade_off: trade_off(progress)?,
    })
}
