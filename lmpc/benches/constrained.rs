//! One control step of the position controller under 40 limit rows: unconstrained, at a limit with the last
//! active set still right, at a limit from scratch, and the same program in an interior-point solver; one of
//! the attitude controller under 180 rows.

use std::f64::consts::PI;
use std::hint::black_box;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT};
use criterion::{Criterion, criterion_group, criterion_main};
use lmpc::{
    Augmented, Controller, ControllerState, Discretization, LaguerreBasis, LaguerreMpc, Limit, LmpcDesign,
    QuadraticProgram, Quantity, Sample, StateSpace, WarmStart, Weighting, Weights,
};
use nalgebra::{DMatrix, SVector, Vector2, Vector3, dmatrix};

/// Laguerre terms per input.
const TERMS: usize = 5;
const UNKNOWNS: usize = 2 * TERMS;

fn design() -> LmpcDesign {
    let g = 9.806_65;
    let a = dmatrix![0.0, 1.0, 0.0, 0.0; 0.0, 0.0, 0.0, 0.0; 0.0, 0.0, 0.0, 1.0; 0.0, 0.0, 0.0, 0.0];
    let b = dmatrix![0.0, 0.0; -g, 0.0; 0.0, 0.0; 0.0, g];
    let c = dmatrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, 1.0, 0.0];
    let plant =
        StateSpace::from_continuous(&a, &b, &c, 0.05, Discretization::ZeroOrderHold).expect("a plant");
    let model = Augmented::new(&plant);
    let weights = Weights::output(&model, 1.0, 1000.0).expect("weights");
    let bases = vec![LaguerreBasis::new(TERMS, 0.85).expect("a basis"); 2];
    LmpcDesign::new(&model, &weights, &bases, 100, Weighting::Terminal { lambda: 1.0 }).expect("a design")
}

/// Eight directions of tilt over four samples, and ranges of both increments over two.
fn limits() -> [Limit; 2] {
    [Limit::polygon(Quantity::Input, 8, 0..4), Limit::range(Quantity::Increment, 2, 0..2)]
}

fn bounds() -> Vec<f64> {
    let mut bounds = vec![0.3 * (PI / 8.0).cos(); 8];
    bounds.extend([0.1; 4]);
    bounds
}

fn steps(criterion: &mut Criterion) {
    let controller = LaguerreMpc::<4, 2, 2, { UNKNOWNS + 1 }>::new(&design(), &limits()).expect("limits");
    let bounds = bounds();
    let start = ControllerState::at_rest();
    let step = |state: &mut ControllerState<4, 2, { UNKNOWNS + 1 }>, error: &Vector2<f64>| {
        controller.step(state, &Sample { error: *error, upper: &bounds, ..Sample::default() })
    };
    let (near, far) = (Vector2::new(-0.01, 0.01), Vector2::new(-5.0, -5.0));
    let mut warm = start;
    assert!(step(&mut warm, &far).active > 0 && step(&mut { start }, &near).active == 0);
    warm.apply(&Vector2::zeros());

    let mut group = criterion.benchmark_group("step");
    group.bench_function("unconstrained", |bencher| bencher.iter(|| step(&mut { start }, black_box(&near))));
    group.bench_function("at its limits, warm", |bencher| {
        bencher.iter(|| step(&mut { warm }, black_box(&far)))
    });
    group.bench_function("at its limits, cold", |bencher| {
        bencher.iter(|| step(&mut { start }, black_box(&far)))
    });
    group.finish();
}

