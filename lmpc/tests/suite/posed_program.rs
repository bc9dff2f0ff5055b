//! The program as matrices, solved by Clarabel: its first move is that of the controller.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};
use lmpc::{Controller, ControllerState, DesignError, PosedProgram, Sample, SignalLimit, StabilizedMpc};
use nalgebra::{DMatrix, DVector, Vector1, Vector3};

use crate::common::lagged_integrators::Case;

const SLACK_COST: f64 = 1e4;
type Law = StabilizedMpc<3, 1, 1, 6>;
type State = ControllerState<3, 1, 6>;

fn case() -> Case {
    Case { sample_time_s: 0.05, lag_s: 0.1, increment_weight: 1.0, slower: 100.0, terms: 5, scale: 0.7 }
}

/// |u| and |v| on 25 samples.
fn limits() -> [SignalLimit; 2] {
    let (range, samples) = (|| SignalLimit::range(1), || (0..25).collect());
    [
        SignalLimit::of_inputs(3, 1, range(), samples()).giving_way_by(1.0),
        SignalLimit::of_states(3, 1, &[1], range(), samples()).giving_way_by(1.0),
    ]
}

fn solved(left: &DMatrix<f64>, start: &DVector<f64>, upper: &DVector<f64>) -> DVector<f64> {
    let n = start.len();
    let rows: Vec<Vec<f64>> = left.row_iter().map(|row| row.iter().copied().collect()).collect();
    let mut settings = DefaultSettingsBuilder::default();
    settings.verbose(false).tol_gap_abs(1e-11).tol_gap_rel(1e-11).tol_feas(1e-11);
    let settings = settings.build().unwrap();
    let mut solver = DefaultSolver::new(
        &CscMatrix::identity(n),
        (-start).as_slice(),
        &CscMatrix::from(rows.iter().map(Vec::as_slice)),
        upper.as_slice(),
        &[NonnegativeConeT(upper.len())],
        settings,
    )
    .unwrap();
    solver.solve();
    assert!(matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved));
    DVector::from_column_slice(&solver.solution.x)
}

#[test]
fn another_solver_finds_the_same_move() {
    let design = case().design(1);
    let law = Law::new(&design, &limits(), SLACK_COST).unwrap();
    let program = PosedProgram::new(&design, &limits(), SLACK_COST).unwrap();
    assert_eq!(program.left().nrows(), law.rows());
    let upper = [0.6, 0.6, 0.5, 0.5];
    let moved: Vec<f64> = (0..law.rows() / 2).map(|index| 0.002 * index as f64).collect();
    let mut limited = 0;
    for number in 0..40 {
        let share = f64::from(number) / 40.0;
        let measured = Vector3::new(0.0, 0.8 * share - 0.4, 0.1);
        let sample = Sample {
            measured,
            increment: Vector3::new(measured.y * 0.05, 0.0, 0.0),
            error: Vector1::new(4.0 * share - 2.0),
            input_reference: Vector1::new(0.1),
            upper: &upper,
            moved: &moved,
            ..Sample::default()
        };
        let before = State::new(measured, Vector1::new(0.2 - 0.3 * share), Vector1::new(0.1));
        let (start, bounds) = program.at(&sample, &before.feedback());
        let z = solved(program.left(), &start, &bounds);
        let step = law.step(&mut { before }, &sample);
        let expected = program.increment(&sample, &z);
        let difference = (step.increment - expected).norm();
        assert!(difference < 1e-6 * (1.0 + expected.norm()), "{number}: {step:?} {expected}");
        limited += usize::from(step.active > 0);
    }
    assert!(limited > 10, "{limited} samples at a limit");
}

#[test]
fn what_does_not_fit_is_refused() {
    let design = case().design(1);
    let wide = SignalLimit::of_inputs(3, 2, SignalLimit::range(2), vec![0]);
    let error = PosedProgram::new(&design, &[wide], SLACK_COST).unwrap_err();
    assert!(matches!(error, DesignError::Dimension { .. }), "{error}");
    let error = PosedProgram::new(&design, &limits(), 0.0).unwrap_err();
    assert_eq!(error, DesignError::SlackCost { value: 0.0 });
}
