//! One Laguerre MPC design beside the regulator of the same weights.

use lmpc::{
    Augmented, DesignError, LaguerreBasis, LmpcDesign, Prediction, Weighting, Weights, condition_number,
    eigenvalues,
};
use nalgebra::{Complex, DMatrix};
use serde::Serialize;

/// The figures of a design: what `--gain` prints as JSON. Matrices row by row.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignResult {
    /// Gain on \[Δx_m; y − r\] of the Laguerre MPC.
    pub k_lmpc: Vec<Vec<f64>>,
    /// Gain of the regulator.
    pub k_dlqr: Vec<Vec<f64>>,
    /// Eigenvalues of the closed loop with each gain.
    pub closed_loop_eigenvalues: ClosedLoopEigenvalues,
    /// Largest magnitude of the closed-loop eigenvalues with the gain of the Laguerre MPC.
    pub spectral_radius: f64,
    /// Condition number of Ω.
    pub condition_weighted: f64,
    /// The same without weighting: the plain cost (48) over the same horizon.
    pub condition_unweighted: f64,
}

/// Closed-loop eigenvalues as \[real, imaginary\], by controller.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClosedLoopEigenvalues {
    /// With the gain of the Laguerre MPC.
    pub lmpc: Vec<[f64; 2]>,
    /// With the gain of the regulator.
    pub dlqr: Vec<[f64; 2]>,
    /// Largest distance between an eigenvalue of `lmpc` and its partner in `dlqr`.
    pub max_distance: f64,
}

/// Designs a controller on an augmented model.
///
/// # Errors
/// [`DesignError`] for every violated precondition, including an unstable closed loop.
pub fn design(
    model: &Augmented,
    weights: &Weights,
    bases: &[LaguerreBasis],
    horizon: usize,
    weighting: Weighting,
) -> Result<DesignResult, DesignError> {
    let design = LmpcDesign::new(model, weights, bases, horizon, weighting)?;
    let regulated = model.a() - model.b() * design.dlqr().gain();
    let lmpc = design.closed_loop_eigenvalues()?;
    let dlqr = eigenvalues("A − BK", &regulated)?;
    let plain = Prediction::new(model.a(), model.b(), weights.q(), weights.r(), bases, horizon, None)?;
    Ok(DesignResult {
        k_lmpc: rows(design.gain()),
        k_dlqr: rows(design.dlqr().gain()),
        closed_loop_eigenvalues: ClosedLoopEigenvalues {
            max_distance: distance(&lmpc, &dlqr),
            lmpc: pairs(&lmpc),
            dlqr: pairs(&dlqr),
        },
        spectral_radius: design.spectral_radius(),
        condition_weighted: design.condition_number(),
        condition_unweighted: condition_number(plain.omega()),
    })
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

fn pairs(values: &[Complex<f64>]) -> Vec<[f64; 2]> {
    values.iter().map(|value| [value.re, value.im]).collect()
}

/// Largest distance of a pairing that takes the closest pairs first, each eigenvalue once.
fn distance(one: &[Complex<f64>], other: &[Complex<f64>]) -> f64 {
    let apart = |a: Complex<f64>, b: Complex<f64>| (a.re - b.re).hypot(a.im - b.im);
    let mut candidates: Vec<(f64, usize, usize)> = Vec::new();
    for (i, &a) in one.iter().enumerate() {
        candidates.extend(other.iter().enumerate().map(|(j, &b)| (apart(a, b), i, j)));
    }
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut used_one, mut used_other) = (vec![false; one.len()], vec![false; other.len()]);
    let mut largest = 0.0;
    for (distance, i, j) in candidates {
        if !used_one[i] && !used_other[j] {
            (used_one[i], used_other[j]) = (true, true);
            largest = distance;
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use nalgebra::Complex;

    use super::distance;

    #[test]
    fn each_eigenvalue_has_one_partner() {
        let at = |re: f64| Complex::new(re, 0.0);
        // 0.5 and 0.6 both lie nearest to 0.55; one of them has to take 0.9.
        assert!((distance(&[at(0.5), at(0.6)], &[at(0.55), at(0.9)]) - 0.3).abs() < 0.11);
        assert_eq!(distance(&[at(0.1), at(0.2)], &[at(0.2), at(0.1)]), 0.0);
    }
}
