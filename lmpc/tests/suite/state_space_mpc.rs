//! State-space MPC against simulated predictions, LMPC with unit pulses, and its own limits.

use lmpc::{
    Augmented, Controller, ControllerState, DesignError, Discretization, Dlqr, Limit, Quantity, Sample,
    StateSpace, StateSpaceMpc, StateSpaceMpcDesign, StateSpaceMpcWeights, Status, Weights, spectral_radius,
};
use nalgebra::{DMatrix, DVector, Vector1, Vector2, dmatrix, dvector};
use proptest::prelude::*;

use crate::common::double_integrators;

const TIME: f64 = 0.05;
const MOVES: usize = 25;

fn plant() -> StateSpace {
    double_integrators(&[1.0], TIME, Discretization::ZeroOrderHold)
}

fn design() -> StateSpaceMpcDesign {
    StateSpaceMpcDesign::new(&plant(), &dmatrix![1.0], &dmatrix![1.0], 100, MOVES).unwrap()
}

fn applying(u: f64) -> ControllerState<2, 1, 26> {
    ControllerState::new(Vector2::zeros(), Vector1::new(u), Vector1::zeros())
}

/// A state without a reference trajectory.
fn of_state(state: Vector2<f64>) -> Sample<'static, 2, 1, 1> {
    Sample { measured: state, deviation: state, ..Sample::default() }
}

