//! The dual active-set solver against optimality conditions, enumeration and an interior-point solver.

use lmpc::{DesignError, Outcome, QuadraticProgram, WarmStart};
use nalgebra::{DMatrix, DVector, SVector, dmatrix};
use proptest::prelude::*;

use crate::common::quadratic_problem::{LIMIT, N, Problem, clarabel, problem};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    /// Karush, Kuhn and Tucker's conditions, which for a convex problem are the optimum:
    /// H x + f + Gᵀu = 0, u ≥ 0, G x ≤ h, and u = 0 wherever the bound is not met.
    #[test]
    fn solutions_meet_the_optimality_conditions(problem in problem()) {
        let program = QuadraticProgram::<N>::new(&problem.h, &problem.g).unwrap();
        let mut active = WarmStart::default();
        let solution = program.solve(&problem.f, &problem.bounds, &mut active, LIMIT);
        prop_assert!(matches!(solution.outcome, Outcome::Optimal | Outcome::Infeasible));
        if solution.outcome == Outcome::Optimal {
            let x = DVector::from_column_slice(solution.x.as_slice());
            let mut gradient = &problem.h * &x + DVector::from_column_slice(problem.f.as_slice());
            let scale = 1.0 + gradient.norm() + solution.multipliers.norm();
            for (j, row) in active.constraints().enumerate() {
                let u = solution.multipliers[j];
                gradient += problem.g.row(row).transpose() * u;
                prop_assert!(u >= 0.0);
                let slack = problem.bounds[row] - (problem.g.row(row) * &x)[0];
                prop_assert!(slack.abs() < 1e-7 * (1.0 + x.norm()), "constraint {row}: {slack}");
            }
            prop_assert!(gradient.norm() < 1e-8 * scale, "{}", gradient.norm() / scale);
            prop_assert!(problem.violation(&solution.x) < 1e-8 * (1.0 + x.norm()));
        }
    }

    /// An interior-point solver finds the same optimum, or none either. On the border between feasible and not it may
    /// find none where there is one, and there is none when bounds that are tighter by a millionth decide.
    #[test]
    fn solutions_are_clarabels(problem in problem()) {
        let program = QuadraticProgram::<N>::new(&problem.h, &problem.g).unwrap();
        let solution = program.solve(&problem.f, &problem.bounds, &mut WarmStart::default(), LIMIT);
        match (solution.outcome, clarabel(&problem)) {
            (Outcome::Optimal, Some(x)) => {
                // Ours is feasible to rounding. Where the interior-point method ends early, ours is the better.
                let scale = 1.0 + problem.cost(&x).abs();
                let excess = problem.cost(&solution.x) - problem.cost(&x);
                prop_assert!(problem.violation(&solution.x) < 1e-8 * (1.0 + solution.x.norm()));
                prop_assert!(excess < 1e-6 * scale && excess > -1e-3 * scale, "{excess}");
            }
            (Outcome::Optimal, None) => {
                prop_assert!(problem.violation(&solution.x) < 1e-8 * (1.0 + solution.x.norm()));
            }
            (Outcome::Infeasible, _) => prop_assert!(clarabel(&problem.tightened(1e-6)).is_none()),
            (outcome, _) => prop_assert!(false, "{outcome:?}"),
        }
    }

    /// Where there are few constraints, all active sets can be tried.
    #[test]
    fn solutions_are_those_of_enumeration(mut problem in problem()) {
        let few = problem.bounds.len().min(6);
        problem.bounds.truncate(few);
        problem.g = problem.g.rows(0, few).into_owned();
        let program = QuadraticProgram::<N>::new(&problem.h, &problem.g).unwrap();
        let solution = program.solve(&problem.f, &problem.bounds, &mut WarmStart::default(), LIMIT);
        if let Some((best, _)) = enumerated(&problem) {
            prop_assert_eq!(solution.outcome, Outcome::Optimal);
            let scale = 1.0 + problem.cost(&best).abs();
            prop_assert!((problem.cost(&solution.x) - problem.cost(&best)).abs() < 1e-6 * scale);
        }
    }

    /// A warm start from any active set, however wrong, ends at the same optimum.
    #[test]
    fn warm_starts_change_nothing(first in problem(), f in prop::array::uniform6(-5.0..5.0)) {
        let program = QuadraticProgram::<N>::new(&first.h, &first.g).unwrap();
        let mut warm = WarmStart::default();
        program.solve(&first.f, &first.bounds, &mut warm, LIMIT);
        let warm_solution = program.solve(&f.into(), &first.bounds, &mut warm, LIMIT);
        let cold_solution = program.solve(&f.into(), &first.bounds, &mut WarmStart::default(), LIMIT);
        prop_assert_eq!(warm_solution.outcome, cold_solution.outcome);
        if cold_solution.outcome == Outcome::Optimal {
            let scale = 1.0 + cold_solution.x.norm();
            prop_assert!((warm_solution.x - cold_solution.x).norm() < 1e-6 * scale);
        }
        // The second time it is there at once.
        let again = program.solve(&f.into(), &first.bounds, &mut warm, LIMIT);
        if cold_solution.outcome == Outcome::Optimal {
            prop_assert_eq!(again.iterations, 0);
        }
    }

    /// Nothing makes it panic, loop or return numbers that are none.
    #[test]
    fn absurd_numbers_are_survived(
        problem in problem(),
        f in prop::array::uniform6(prop_oneof![any::<f64>(), Just(f64::NAN), Just(1e300), Just(-0.0)]),
        bounds in prop::collection::vec(prop_oneof![any::<f64>(), Just(f64::NAN), Just(f64::INFINITY), Just(-1e300)], 0..30),
    ) {
        let program = QuadraticProgram::<N>::new(&problem.h, &problem.g).unwrap();
        let bounds = &bounds[..bounds.len().min(program.constraints())];
        let solution = program.solve(&f.into(), bounds, &mut WarmStart::default(), 50);
        prop_assert!(solution.iterations <= 50);
        if solution.outcome == Outcome::Optimal {
            prop_assert!(solution.x.iter().all(|x| x.is_finite()));
        }
    }
}

