//! Laguerre MPC with limits, in closed loop and against predictions made by simulation.

use lmpc::{
    Augmented, Controller, ControllerState, DesignError, Discretization, LaguerreBasis, LaguerreMpc, Limit,
    LmpcDesign, Quantity, Sample, Status, Weighting, Weights,
};
use nalgebra::{SMatrix, SVector, Vector1, Vector2, Vector4, dmatrix};
use proptest::prelude::*;

use crate::common::double_integrators;

const TIME: f64 = 0.05;
const GRAVITY: f64 = 9.806_65;

fn altitude_model() -> Augmented {
    Augmented::new(&double_integrators(&[1.0], TIME, Discretization::ZeroOrderHold))
}

fn design(model: &Augmented, terms: usize, scale: f64, weight: f64, weighting: Weighting) -> LmpcDesign {
    let weights = Weights::output(model, 1.0, weight).unwrap();
    let bases = vec![LaguerreBasis::new(terms, scale).unwrap(); model.inputs()];
    LmpcDesign::new(model, &weights, &bases, 100, weighting).unwrap()
}

/// Altitude, |G| ≤ 1 m/s², |ΔG| ≤ 0.2 m/s², |v| ≤ 1.5 m/s (soft), over the first 15 samples.
fn altitude(weighting: Weighting) -> LaguerreMpc<2, 1, 1, 6> {
    let limits = [
        Limit::range(Quantity::Increment, 1, 0..15),
        Limit::range(Quantity::Input, 1, 0..15),
        Limit {
            quantity: Quantity::State,
            directions: dmatrix![0.0, 1.0; 0.0, -1.0],
            samples: (1..30).collect(),
            soft: true,
        },
    ];
    LaguerreMpc::new(&design(&altitude_model(), 5, 0.8187, 1.0, weighting), &limits).unwrap()
}

const ALTITUDE_BOUNDS: [f64; 6] = [0.2, 0.2, 1.0, 1.0, 1.5, 1.5];

fn advanced(x: Vector2<f64>, u: f64) -> Vector2<f64> {
    Vector2::new(x.x + TIME * x.y + TIME * TIME / 2.0 * u, x.y + TIME * u)
}

fn at_rest() -> ControllerState<2, 1, 6> {
    ControllerState::at_rest()
}

#[test]
fn limits_hold_exactly_in_closed_loop() {
    for weighting in [Weighting::Terminal { lambda: 1.0 }, Weighting::exponential(1.2, 1.0)] {
        let controller = altitude(weighting);
        let (mut state, mut x, mut u, mut previous) =
            (at_rest(), Vector2::zeros(), 0.0_f64, Vector2::zeros());
        let mut active = 0;
        for sample in 0..600 {
            let error = Vector1::new(x.x - 10.0);
            let result = controller.step(
                &mut state,
                &Sample {
                    measured: x,
                    increment: x - previous,
                    error,
                    upper: &ALTITUDE_BOUNDS,
                    ..Sample::default()
                },
            );
            assert_eq!(result.status, Status::Optimal, "{weighting:?}, sample {sample}");
            let next = result.input.x;
            assert!(
                (next - u).abs() <= 0.2 + 1e-8 && next.abs() <= 1.0 + 1e-8,
                "sample {sample}: {u} to {next}"
            );
            active += result.active;
            (previous, x, u) = (x, advanced(x, next), next);
            assert!(x.y.abs() <= 1.5 + 1e-6, "sample {sample}: {} m/s", x.y);
        }
        assert!((x.x - 10.0).abs() < 1e-3, "{weighting:?}: {}", x.x);
        assert!(active > 100, "the limits were never needed");
    }
}

#[test]
fn without_need_for_limits_it_is_the_unconstrained_law() {
    let controller = altitude(Weighting::exponential(1.2, 1.0));
    let (mut state, mut free) = (at_rest(), ControllerState::<2, 1>::at_rest());
    let (mut x, mut previous) = (Vector2::zeros(), Vector2::zeros());
    for _ in 0..200 {
        let error = Vector1::new(x.x - 0.1);
        let delta = x - previous;
        let limited = controller.step(
            &mut state,
            &Sample { measured: x, increment: delta, error, upper: &ALTITUDE_BOUNDS, ..Sample::default() },
        );
        let unlimited = controller
            .unconstrained()
            .step(&mut free, &Sample { measured: x, increment: delta, error, ..Sample::default() });
        assert_eq!((limited, limited.active), (unlimited, 0));
        (previous, x) = (x, advanced(x, limited.input.x));
    }
}

