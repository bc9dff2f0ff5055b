//! The reference solutions of a program.

use crate::Failure;
use crate::clarabel_solver::Clarabels;
use crate::program::Program;
use crate::solver::Maker;

/// Tolerance of the reference.
const TOLERANCE: f64 = 1e-12;

/// z of every sample, to Clarabel's finest; `None` where it does not get there.
///
/// # Errors
/// When the program is refused.
pub fn solutions(program: &Program) -> Result<Vec<Option<Vec<f64>>>, Failure> {
    let maker = Clarabels { tolerance: Some(TOLERANCE) };
    let mut solver = maker.solver(program).ok_or("Clarabel refuses the program")?;
    let mut z = vec![0.0; program.unknowns];
    let solved =
        program.samples.iter().map(|sample| solver.solve(sample, false, &mut z).solved.then(|| z.clone()));
    Ok(solved.collect())
}

#[cfg(test)]
mod tests {
    use super::solutions;
    use crate::program::{PosedSample, Program};

    /// The nearest point of a half plane, known without a solver.
    #[test]
    fn the_reference_is_the_nearest_point() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let sample = |upper| PosedSample { flight: 0, gradient: vec![-2.0, -2.0], upper: vec![upper] };
        let program = Program {
            name: "half plane".to_owned(),
            unknowns: 2,
            rows: 1,
            left: vec![half, half],
            samples: vec![sample(half), sample(10.0)],
        };
        let solutions = solutions(&program).unwrap();
        for (solution, expected) in solutions.iter().zip([0.5, 2.0]) {
            let z = solution.as_ref().unwrap();
            assert!(z.iter().all(|z| (z - expected).abs() < 1e-7), "{z:?}");
        }
    }
}
