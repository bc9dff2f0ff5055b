//! Tables 2 and 3: the scaling factor that a control horizon asks for.

use lmpc::{DesignError, LaguerreBasis};
use schemars::JsonSchema;
use serde::Serialize;

/// A row: a ≈ e^(−N/N_c) (58).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ScaleRow {
    /// N_c, samples.
    pub n_c: u32,
    /// N.
    pub n: usize,
    /// a, computed.
    pub a: f64,
    /// a, as the paper prints it.
    pub printed: f64,
}

fn row(n_c: u32, n: usize, printed: f64) -> Result<ScaleRow, DesignError> {
    let a = LaguerreBasis::for_control_horizon(n, f64::from(n_c))?.scale();
    Ok(ScaleRow { n_c, n, a, printed })
}

/// Constant N.
pub fn table2() -> Result<Vec<ScaleRow>, DesignError> {
    [(10, 0.6065), (15, 0.7165), (20, 0.7788), (25, 0.8187), (50, 0.9048)]
        .into_iter()
        .map(|(n_c, printed)| row(n_c, 5, printed))
        .collect()
}

/// Constant N_c.
pub fn table3() -> Result<Vec<ScaleRow>, DesignError> {
    [(1, 0.9672), (3, 0.9048), (5, 0.8465), (7, 0.7919), (9, 0.7408)]
        .into_iter()
        .map(|(n, printed)| row(30, n, printed))
        .collect()
}