#[test]
fn a_speed_beyond_its_limit_is_relaxed_and_brought_back() {
    let controller = altitude(Weighting::Terminal { lambda: 1.0 });
    let mut x = Vector2::new(0.0, 4.0);
    let mut previous = Vector2::new(-4.0 * TIME, 4.0);
    let mut state = ControllerState::<_, _, 6>::new(previous, Vector1::zeros(), Vector1::zeros());
    let (mut u, mut relaxed) = (0.0_f64, 0);
    for _ in 0..800 {
        let error = Vector1::new(x.x - 10.0);
        let result = controller.step(
            &mut state,
            &Sample {
                measured: x,
                increment: x - previous,
                error,
                upper: &ALTITUDE_BOUNDS,
                ..Sample::default()
            },
        );
        relaxed += usize::from(result.status == Status::Relaxed);
        let next = result.input.x;
        // Hard limits give way a thousand times less than soft ones.
        assert!((next - u).abs() <= 0.21 && next.abs() <= 1.01, "{u} to {next}");
        (previous, x, u) = (x, advanced(x, next), next);
    }
    assert!(relaxed > 5 && relaxed < 100, "{relaxed} samples were relaxed");
    assert!((x.x - 10.0).abs() < 1e-2, "{}", x.x);
}

/// Position with its two tilts limited jointly, by a polygon of 16 sides inside the circle of 0.3 rad.
fn position<const E: usize>(terms: usize, scale: f64) -> LaguerreMpc<4, 2, 2, E> {
    let model =
        Augmented::new(&double_integrators(&[-GRAVITY, GRAVITY], TIME, Discretization::ZeroOrderHold));
    let design = design(&model, terms, scale, 1000.0, Weighting::Terminal { lambda: 1.0 });
    let limits = [Limit::polygon(Quantity::Input, 16, 0..15), Limit::range(Quantity::Increment, 2, 0..15)];
    LaguerreMpc::new(&design, &limits).unwrap()
}

fn position_bounds() -> Vec<f64> {
    let mut bounds = vec![0.3 * (std::f64::consts::PI / 16.0).cos(); 16];
    bounds.extend([0.1; 4]);
    bounds
}

/// Σ (y − r)ᵀ(y − r) + Δuᵀ R Δu of a step of `goal`, until it has settled.
fn closed_loop_cost<const E: usize>(controller: &LaguerreMpc<4, 2, 2, E>, goal: Vector2<f64>) -> f64 {
    let mut state = ControllerState::<_, _, 11>::new(Vector4::zeros(), Vector2::zeros(), Vector2::zeros());
    let (mut x, mut previous, mut u, mut cost) = (Vector4::zeros(), Vector4::zeros(), Vector2::zeros(), 0.0);
    for sample in 0..600 {
        let error = Vector2::new(x[0], x[2]) - goal;
        let delta: Vector4<f64> = x - previous;
        let result = controller.step(
            &mut state,
            &Sample { measured: x, increment: delta, error, upper: &position_bounds(), ..Sample::default() },
        );
        assert_eq!(result.status, Status::Optimal, "sample {sample}");
        let next = result.input;
        assert!(next.norm() <= 0.3 + 1e-7, "sample {sample}: {} rad", next.norm());
        cost += error.norm_squared() + 1000.0 * (next - u).norm_squared();
        let a = next.component_mul(&Vector2::new(-GRAVITY, GRAVITY));
        previous = x;
        let along = |p: f64, v: f64, a: f64| [p + TIME * v + TIME * TIME / 2.0 * a, v + TIME * a];
        let ([px, vx], [py, vy]) = (along(x[0], x[1], a.x), along(x[2], x[3], a.y));
        (x, u) = (Vector4::new(px, vx, py, vy), next);
    }
    assert!((Vector2::new(x[0], x[2]) - goal).norm() < 1e-3);
    cost
}

/// The claim behind Laguerre MPC: a few coefficients do what one move per sample does. Against 40 free
/// moves per input, five and seven coefficients cost at most 1 % and 0.3 % more on constrained steps.
#[test]
fn few_coefficients_come_close_to_the_full_horizon() {
    let full = position::<81>(40, 0.0);
    let (five, seven) = (position::<11>(5, 0.85), position::<15>(7, 0.8));
    for goal in [Vector2::new(1.0, 0.0), Vector2::new(5.0, 5.0)] {
        let optimum = closed_loop_cost(&full, goal);
        let of_five = closed_loop_cost(&five, goal) / optimum - 1.0;
        let of_seven = closed_loop_cost(&seven, goal) / optimum - 1.0;
        assert!(of_five < 0.01, "{goal}: {of_five}");
        assert!(of_seven < 0.003, "{goal}: {of_seven}");
    }
}

