//! All results, as results.json has them.

use lmpc::DesignError;
use serde::Serialize;

use crate::closed_loop::{CostResult, closed_loop_cost};
use crate::eigenvalues::{EigenvalueResult, figure4};
use crate::tables::{ScaleRow, table2, table3};

/// results.json. Fields are only ever added.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Results {
    /// Table 2.
    pub table2: Vec<ScaleRow>,
    /// Table 3.
    pub table3: Vec<ScaleRow>,
    /// Figure 4 for three controllers and N = 1 … 15, with gains and condition numbers.
    pub figure4: Vec<EigenvalueResult>,
    /// Cost and time of constrained controllers on one step.
    pub closed_loop_cost: Vec<CostResult>,
}

/// Computes all results.
///
/// # Errors
/// [`DesignError`] when a design that must exist does not.
pub fn results() -> Result<Results, DesignError> {
    Ok(Results {
        table2: table2()?,
        table3: table3()?,
        figure4: figure4()?,
        closed_loop_cost: closed_loop_cost()?,
    })
}
