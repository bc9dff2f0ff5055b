//! Solutions do not depend on units: of the cost, of the unknowns, of the constraints.

use lmpc::{Outcome, QuadraticProgram, Solution, WarmStart};
use nalgebra::{DMatrix, DVector, SVector, dmatrix};
use proptest::prelude::*;

use crate::common::quadratic_problem::{LIMIT, N, Problem, clarabel, problem};

/// Units of a problem: cost in 1/`cost`, unknown j in 1/(`all` · `unknown[j]`), constraint i in 1/`row[i]`.
#[derive(Clone, Debug)]
struct Units {
    cost: f64,
    all: f64,
    unknown: Vec<f64>,
    row: Vec<f64>,
}

impl Units {
    /// The same problem in these units: its solution is all · unknown[j] · x[j].
    fn apply(&self, problem: &Problem) -> Problem {
        let unit = |j: usize| self.unknown[j] * self.all;
        Problem {
            h: DMatrix::from_fn(N, N, |i, j| problem.h[(i, j)] * self.cost / unit(i) / unit(j)),
            f: SVector::from_fn(|i, _| problem.f[i] * self.cost / unit(i)),
            g: DMatrix::from_fn(problem.g.nrows(), N, |i, j| problem.g[(i, j)] * self.row[i] / unit(j)),
            bounds: problem.bounds.iter().zip(&self.row).map(|(bound, row)| bound * row).collect(),
        }
    }
}

fn solve(problem: &Problem) -> (Solution<N>, WarmStart<N>) {
    let program = QuadraticProgram::<N>::new(&problem.h, &problem.g).unwrap();
    let mut active = WarmStart::default();
    let solution = program.solve(&problem.f, &problem.bounds, &mut active, LIMIT);
    (solution, active)
}

/// Karush, Kuhn and Tucker's conditions, every one relative to the sizes of its own terms.
fn optimality(problem: &Problem, solution: &Solution<N>, active: &WarmStart<N>) -> Result<(), TestCaseError> {
    let x = DVector::from_column_slice(solution.x.as_slice());
    let f = DVector::from_column_slice(problem.f.as_slice());
    let mut gradient = &problem.h * &x + &f;
    let mut terms = (problem.h.abs() * x.abs()).norm() + f.norm();
    for (&u, row) in solution.multipliers.iter().zip(active.constraints()) {
        prop_assert!(u >= 0.0);
        gradient += problem.g.row(row).transpose() * u;
        terms += problem.g.row(row).norm() * u;
    }
    prop_assert!(gradient.norm() <= 1e-9 * terms, "gradient {:e} of {terms:e}", gradient.norm());
    for (row, &bound) in problem.bounds.iter().enumerate() {
        let excess = (problem.g.row(row) * &x)[0] - bound;
        let terms = problem.g.row(row).norm() * x.norm() + bound.abs();
        prop_assert!(excess <= 1e-9 * terms, "constraint {row}: {excess:e} of {terms:e}");
        if active.constraints().any(|active| active == row) {
            prop_assert!(excess >= -1e-9 * terms, "active constraint {row}: {excess:e} of {terms:e}");
        }
    }
    Ok(())
}