/// The best of all points that meet some constraints with equality, are feasible and have non-negative
/// multipliers: the optimum, by trying every active set.
fn enumerated(problem: &Problem) -> Option<(SVector<f64, N>, f64)> {
    let m = problem.bounds.len();
    let f = DVector::from_column_slice(problem.f.as_slice());
    let mut best: Option<(SVector<f64, N>, f64)> = None;
    for set in 0_u32..1 << m {
        let rows: Vec<usize> = (0..m).filter(|row| set >> row & 1 == 1).collect();
        if rows.len() > N {
            continue;
        }
        // [H Gᵀ; G 0] [x; u] = [−f; h]
        let size = N + rows.len();
        let mut kkt = DMatrix::zeros(size, size);
        let mut right = DVector::zeros(size);
        kkt.view_mut((0, 0), (N, N)).copy_from(&problem.h);
        right.rows_mut(0, N).copy_from(&-&f);
        for (j, &row) in rows.iter().enumerate() {
            for column in 0..N {
                kkt[(N + j, column)] = problem.g[(row, column)];
                kkt[(column, N + j)] = problem.g[(row, column)];
            }
            right[N + j] = problem.bounds[row];
        }
        let Some(solution) = kkt.lu().solve(&right) else { continue };
        let x = SVector::<f64, N>::from_column_slice(&solution.as_slice()[..N]);
        let pushes = solution.rows(N, rows.len()).iter().all(|&u| u >= -1e-9);
        if pushes && problem.violation(&x) < 1e-9 && best.is_none_or(|(_, cost)| problem.cost(&x) < cost) {
            best = Some((x, problem.cost(&x)));
        }
    }
    best
}

#[test]
fn the_unconstrained_optimum_is_returned_when_it_is_feasible() {
    let program =
        QuadraticProgram::<2>::new(&DMatrix::identity(2, 2), &dmatrix![1.0, 0.0; 0.0, 1.0]).unwrap();
    let f = SVector::<f64, 2>::new(-1.0, 2.0);
    let solution = program.solve(&f, &[5.0, 5.0], &mut WarmStart::default(), LIMIT);
    assert_eq!((solution.x, solution.iterations, solution.active), (-f, 0, 0));
}

#[test]
fn a_projection_onto_a_corner_is_exact() {
    // min ½|x − (3, 4)|² with x₁ ≤ 1, x₂ ≤ 2, x₁ + x₂ ≤ 10
    let g = dmatrix![1.0, 0.0; 0.0, 1.0; 1.0, 1.0];
    let program = QuadraticProgram::<2>::new(&DMatrix::identity(2, 2), &g).unwrap();
    let solution = program.solve(
        &SVector::<f64, 2>::new(-3.0, -4.0),
        &[1.0, 2.0, 10.0],
        &mut WarmStart::default(),
        LIMIT,
    );
    assert!((solution.x - SVector::<f64, 2>::new(1.0, 2.0)).norm() < 1e-15);
    assert_eq!(solution.active, 2);
}

/// A remembered constraint that the free optimum meets exactly holds with equality, without pushing.
#[test]
fn a_constraint_that_is_met_without_a_push_stays_active() {
    let program = QuadraticProgram::<2>::new(&DMatrix::identity(2, 2), &dmatrix![1.0, 0.0]).unwrap();
    let mut warm = WarmStart::default();
    let pushed = program.solve(&SVector::<f64, 2>::new(-2.0, 0.5), &[1.0], &mut warm, LIMIT);
    assert_eq!((pushed.active, pushed.multipliers[0]), (1, 1.0));
    let met = program.solve(&SVector::<f64, 2>::new(-1.0, 0.5), &[1.0], &mut warm, LIMIT);
    assert_eq!((met.active, met.multipliers[0], met.x), (1, 0.0, SVector::<f64, 2>::new(1.0, -0.5)));
}