proptest! {
    /// The rows of the limits say what a simulation of the prediction says: with a bound just above, or
    /// just below, the value that the unconstrained optimum reaches, the limit is idle, or active.
    #[test]
    fn limits_bind_where_the_simulated_prediction_reaches_them(
        z in -3.0..3.0, v in -1.0..1.0, dz in -0.1..0.1, dv in -0.1..0.1, u in -0.5..0.5,
        m in 1usize..20, kind in 0usize..3, exponential in any::<bool>(),
    ) {
        let weighting =
            if exponential { Weighting::exponential(1.2, 1.0) } else { Weighting::Terminal { lambda: 1.0 } };
        let model = altitude_model();
        let design = design(&model, 4, 0.7, 1.0, weighting);
        let quantity = [Quantity::Increment, Quantity::Input, Quantity::State][kind];
        let directions = if kind == 2 { dmatrix![0.3, 1.0] } else { dmatrix![1.0] };
        let limit = Limit { quantity, directions, samples: vec![m], soft: false };
        let controller = LaguerreMpc::<2, 1, 1, 5>::new(&design, &[limit]).unwrap();

        // The unconstrained prediction, sample by sample: Δu(k+i) = αⁱ L(i)ᵀ η with η = −Ω⁻¹Ψx.
        let x = nalgebra::DVector::from_column_slice(&[dz, dv, z]);
        let eta = -design.prediction().omega().clone().lu().solve(&(design.prediction().psi() * &x)).unwrap();
        let (mut plant, mut motion, mut input) = (Vector2::new(z, v), Vector2::new(dz, dv), u);
        let mut reached = 0.0;
        for i in 0..=m {
            let increment = design.alpha().powi(i as i32) * design.bases()[0].at(i).dot(&eta);
            input += increment;
            if i == m {
                reached = [increment, input, 0.3 * plant.x + plant.y][kind];
            }
            // Δx_m(k+1) = A_m Δx_m(k) + B_m Δu(k)
            motion = Vector2::new(
                motion.x + TIME * motion.y + TIME * TIME / 2.0 * increment,
                motion.y + TIME * increment,
            );
            plant += motion;
        }

        let run = |bound: f64| {
            let before = Vector2::new(z - dz, v - dv);
            let mut state = ControllerState::<_, _, 6>::new(before, Vector1::new(u), Vector1::zeros());
            let (measured, delta) = (Vector2::new(z, v), Vector2::new(dz, dv));
            let (error, upper) = (Vector1::new(z), &[bound]);
            let sample = Sample { measured, increment: delta, error, upper, ..Sample::default() };
            controller.step(&mut state, &sample)
        };
        let margin = 1e-6 * (1.0 + reached.abs());
        prop_assert_eq!(run(reached + margin).active, 0);
        prop_assert_eq!(run(reached - margin).active, 1);
    }

    /// No measurement and no bound, however absurd, makes the step panic or the input lose its number.
    #[test]
    fn absurd_samples_are_survived(
        values in prop::collection::vec(
            prop_oneof![any::<f64>(), Just(f64::NAN), Just(f64::INFINITY), Just(1e300), -1.0..1.0], 12),
    ) {
        let controller = altitude(Weighting::Terminal { lambda: 1.0 });
        let mut state = at_rest();
        for _ in 0..3 {
            let measured = Vector2::new(values[0], values[1]);
            let delta = Vector2::new(values[2], values[3]);
            let sample = Sample {
                measured,
                increment: delta,
                error: Vector1::new(values[4]),
                input_reference: Vector1::new(values[5]),
                upper: &values[6..12],
                ..Sample::default()
            };
            let result = controller.step(&mut state, &sample);
            prop_assert!(result.input.x.is_finite());
            prop_assert!(state.applied().x.is_finite());
        }
    }
}