fn advanced(x: Vector2<f64>, u: f64) -> Vector2<f64> {
    Vector2::new(x.x + TIME * x.y + TIME * TIME / 2.0 * u, x.y + TIME * u)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// The first move is the one that minimises (34): simulate the cost as a function of the moves, and find
    /// its minimum by Newton's method with numerical derivatives, which for a quadratic is one step.
    #[test]
    fn the_first_move_minimises_the_simulated_cost(
        z in -3.0..3.0, v in -1.0..1.0, u in -1.0..1.0, r in prop::collection::vec(-2.0..2.0, 12),
    ) {
        const N: usize = 12;
        const N_C: usize = 4;
        let design = StateSpaceMpcDesign::new(&plant(), &dmatrix![3.0], &dmatrix![0.02], N, N_C);
        // A horizon this short need not be stable in closed loop; the prediction is what is tested.
        prop_assume!(design.is_ok());
        let controller = StateSpaceMpc::<2, 1, 1, 5>::new(&design.unwrap(), &[]).unwrap();
        let cost = |moves: &DVector<f64>| {
            let (mut x, mut input, mut cost): (Vector2<f64>, f64, f64) = (Vector2::new(z, v), u, 0.0);
            for (n, reference) in r.iter().enumerate().take(N) {
                cost += 0.5 * 3.0 * f64::powi(x.x - reference, 2);
                if n < N_C {
                    input += moves[n];
                    cost += 0.5 * 0.02 * moves[n].powi(2);
                }
                x = advanced(x, input);
            }
            cost
        };
        let unit = |i: usize| DVector::from_fn(N_C, |k, _| f64::from(k == i));
        let zero = DVector::zeros(N_C);
        let gradient = DVector::from_fn(N_C, |i, _| (cost(&unit(i)) - cost(&-unit(i))) / 2.0);
        let hessian = DMatrix::from_fn(N_C, N_C, |i, j| {
            cost(&(unit(i) + unit(j))) - cost(&unit(i)) - cost(&unit(j)) + cost(&zero)
        });
        let best = -hessian.lu().solve(&gradient).unwrap();

        let references: Vec<Vector1<f64>> = r.iter().map(|&value| Vector1::new(value)).collect();
        let mut state = applying(u);
        let step = controller.step(&mut state, &Sample { preview: &references, ..of_state(Vector2::new(z, v)) });
        prop_assert!((step.input.x - u - best[0]).abs() < 1e-7 * (1.0 + best[0].abs()));
    }

    /// … also with a disturbance that acts like an input, and a weight on the increments of the velocity.
    #[test]
    fn the_first_move_minimises_the_simulated_cost_with_damping_and_disturbance(
        z in -3.0..3.0, v in -1.0..1.0, u in -1.0..1.0, d in -1.0..1.0,
    ) {
        const N: usize = 40;
        const N_C: usize = 4;
        let (q, w, s) = (3.0, 5.0, 0.02);
        let weights = StateSpaceMpcWeights {
            output: dmatrix![q],
            moves: dmatrix![s],
            increment: dmatrix![0.0, 0.0; 0.0, w],
            terminal: None,
        };
        let design = StateSpaceMpcDesign::with_weights(&plant(), &weights, N, N_C);
        let controller = StateSpaceMpc::<2, 1, 1, 5>::new(&design.unwrap(), &[]).unwrap();
        let cost = |moves: &DVector<f64>| {
            let (mut x, mut input, mut cost): (Vector2<f64>, f64, f64) = (Vector2::new(z, v), u, 0.0);
            for n in 0..N {
                cost += 0.5 * q * f64::powi(x.x, 2);
                if n < N_C {
                    input += moves[n];
                    cost += 0.5 * s * moves[n].powi(2);
                }
                let next = advanced(x, input + d);
                cost += 0.5 * w * f64::powi(next.y - x.y, 2);
                x = next;
            }
            cost
        };
        let unit = |i: usize| DVector::from_fn(N_C, |k, _| f64::from(k == i));
        let zero = DVector::zeros(N_C);
        let gradient = DVector::from_fn(N_C, |i, _| (cost(&unit(i)) - cost(&-unit(i))) / 2.0);
        let hessian = DMatrix::from_fn(N_C, N_C, |i, j| {
            cost(&(unit(i) + unit(j))) - cost(&unit(i)) - cost(&unit(j)) + cost(&zero)
        });
        let best = -hessian.lu().solve(&gradient).unwrap();

        let sample = Sample {
            disturbance: Vector1::new(d),
            ..of_state(Vector2::new(z, v))
        };
        let step = controller.step(&mut applying(u), &sample);
        prop_assert!((step.input.x - u - best[0]).abs() < 1e-6 * (1.0 + best[0].abs()));
    }

    #[test]
    fn absurd_estimates_are_survived(
        values in prop::collection::vec(prop_oneof![any::<f64>(), Just(f64::NAN), Just(f64::INFINITY)], 9),
    ) {
        let limits = [Limit::range(Quantity::Input, 1, 0..10)];
        let controller = StateSpaceMpc::<2, 1, 1, 26>::new(&design(), &limits).unwrap();
        let mut state = applying(0.0);
        for chunk in values.chunks_exact(3) {
            let estimate = of_state(Vector2::new(chunk[0], chunk[1]));
            let sample = Sample { preview: &[Vector1::new(chunk[2])], upper: &[1.0, 1.0], ..estimate };
            let step = controller.step(&mut state, &sample);
            prop_assert!(step.input.x.is_finite());
            state.apply(&Vector1::new(chunk[0]));
        }
    }
}

#[test]
fn it_arrives_and_the_preview_makes_it_start_early() {
    let controller = StateSpaceMpc::<2, 1, 1, 26>::new(&design(), &[]).unwrap();
    let run = |preview: usize| {
        let mut state = applying(0.0);
        let (mut x, mut cost): (Vector2<f64>, f64) = (Vector2::zeros(), 0.0);
        for k in 0..400_usize {
            let reference = |sample: usize| Vector1::new(f64::from(sample >= 100));
            let references: Vec<_> = (0..=preview).map(|ahead| reference(k + ahead)).collect();
            let step = controller.step(&mut state, &Sample { preview: &references, ..of_state(x) });
            cost += f64::powi(x.x - reference(k).x, 2);
            x = advanced(x, step.input.x);
        }
        assert!((x.x - 1.0).abs() < 1e-3, "{x}");
        cost
    };
    assert!(run(99) < 0.6 * run(0));
}

