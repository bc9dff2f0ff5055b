//! Quadratic programs as they go to any solver.

use nalgebra::DMatrix;
use serde::Serialize;

/// min ½ |z − z₀|² under G z ≤ b, at many samples.
#[derive(Clone, Debug, Serialize)]
pub struct Program {
    /// "position".
    pub name: String,
    /// Elements of z.
    pub unknowns: usize,
    /// Rows of G.
    pub rows: usize,
    /// G, row by row.
    pub left: Vec<f64>,
    /// The samples, flight by flight.
    pub samples: Vec<PosedSample>,
}

/// One of its samples.
#[derive(Clone, Debug, Serialize)]
pub struct PosedSample {
    /// Which flight it is of; solvers that remember begin anew with each.
    pub flight: usize,
    /// f = −z₀.
    pub gradient: Vec<f64>,
    /// b.
    pub upper: Vec<f64>,
}

impl Program {
    /// G.
    pub fn left_matrix(&self) -> DMatrix<f64> {
        DMatrix::from_row_slice(self.rows, self.unknowns, &self.left)
    }

    /// |z − z₀|/2 squared, the cost of a z at a sample.
    pub fn cost(&self, sample: &PosedSample, z: &[f64]) -> f64 {
        0.5 * sample.gradient.iter().zip(z).map(|(gradient, z)| (z + gradient).powi(2)).sum::<f64>()
    }

    /// By how much z breaks the row that it breaks most, 0 when it keeps all.
    pub fn violation(&self, sample: &PosedSample, z: &[f64]) -> f64 {
        let rows = self.left.chunks_exact(self.unknowns).zip(&sample.upper);
        rows.map(|(row, upper)| row.iter().zip(z).map(|(left, z)| left * z).sum::<f64>() - upper)
            .fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::{PosedSample, Program};

    #[test]
    fn cost_and_violation_are_those_of_the_plane() {
        let sample = PosedSample { flight: 0, gradient: vec![-3.0, -4.0], upper: vec![1.0, 9.0] };
        let left = vec![1.0, 0.0, 0.0, 1.0];
        let program = Program { name: "plane".to_owned(), unknowns: 2, rows: 2, left, samples: vec![sample] };
        let sample = &program.samples[0];
        assert_eq!(program.cost(sample, &[0.0, 0.0]), 12.5);
        assert_eq!(program.cost(sample, &[3.0, 4.0]), 0.0);
        assert_eq!(program.violation(sample, &[3.0, 4.0]), 2.0);
        assert_eq!(program.violation(sample, &[1.0, 4.0]), 0.0);
    }
}