/// Constraints that the program does not have, or that do not bound any more, are not resumed.
#[test]
fn a_warm_start_of_another_program_changes_nothing() {
    let g = dmatrix![1.0, 0.0; 0.0, 1.0; 1.0, 1.0];
    let three = QuadraticProgram::<2>::new(&DMatrix::identity(2, 2), &g).unwrap();
    let one = QuadraticProgram::<2>::new(&DMatrix::identity(2, 2), &dmatrix![1.0, 0.0]).unwrap();
    let f = SVector::<f64, 2>::new(-3.0, -4.0);
    let mut warm = WarmStart::default();
    let corner = three.solve(&f, &[1.0, 2.0, 10.0], &mut warm, LIMIT);
    assert_eq!(warm.constraints().max(), Some(1), "{corner:?}");
    // min ½|x − (3, 4)|² with x₁ ≤ 1 alone
    let edge = SVector::<f64, 2>::new(1.0, 4.0);
    let solution = one.solve(&f, &[1.0], &mut warm.clone(), LIMIT);
    assert_eq!((solution.x, solution.outcome, solution.active), (edge, Outcome::Optimal, 1));
    let unbounded = three.solve(&f, &[1.0, f64::INFINITY, f64::INFINITY], &mut warm, LIMIT);
    assert_eq!((unbounded.x, unbounded.outcome, unbounded.active), (edge, Outcome::Optimal, 1));
}

#[test]
fn contradictions_are_seen() {
    // x₁ ≤ −1 and −x₁ ≤ −1; then 0 ≤ −1
    let program =
        QuadraticProgram::<2>::new(&DMatrix::identity(2, 2), &dmatrix![1.0, 0.0; -1.0, 0.0]).unwrap();
    let solve = |program: &QuadraticProgram<2>, bounds: &[f64]| {
        program.solve(&SVector::zeros(), bounds, &mut WarmStart::default(), LIMIT).outcome
    };
    assert_eq!(solve(&program, &[-1.0, -1.0]), Outcome::Infeasible);
    assert_eq!(solve(&program, &[1.0, -1.0]), Outcome::Optimal);
    let empty = QuadraticProgram::<2>::new(&DMatrix::identity(2, 2), &dmatrix![0.0, 0.0]).unwrap();
    assert_eq!(solve(&empty, &[-1.0]), Outcome::Infeasible);
    assert_eq!(solve(&empty, &[0.0]), Outcome::Optimal);
}

#[test]
fn the_iteration_limit_is_kept_and_a_solution_does_not_allocate() {
    let g = DMatrix::from_fn(40, N, |row, column| f64::sin((row * 7 + column * 3) as f64));
    let program = QuadraticProgram::<N>::new(&DMatrix::identity(N, N), &g).unwrap();
    let f = SVector::<f64, N>::repeat(10.0);
    let bounds = [0.5; 40];
    let cut = program.solve(&f, &bounds, &mut WarmStart::default(), 2);
    assert_eq!((cut.outcome, cut.iterations), (Outcome::IterationLimit, 2));
    let allocations = allocation_counter::measure(|| {
        let solution = program.solve(&f, &bounds, &mut WarmStart::default(), LIMIT);
        assert_eq!(solution.outcome, Outcome::Optimal);
    });
    assert_eq!(allocations.count_total, 0);
}

#[test]
fn wrong_problems_are_refused() {
    let identity = DMatrix::identity(2, 2);
    assert!(matches!(
        QuadraticProgram::<1>::new(&identity, &dmatrix![1.0, 0.0]),
        Err(DesignError::Dimension { name: "H", .. })
    ));
    assert!(matches!(
        QuadraticProgram::<2>::new(&identity, &dmatrix![1.0]),
        Err(DesignError::Dimension { name: "G", .. })
    ));
    assert!(matches!(
        QuadraticProgram::<2>::new(&-identity, &dmatrix![1.0, 0.0]),
        Err(DesignError::NotPositiveDefinite { name: "H", eigenvalue: -1.0 })
    ));
}

/// Room for more unknowns than there are changes nothing.
#[test]
fn spare_room_changes_nothing() {
    let h = dmatrix![2.0, 0.5, 0.0; 0.5, 1.0, 0.2; 0.0, 0.2, 3.0];
    let g = DMatrix::from_fn(7, 3, |row, column| ((row * 5 + column * 3) as f64).sin());
    let bounds = [0.3; 7];
    let exact = QuadraticProgram::<3>::new(&h, &g).unwrap();
    let roomy = QuadraticProgram::<9>::new(&h, &g).unwrap();
    assert_eq!((exact.unknowns(), roomy.unknowns()), (3, 3));
    let f = [4.0, -3.0, 2.0];
    let small =
        exact.solve(&SVector::<f64, 3>::from_column_slice(&f), &bounds, &mut WarmStart::default(), LIMIT);
    let mut padded = SVector::<f64, 9>::zeros();
    padded.rows_mut(0, 3).copy_from_slice(&f);
    let large = roomy.solve(&padded, &bounds, &mut WarmStart::default(), LIMIT);
    assert!(small.active > 0 && small.outcome == Outcome::Optimal);
    assert_eq!(small.x.as_slice(), &large.x.as_slice()[..3]);
    assert!(large.x.as_slice()[3..].iter().all(|value| *value == 0.0));
    assert_eq!((small.active, small.iterations), (large.active, large.iterations));
}