/// With the regulator's cost as terminal weight and moves on all samples but the last the law is all but the regulator's.
#[test]
fn with_the_terminal_weight_many_moves_are_the_regulator() {
    let model = Augmented::new(&plant());
    let weights = Weights::output(&model, 1.0, 1.0).unwrap();
    let dlqr = Dlqr::new(model.a(), model.b(), weights.q(), weights.r(), 1.0).unwrap();
    let weights = StateSpaceMpcWeights {
        output: dmatrix![1.0],
        moves: dmatrix![1.0],
        increment: DMatrix::zeros(2, 2),
        terminal: Some(dlqr.cost().clone()),
    };
    let design = StateSpaceMpcDesign::with_weights(&plant(), &weights, 26, 25).unwrap();
    let controller = StateSpaceMpc::<2, 1, 1, 26>::new(&design, &[]).unwrap();
    // x, and where it came from under the old input: [Δx; y − r]
    for (x, u) in
        [(Vector2::new(2.0, -0.5), 0.0), (Vector2::new(-1.0, 0.7), 0.4), (Vector2::new(1.0, 0.0), -0.3)]
    {
        let before = Vector2::new(x.x - TIME * (x.y - TIME * u) - TIME * TIME / 2.0 * u, x.y - TIME * u);
        let delta = x - before;
        let regulated = u - (dlqr.gain() * dvector![delta.x, delta.y, x.x - 1.0])[0];
        let sample = of_state(x);
        let step = controller.step(&mut applying(u), &Sample { preview: &[Vector1::new(1.0)], ..sample });
        assert!(
            (step.input.x - regulated).abs() < 2e-3 * regulated.abs(),
            "{} beside {regulated}",
            step.input.x
        );
    }
}

/// The spectral radius is that of the plant under the law as it steps: columns of the closed loop in [x; u] are what
/// unit vectors become.
#[test]
fn the_spectral_radius_is_that_of_the_loop_as_it_steps() {
    let controller = StateSpaceMpc::<2, 1, 1, 26>::new(&design(), &[]).unwrap();
    let mut closed_loop = DMatrix::zeros(3, 3);
    for column in 0..3 {
        let unit = |row: usize| f64::from(row == column);
        let x = Vector2::new(unit(0), unit(1));
        let u = controller.step(&mut applying(unit(2)), &of_state(x)).input.x;
        let next = advanced(x, u);
        closed_loop.set_column(column, &dvector![next.x, next.y, u]);
    }
    let radius = spectral_radius("the closed loop", &closed_loop).unwrap();
    assert!((design().spectral_radius() - radius).abs() < 1e-9, "{radius}");
    assert!(radius > 0.5 && radius < 1.0);
}

/// A wind that the controller is told of leaves no error, whatever its integral would have had to find.
#[test]
fn a_known_disturbance_leaves_no_error() {
    let controller = StateSpaceMpc::<2, 1, 1, 26>::new(&design(), &[]).unwrap();
    let wind = Vector1::new(-0.7);
    let mut state = applying(0.0);
    let mut x = Vector2::zeros();
    for _ in 0..600 {
        let sample = Sample { disturbance: wind, ..of_state(x) };
        let step = controller.step(&mut state, &Sample { preview: &[Vector1::new(1.0)], ..sample });
        x = advanced(x, step.input.x + wind.x);
    }
    assert!((x.x - 1.0).abs() < 1e-6, "{x}");
}