/// 2ⁿ, up to 40 orders of magnitude.
fn binary() -> impl Strategy<Value = f64> {
    (-66..=66).prop_map(|exponent| 2_f64.powi(exponent))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Powers of two only change exponents: every digit of the solution is the same.
    #[test]
    fn powers_of_two_change_no_digit(
        problem in problem(),
        cost in binary(), all in binary(),
        unknown in prop::collection::vec(binary(), N), row in prop::collection::vec(binary(), 25),
    ) {
        // The root of the cost's unit is a power of two as well.
        let units = Units { cost: cost * cost, all, unknown, row };
        let (solution, active) = solve(&problem);
        let (scaled, scaled_active) = solve(&units.apply(&problem));
        prop_assert_eq!(scaled.outcome, solution.outcome);
        prop_assert_eq!(scaled.iterations, solution.iterations);
        prop_assert_eq!(scaled_active, active);
        if solution.outcome == Outcome::Optimal {
            for j in 0..N {
                prop_assert_eq!(scaled.x[j], solution.x[j] * units.unknown[j] * units.all);
            }
            for (j, row) in active.constraints().enumerate() {
                prop_assert_eq!(scaled.multipliers[j], solution.multipliers[j] * units.cost / units.row[row]);
            }
        }
    }

    /// The cost times 10^s, the unknowns times 10^t: the optimum is still Clarabel's.
    #[test]
    fn solutions_in_any_unit_are_clarabels(problem in problem(), s in -20.0..20.0, t in -20.0..20.0) {
        let units = Units {
            cost: 10_f64.powf(s),
            all: 10_f64.powf(t),
            unknown: vec![1.0; N],
            row: vec![10_f64.powf(t); problem.bounds.len()],
        };
        let scaled = units.apply(&problem);
        let (solution, active) = solve(&scaled);
        match solution.outcome {
            Outcome::Optimal => {
                optimality(&scaled, &solution, &active)?;
                let x = solution.x / units.all;
                // On the border of what is feasible Clarabel may find nothing.
                if let Some(other) = clarabel(&problem) {
                    let cost = problem.cost(&other);
                    let excess = problem.cost(&x) - cost;
                    prop_assert!(excess < 1e-6 * (1.0 + cost.abs()), "{excess:e}");
                }
            }
            Outcome::Infeasible => prop_assert!(clarabel(&problem.tightened(1e-6)).is_none()),
            outcome => prop_assert!(false, "{outcome:?}"),
        }
    }

    /// Bounds far smaller than what the free optimum would be: the corner is met to the digits of the bounds, not of
    /// the free optimum. In units of the bounds Clarabel finds the same.
    #[test]
    fn tiny_bounds_are_kept_to_their_own_digits(
        problem in problem(), size in prop::array::uniform12(0.1..1.0), exponent in -20.0..-2.0,
    ) {
        let tiny = 10_f64.powf(exponent);
        // A box as well, so that there is a corner.
        let mut scaled = problem.clone();
        let (rows, identity) = (problem.g.nrows(), DMatrix::<f64>::identity(N, N));
        scaled.g = scaled.g.resize_vertically(rows + 2 * N, 0.0);
        scaled.g.rows_mut(rows, N).copy_from(&identity);
        scaled.g.rows_mut(rows + N, N).copy_from(&-identity);
        scaled.bounds.extend(size);
        // x = tiny · y: ½ tiny yᵀHy + fᵀy subject to G y ≤ bounds is the same problem.
        let units_of_bounds = Problem { h: &problem.h * tiny, ..scaled.clone() };
        for bound in &mut scaled.bounds {
            *bound *= tiny;
        }
        let (solution, active) = solve(&scaled);
        match (solution.outcome, clarabel(&units_of_bounds)) {
            (Outcome::Optimal, other) => {
                optimality(&scaled, &solution, &active)?;
                if let Some(y) = other {
                    let cost = units_of_bounds.cost(&y);
                    let excess = units_of_bounds.cost(&(solution.x / tiny)) - cost;
                    prop_assert!(excess < 1e-6 * (1.0 + cost.abs()), "{excess:e}");
                }
            }
            (Outcome::Infeasible, _) => prop_assert!(clarabel(&units_of_bounds.tightened(1e-6)).is_none()),
            (outcome, _) => prop_assert!(false, "{outcome:?}"),
        }
    }
}

/// min ½|x − (3, 4)|² with x₁ ≤ 1, x₂ ≤ 2, in units in which the numbers are tiny or huge.
#[test]
fn a_corner_is_exact_in_any_unit() {
    for exponent in -20..=20 {
        let (unit, cost) = (10_f64.powi(exponent), 10_f64.powi(-2 * exponent / 3));
        let program =
            QuadraticProgram::<2>::new(&(DMatrix::identity(2, 2) * cost), &dmatrix![1.0, 0.0; 0.0, 1.0])
                .unwrap();
        let f = SVector::<f64, 2>::new(-3.0, -4.0) * (cost * unit);
        let bounds = [1.0, 2.0].map(|bound| bound * unit);
        let solution = program.solve(&f, &bounds, &mut WarmStart::default(), LIMIT);
        let corner = SVector::<f64, 2>::new(1.0, 2.0);
        assert!((solution.x / unit - corner).norm() < 1e-14, "10^{exponent}: {}", solution.x / unit);
        assert_eq!((solution.outcome, solution.active), (Outcome::Optimal, 2), "10^{exponent}");
    }
}

/// A contradiction of a thousandth of the bounds is one in any unit.
#[test]
fn contradictions_are_seen_in_any_unit() {
    let program =
        QuadraticProgram::<2>::new(&DMatrix::identity(2, 2), &dmatrix![1.0, 0.0; -1.0, 0.0]).unwrap();
    for exponent in -40..=40 {
        let unit = 10_f64.powi(exponent);
        let outcome = |lower: f64| {
            let bounds = [unit, -lower * unit];
            program.solve(&SVector::zeros(), &bounds, &mut WarmStart::default(), LIMIT).outcome
        };
        assert_eq!(outcome(1.001), Outcome::Infeasible, "10^{exponent}");
        assert_eq!(outcome(0.999), Outcome::Optimal, "10^{exponent}");
    }
}
