//! Figure 4 for all three controllers, and for N = 1 … 15.

use lmpc::{Augmented, DesignError, Discretization, LaguerreBasis, StateSpace, Weighting, Weights};
use quadrotor::{Airframe, altitude_model, attitude_model, position_model};
use schemars::JsonSchema;
use serde::Serialize;

use crate::design::{ClosedLoopEigenvalues, DesignResult, design};

/// a of the paper's flights.
const SCALE: f64 = 0.8187;
/// α of the paper's section 6.1.
const ALPHA: f64 = 1.2;
/// N_p; the paper gives none. Weighted by α the horizon has died out long before.
const HORIZON: usize = 100;

/// Eigenvalues and conditioning of one design.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct EigenvalueResult {
    /// "altitude", "position" or "attitude".
    pub controller: &'static str,
    /// N.
    pub n: usize,
    /// α.
    pub alpha: f64,
    /// Closed-loop eigenvalues of the Laguerre MPC, \[real, imaginary\].
    pub lmpc: Vec<[f64; 2]>,
    /// Those of the regulator.
    pub dlqr: Vec<[f64; 2]>,
    /// Largest distance between partners.
    pub max_distance: f64,
    /// Largest magnitude of the first.
    pub spectral_radius: f64,
    /// Condition number of Ω.
    pub condition_weighted: f64,
    /// The same of the plain cost (48).
    pub condition_unweighted: f64,
}

/// Gains of one design, with everything that they follow from.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct GainResult {
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
    /// Gain of the Laguerre MPC on \[Δx_m; y − r\], row by row.
    pub k_lmpc: Vec<Vec<f64>>,
    /// Gain of the regulator.
    pub k_dlqr: Vec<Vec<f64>>,
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

/// Eigenvalues and gains of all designs for N = 1 … 15; N = 5 is Figure 4.
pub fn eigenvalues_and_gains() -> Result<(Vec<EigenvalueResult>, Vec<GainResult>), DesignError> {
    let (mut eigenvalues, mut gains) = (Vec::new(), Vec::new());
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
            let (alpha, a, n_p) = (ALPHA, SCALE, HORIZON);
            let DesignResult { k_lmpc, k_dlqr, closed_loop_eigenvalues, .. } = design;
            let ClosedLoopEigenvalues { lmpc, dlqr, max_distance } = closed_loop_eigenvalues;
            gains.push(GainResult { controller, sample_time, n, a, n_p, alpha, q, r, k_lmpc, k_dlqr });
            eigenvalues.push(EigenvalueResult {
                controller,
                n,
                alpha,
                lmpc,
                dlqr,
                max_distance,
                spectral_radius: design.spectral_radius,
                condition_weighted: design.condition_weighted,
                condition_unweighted: design.condition_unweighted,
            });
        }
    }
    Ok((eigenvalues, gains))
}
