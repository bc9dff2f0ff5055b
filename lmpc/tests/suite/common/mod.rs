//! Plants that several tests share.

pub mod double_double;
pub mod explicit_plan;
pub mod lagged_integrators;
pub mod quadratic_problem;

use lmpc::{Augmented, Discretization, LaguerreBasis, StateSpace};
use nalgebra::DMatrix;

/// Chains of two integrators with the given gains: the shape of all three of the paper's plants.
pub fn double_integrators(gains: &[f64], sample_time_s: f64, discretization: Discretization) -> StateSpace {
    let p = gains.len();
    let (mut a, mut b, mut c) =
        (DMatrix::zeros(2 * p, 2 * p), DMatrix::zeros(2 * p, p), DMatrix::zeros(p, 2 * p));
    for (i, gain) in gains.iter().enumerate() {
        a[(2 * i, 2 * i + 1)] = 1.0;
        b[(2 * i + 1, i)] = *gain;
        c[(i, 2 * i)] = 1.0;
    }
    StateSpace::from_continuous(&a, &b, &c, sample_time_s, discretization).unwrap()
}

/// The paper's altitude (9), position (15) and attitude (23) plants, by forward Euler.
pub fn paper_plants() -> [(&'static str, Augmented); 3] {
    let euler = Discretization::ForwardEuler;
    [
        ("altitude", Augmented::new(&double_integrators(&[1.0], 0.05, euler))),
        ("position", Augmented::new(&double_integrators(&[-9.81, 9.81], 0.05, euler))),
        (
            "attitude",
            Augmented::new(&double_integrators(&[1.0 / 0.1063, 1.0 / 0.1063, 1.0 / 0.2122], 0.01, euler)),
        ),
    ]
}

/// The same basis for every input of a model.
pub fn bases(model: &Augmented, terms: usize, scale: f64) -> Vec<LaguerreBasis> {
    vec![LaguerreBasis::new(terms, scale).unwrap(); model.inputs()]
}

/// Largest element of the difference, relative to the largest element of the second matrix.
pub fn relative_difference(actual: &DMatrix<f64>, expected: &DMatrix<f64>) -> f64 {
    (actual - expected).amax() / expected.amax()
}
