//! Figure 4 for all three controllers, and for N = 1 … 15.

use lmpc::{Augmented, DesignError, Discretization, LaguerreBasis, StateSpace, Weighting, Weights};
use quadrotor::{Airframe, altitude_model, attitude_model, position_model};
use serde::Serialize;

use crate::design::{DesignResult, design};

/// a of the paper's flights.
const SCALE: f64 = 0.8187;
/// α of the paper's section 6.1.
const ALPHA: f64 = 1.2;
/// N_p; the paper gives none. Weighted by α the horizon has died out long before.
const HORIZON: usize = 100;

/// Eigenvalues of one design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EigenvalueResult {
    /// "altitude", "position" or "attitude".
    pub controller: &'static str,
    /// Sample time, s; the paper gives none.
    pub sample_time: f64,
    /// N.
    pub n: usize,
    /// a.
    pub a: f64,
    /// N_p.
    pub n_p: usize,
    /// α.
    pub alpha: f64,
    /// Weight of the outputs, Q = q CᵀC.
    pub q: f64,
    /// Weight of the increments, R = r I; the paper gives none.
    pub r: f64,
    /// The design.
    #[serde(flatten)]
    pub design: DesignResult,
}

/// The paper's three plants, by forward Euler.
fn plants() -> Result<[(&'static str, f64, StateSpace); 3], DesignError> {
    let euler = Discretization::ForwardEuler;
    let inertia = Airframe::default().inertia_kg_m2;
    Ok([
        ("altitude", 0.05, altitude_model(0.05, euler)?),
        ("position", 0.05, position_model(0.05, euler)?),
        ("attitude", 0.01, attitude_model(&inertia, 0.01, euler)?),
    ])
}

/// All designs for N = 1 … 15; N = 5 is Figure 4.
pub fn figure4() -> Result<Vec<EigenvalueResult>, DesignError> {
    let mut results = Vec::new();
    for (controller, sample_time, plant) in plants()? {
        let model = Augmented::new(&plant);
        let (q, r) = (1.0, 1.0);
        let weights = Weights::output(&model, q, r)?;
        for n in 1..=15 {
            let bases = vec![LaguerreBasis::new(n, SCALE)?; model.inputs()];
            let design = match design(&model, &weights, &bases, HORIZON, Weighting::exponential(ALPHA, 1.0)) {
                Ok(design) => design,
                // Too few terms to stabilise it: there is nothing to show.
                Err(DesignError::Unstable { .. }) => continue,
                Err(error) => return Err(error),
            };
            let alpha = ALPHA;
            results.push(EigenvalueResult {
                controller,
                sample_time,
                n,
                a: SCALE,
                n_p: HORIZON,
                alpha,
                q,
                r,
                design,
            });
        }
    }
    Ok(results)
}