#[test]
fn a_step_does_not_allocate() {
    let controller = position::<11>(5, 0.8);
    let mut state = ControllerState::<_, _, 11>::new(Vector4::zeros(), Vector2::zeros(), Vector2::zeros());
    let bounds = position_bounds();
    let allocations = allocation_counter::measure(|| {
        let error = Vector2::new(-5.0, -5.0);
        for _ in 0..10 {
            let result = controller.step(&mut state, &Sample { error, upper: &bounds, ..Sample::default() });
            assert!(result.status == Status::Optimal && result.active > 0);
        }
    });
    assert_eq!(allocations.count_total, 0);
}

/// A free optimum that exceeds its bound by rounding alone, a billionth of it, needs no solver, whatever the unit.
#[test]
fn rounding_does_not_call_the_solver() {
    let limits = [Limit::range(Quantity::Input, 1, 0..1)];
    let design = design(&altitude_model(), 4, 0.7, 1.0, Weighting::Terminal { lambda: 1.0 });
    let controller = LaguerreMpc::<2, 1, 1, 5>::new(&design, &limits).unwrap();
    let active_at = |input: f64, cut: f64| {
        let mut state =
            ControllerState::<2, 1, 5>::new(Vector2::zeros(), Vector1::new(input), Vector1::zeros());
        // At rest on the goal the free optimum keeps its input.
        controller.step(&mut state, &Sample { upper: &[input - cut, f64::MAX], ..Sample::default() }).active
    };
    for input in [1e-18, -1e-3, 1e6, -1e6] {
        let rounding = 1e-9 * f64::abs(input);
        assert_eq!((active_at(input, 0.5 * rounding), active_at(input, 2.0 * rounding)), (0, 1), "{input}");
    }
}

/// Bounds that a sample does not give do not bound.
#[test]
fn a_missing_bound_is_none() {
    let far = Sample { error: Vector1::new(-1000.0), ..Sample::default() };
    let controller = altitude(Weighting::Terminal { lambda: 1.0 });
    let free = controller.unconstrained().step(&mut ControllerState::<2, 1>::at_rest(), &far).input;
    assert!(free.x > 10.0);
    assert_eq!(controller.step(&mut at_rest(), &far).input, free);
    let first_alone = controller.step(&mut at_rest(), &Sample { upper: &[0.2], ..far });
    assert!((first_alone.input.x - 0.2).abs() < 1e-9, "{first_alone:?}");
}

/// The input and its move are those of the whole vehicle: feed-forward and feedback together.
#[test]
fn feed_forward_counts_towards_the_limits() {
    let controller = altitude(Weighting::Terminal { lambda: 1.0 });
    let far = Sample {
        error: Vector1::new(-1000.0),
        input_reference: Vector1::new(0.15),
        upper: &[0.2, 0.2, 1.0, 1.0, 1e3, 1e3],
        ..Sample::default()
    };
    let mut state = at_rest();
    let step = controller.step(&mut state, &far);
    assert!((step.input.x - 0.2).abs() < 1e-8, "{step:?}");
    for _ in 0..10 {
        controller.step(&mut state, &far);
    }
    assert!((state.applied().x - 1.0).abs() < 1e-8, "{}", state.applied().x);
}

#[test]
fn wrong_limits_are_refused() {
    let design = design(&altitude_model(), 5, 0.8, 1.0, Weighting::Terminal { lambda: 1.0 });
    let wrong = Limit::range(Quantity::Input, 2, 0..5);
    let refused = LaguerreMpc::<2, 1, 1, 6>::new(&design, &[wrong]).unwrap_err();
    assert!(matches!(refused, DesignError::Dimension { name: "directions of a limit", .. }), "{refused}");
    let small = LaguerreMpc::<2, 1, 1, 5>::new(&design, &[]).unwrap_err();
    assert!(matches!(small, DesignError::Dimension { name: "H with slack", .. }), "{small}");
}

/// The polygon lies inside the circle that its bound describes and touches it with its corners.
#[test]
fn the_polygon_is_inscribed() {
    let polygon = Limit::polygon(Quantity::Input, 16, 0..1);
    let directions: SMatrix<f64, 16, 2> = SMatrix::from_fn(|i, j| polygon.directions[(i, j)]);
    let bound = (std::f64::consts::PI / 16.0).cos();
    for step in 0..1000 {
        let angle = std::f64::consts::TAU * f64::from(step) / 1000.0;
        let reach = bound / (directions * SVector::<f64, 2>::new(angle.cos(), angle.sin())).max();
        assert!((0.98..=1.0 + 1e-12).contains(&reach), "{reach}");
    }
}