/// The attitude controller with amplitude and increment limits of three torques over 15 samples: 180 rows.
fn attitude_steps(criterion: &mut Criterion) {
    let double = |gain: f64| dmatrix![0.0, 1.0, 0.0; 0.0, 0.0, gain];
    let (mut a, mut b, mut c) = (DMatrix::zeros(6, 6), DMatrix::zeros(6, 3), DMatrix::zeros(3, 6));
    for (axis, inertia_kg_m2) in [0.1063, 0.1063, 0.2122].into_iter().enumerate() {
        let chain = double(1.0 / inertia_kg_m2);
        a.view_mut((2 * axis, 2 * axis), (2, 2)).copy_from(&chain.columns(0, 2));
        b.view_mut((2 * axis, axis), (2, 1)).copy_from(&chain.columns(2, 1));
        c[(axis, 2 * axis)] = 1.0;
    }
    let plant =
        StateSpace::from_continuous(&a, &b, &c, 0.01, Discretization::ZeroOrderHold).expect("a plant");
    let model = Augmented::new(&plant);
    let weights = Weights::output(&model, 1.0, 12.0).expect("weights");
    let bases = vec![LaguerreBasis::new(TERMS, 0.86).expect("a basis"); 3];
    let design = LmpcDesign::new(&model, &weights, &bases, 60, Weighting::Terminal { lambda: 1.0 });
    let limits = [Limit::range(Quantity::Input, 3, 0..15), Limit::range(Quantity::Increment, 3, 0..15)];
    let controller =
        LaguerreMpc::<6, 3, 3, { 3 * TERMS + 1 }>::new(&design.expect("a design"), &limits).expect("limits");
    let bounds = [0.9, 0.9, 0.145, 0.9, 0.9, 0.145, 0.2, 0.2, 0.05, 0.2, 0.2, 0.05];
    let start = ControllerState::at_rest();
    let step = |state: &mut ControllerState<6, 3, { 3 * TERMS + 1 }>, error: &Vector3<f64>| {
        controller.step(state, &Sample { error: *error, upper: &bounds, ..Sample::default() })
    };
    let far = Vector3::new(1.0, -0.7, 0.5);
    let mut warm = start;
    assert!(step(&mut warm, &far).active > 3);
    warm.apply(&Vector3::zeros());
    let mut group = criterion.benchmark_group("attitude step, 180 rows");
    group.bench_function("at its limits, warm", |bencher| {
        bencher.iter(|| step(&mut { warm }, black_box(&far)))
    });
    group.bench_function("at its limits, cold", |bencher| {
        bencher.iter(|| step(&mut { start }, black_box(&far)))
    });
    group.finish();
}

/// The same random program of this size in both solvers.
fn solvers(criterion: &mut Criterion) {
    let design = design();
    let omega = design.prediction().omega();
    let g = DMatrix::from_fn(40, UNKNOWNS, |row, column| ((row * 7 + column * 3) as f64).sin());
    let f = SVector::<f64, UNKNOWNS>::from_fn(|i, _| 1e5 * (i as f64 + 1.0).cos());
    let bounds = vec![0.05; 40];

    let program = QuadraticProgram::<UNKNOWNS>::new(omega, &g).expect("a program");
    let columns = |matrix: &DMatrix<f64>| -> CscMatrix<f64> {
        let rows: Vec<Vec<f64>> = matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
        CscMatrix::from(rows.iter().map(Vec::as_slice))
    };
    let (p, a) = (columns(&omega.upper_triangle()), columns(&g));
    let mut group = criterion.benchmark_group("program of 10 unknowns and 40 rows");
    group.bench_function("dual active set, cold", |bencher| {
        bencher.iter(|| program.solve(black_box(&f), &bounds, &mut WarmStart::default(), 1000));
    });
    let set_up = || {
        // Without presolving, gradient and bounds can be replaced later.
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .presolve_enable(false)
            .build()
            .expect("settings");
        DefaultSolver::new(&p, f.as_slice(), &a, &bounds, &[NonnegativeConeT(40)], settings)
            .expect("a solver")
    };
    group.bench_function("Clarabel, set up once", |bencher| {
        let mut solver = set_up();
        bencher.iter(|| {
            solver.update_q(&black_box(&f).as_slice().to_vec()).expect("a gradient");
            solver.update_b(&bounds).expect("bounds");
            solver.solve();
            solver.solution.obj_val
        });
    });
    group.bench_function("Clarabel, set up each time", |bencher| {
        bencher.iter(|| {
            let mut solver = set_up();
            solver.solve();
            solver.solution.obj_val
        });
    });
    group.finish();
}

criterion_group!(benches, steps, attitude_steps, solvers);
criterion_main!(benches);