/// Limits bound the whole input and its whole change, feed-forward included.
#[test]
fn feed_forward_counts_towards_the_limits() {
    let limits = [Limit::range(Quantity::Increment, 1, 0..5), Limit::range(Quantity::Input, 1, 0..5)];
    let controller = StateSpaceMpc::<2, 1, 1, 26>::new(&design(), &limits).unwrap();
    let bounds = [0.5, 0.5, 2.0, 2.0];
    let far = of_state(Vector2::new(-100.0, 0.0));
    let with = |input_reference: f64| Sample { input_reference: Vector1::new(input_reference), ..far };
    let mut state = applying(0.0);
    // The feed-forward steps by 0.3; feedback may add 0.2 …
    let step = controller.step(&mut state, &Sample { upper: &bounds, ..with(0.3) });
    assert!((step.input.x - 0.5).abs() < 1e-9, "{step:?}");
    // … and the sum ends at its limit.
    for _ in 0..10 {
        controller.step(&mut state, &Sample { upper: &bounds, ..with(0.3) });
    }
    assert!((state.applied().x - 2.0).abs() < 1e-9);
}

#[test]
fn limits_hold_in_closed_loop() {
    let limits = [
        Limit::range(Quantity::Increment, 1, 0..MOVES),
        Limit::range(Quantity::Input, 1, 0..MOVES),
        Limit {
            quantity: Quantity::State,
            directions: dmatrix![0.0, 1.0; 0.0, -1.0],
            samples: (1..60).collect(),
            soft: true,
        },
    ];
    let controller = StateSpaceMpc::<2, 1, 1, 26>::new(&design(), &limits).unwrap();
    let bounds = [0.2, 0.2, 1.0, 1.0, 1.5, 1.5];
    let mut state = applying(0.0);
    let (mut x, mut u, mut active) = (Vector2::zeros(), 0.0_f64, 0);
    for sample in 0..600 {
        let step = controller
            .step(&mut state, &Sample { preview: &[Vector1::new(10.0)], upper: &bounds, ..of_state(x) });
        assert_eq!(step.status, Status::Optimal, "sample {sample}");
        let next = step.input.x;
        assert!((next - u).abs() <= 0.2 + 1e-8 && next.abs() <= 1.0 + 1e-8, "sample {sample}: {u} to {next}");
        active += step.active;
        (x, u) = (advanced(x, next), next);
        assert!(x.y.abs() <= 1.5 + 1e-6, "sample {sample}: {} m/s", x.y);
    }
    assert!((x.x - 10.0).abs() < 1e-3 && active > 100, "{x}, {active}");
}

#[test]
fn a_step_does_not_allocate() {
    let limits = [Limit::range(Quantity::Input, 1, 0..MOVES)];
    let controller = StateSpaceMpc::<2, 1, 1, 26>::new(&design(), &limits).unwrap();
    let mut state = applying(0.0);
    let allocations = allocation_counter::measure(|| {
        let step = controller.step(
            &mut state,
            &Sample { preview: &[Vector1::new(5.0)], upper: &[0.1, 0.1], ..of_state(Vector2::zeros()) },
        );
        assert!(step.active > 0);
    });
    assert_eq!(allocations.count_total, 0);
}

#[test]
fn wrong_designs_are_refused() {
    let one = dmatrix![1.0];
    let refused = |q: &DMatrix<f64>, s: &DMatrix<f64>, horizon, moves| {
        StateSpaceMpcDesign::new(&plant(), q, s, horizon, moves).unwrap_err()
    };
    assert!(matches!(
        refused(&one, &-&one, 50, 5),
        DesignError::NotPositiveDefinite { name: "S", eigenvalue: -1.0 }
    ));
    assert!(matches!(refused(&-&one, &one, 50, 5), DesignError::NotPositiveSemidefinite { name: "Q", .. }));
    assert!(matches!(refused(&one, &one, 5, 5), DesignError::MovesBeyondHorizon { moves: 5, .. }));
    assert!(matches!(refused(&one, &one, 5, 0), DesignError::MovesBeyondHorizon { moves: 0, .. }));
    // Without a weight on the outputs nothing is controlled.
    assert!(matches!(refused(&(&one * 0.0), &one, 50, 5), DesignError::Unstable { .. }));
    let small = StateSpaceMpc::<2, 1, 1, 25>::new(&design(), &[]).unwrap_err();
    assert!(matches!(small, DesignError::Dimension { name: "H with slack", .. }), "{small}");
}
