//! Limits as rows of a quadratic program, from the predictions of any controller.

use alloc::vec::Vec;

use nalgebra::{DMatrix, RowDVector};

use crate::{DesignError, Limit, Quantity, validate};

/// A predicted quantity as a function of what is decided and of what is known: D·decision + K·known.
#[derive(Clone, Debug)]
pub(crate) struct Affine {
    pub(crate) decision: DMatrix<f64>,
    pub(crate) known: DMatrix<f64>,
}

/// What a controller predicts, walked sample by sample from m = 0.
pub(crate) trait PredictionWalk {
    /// Number of components of a quantity.
    fn size(&self, quantity: Quantity) -> usize;

    /// A quantity at the present sample m.
    fn predicted(&self, quantity: Quantity) -> Affine;

    /// m → m + 1.
    fn advance(&mut self);
}

/// One row decision·z ≤ upper − known·k of a quadratic program in z.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LimitRow {
    pub(crate) decision: RowDVector<f64>,
    pub(crate) known: RowDVector<f64>,
    pub(crate) soft: bool,
    /// Which of the run-time values bounds it.
    pub(crate) bound: usize,
}

/// All rows of some limits on the predictions that `walk` starts, sample by sample.
pub(crate) fn limit_rows<W: PredictionWalk>(
    limits: &[Limit],
    mut walk: W,
) -> Result<Vec<LimitRow>, DesignError> {
    for limit in limits {
        let d = &limit.directions;
        validate::shape("directions of a limit", d, (d.nrows(), walk.size(limit.quantity)))?;
        validate::finite("directions of a limit", d)?;
    }
    let end = limits.iter().flat_map(|limit| &limit.samples).max().map_or(0, |last| last + 1);
    let mut rows = Vec::new();
    for m in 0..end {
        let mut first_bound = 0;
        for limit in limits {
            let d = &limit.directions;
            if limit.samples.contains(&m) {
                let Affine { decision, known } = walk.predicted(limit.quantity);
                let (decision, known) = (d * decision, d * known);
                rows.extend((0..d.nrows()).map(|row| LimitRow {
                    decision: decision.row(row).into_owned(),
                    known: known.row(row).into_owned(),
                    soft: limit.soft,
                    bound: first_bound + row,
                }));
            }
            first_bound += d.nrows();
        }
        walk.advance();
    }
    Ok(rows)
}
