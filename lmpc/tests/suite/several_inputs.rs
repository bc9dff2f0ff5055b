//! Plants whose numbers of states, inputs and outputs all differ, against predictions that are simulated sample by
//! sample: nothing that mixes up rows, columns or inputs stands here.

use lmpc::{
    Augmented, Controller, ControllerState, LaguerreBasis, LaguerreMpc, Limit, LmpcDesign, Quantity, Sample,
    StateSpace, StateSpaceMpc, StateSpaceMpcDesign, StateSpaceMpcWeights, Status, Step, Weighting, Weights,
    unknowns,
};
use nalgebra::{DMatrix, DVector, SVector, Vector2, Vector3, Vector4, dmatrix, vector};
use proptest::prelude::*;

/// Four states, two inputs, three outputs; stable.
fn three_outputs() -> StateSpace {
    let a = dmatrix![
        0.7, 0.2, 0.0, -0.1;
        -0.3, 0.6, 0.1, 0.0;
        0.1, 0.0, 0.8, 0.25;
        0.0, 0.15, -0.2, 0.5
    ];
    let b = dmatrix![0.5, -0.1; 0.0, 0.7; 0.3, 0.2; -0.4, 1.1];
    let c = dmatrix![1.0, 0.3, 0.0, 0.0; 0.0, 1.0, -0.6, 0.0; 0.2, 0.0, 0.0, 1.0];
    StateSpace::new(a, b, c).unwrap()
}

/// The same with its first output alone.
fn one_output() -> StateSpace {
    let plant = three_outputs();
    StateSpace::new(plant.a().clone(), plant.b().clone(), plant.c().rows(0, 1).into_owned()).unwrap()
}

fn dynamic<const R: usize>(vector: &SVector<f64, R>) -> DVector<f64> {
    DVector::from_column_slice(vector.as_slice())
}

fn quadratic(vector: &DVector<f64>, weight: &DMatrix<f64>) -> f64 {
    (vector.transpose() * weight * vector)[0]
}

/// The minimum of a quadratic function of `size` unknowns: Newton's step with differences, which is exact.
fn minimum(size: usize, cost: impl Fn(&DVector<f64>) -> f64) -> DVector<f64> {
    let unit = |i: usize| DVector::from_fn(size, |k, _| f64::from(k == i));
    let zero = cost(&DVector::zeros(size));
    let gradient = DVector::from_fn(size, |i, _| (cost(&unit(i)) - cost(&-unit(i))) / 2.0);
    let hessian = DMatrix::from_fn(size, size, |i, j| {
        cost(&(unit(i) + unit(j))) - cost(&unit(i)) - cost(&unit(j)) + zero
    });
    -hessian.lu().solve(&gradient).unwrap()
}

const HORIZON: usize = 7;
const MOVES: usize = 3;
/// More room than is needed.
type Moves = StateSpaceMpc<4, 2, 3, { unknowns(2, MOVES) + 2 }>;

fn weights(with_terminal: bool) -> StateSpaceMpcWeights {
    let root = DMatrix::from_fn(7, 7, |i, j| ((3 * i + 5 * j) as f64).sin());
    StateSpaceMpcWeights {
        output: dmatrix![3.0, 0.5, 0.0; 0.5, 2.0, 0.1; 0.0, 0.1, 1.0],
        moves: dmatrix![0.8, 0.2; 0.2, 0.5],
        increment: DMatrix::from_diagonal(&DVector::from_column_slice(&[0.4, 0.1, 0.9, 0.2])),
        terminal: with_terminal.then(|| root.transpose() * root),
    }
}

fn moves_design(with_terminal: bool) -> StateSpaceMpcDesign {
    StateSpaceMpcDesign::with_weights(&three_outputs(), &weights(with_terminal), HORIZON, MOVES).unwrap()
}

/// One sample of an input that stood at `feedback` on top of `input_reference`.
fn step_from(
    law: &dyn Controller<4, 2, 3, 9>,
    feedback: Vector2<f64>,
    earlier_reference: Vector2<f64>,
    sample: &Sample<'_, 4, 2, 3>,
) -> Step<2> {
    let mut state =
        ControllerState::<4, 2, 9>::new(Vector4::zeros(), feedback + earlier_reference, earlier_reference);
    law.step(&mut state, sample)
}

fn vector4() -> impl Strategy<Value = Vector4<f64>> {
    prop::array::uniform4(-2.0..2.0).prop_map(Vector4::from)
}

fn vector2() -> impl Strategy<Value = Vector2<f64>> {
    prop::array::uniform2(-2.0..2.0).prop_map(Vector2::from)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// The first move of the state-space MPC minimises (34) with all further weights.
    #[test]
    fn the_first_moves_minimise_the_simulated_cost(
        x in vector4(), v in vector2(), d in vector2(), u_r in vector2(),
        r in prop::collection::vec(prop::array::uniform3(-2.0..2.0), 1..=HORIZON + 2), with_terminal in any::<bool>(),
    ) {
        let design = moves_design(with_terminal);
        let law = Moves::new(&design, &[]).unwrap();
        let references: Vec<Vector3<f64>> = r.iter().map(|&value| Vector3::from(value)).collect();
        let sample = Sample {
            measured: x, deviation: x, disturbance: d, input_reference: u_r, preview: &references, ..Sample::default()
        };
        let best = plan(&sample, &v, with_terminal);
        let step = step_from(&law, v, vector![0.3, -0.2], &sample);
        prop_assert_eq!((step.status, step.active), (Status::Optimal, 0));
        let expected = u_r + v + vector![best[0], best[1]];
        prop_assert!((step.input - expected).norm() < 1e-8 * (1.0 + best.norm()), "{} and {expected}", step.input);

        // Δu = −K_x x − K_u u₋₁ for a reference of zero.
        let (state_gain, input_gain) = design.gains().unwrap();
        let law_at_zero = step_from(&law, v, Vector2::zeros(), &Sample { measured: x, deviation: x, ..Sample::default() });
        let by_gains = -(state_gain * dynamic(&x) + input_gain * dynamic(&v));
        prop_assert!((dynamic(&law_at_zero.increment) - by_gains).norm() < 1e-9);
    }

    /// A limit of the state-space MPC is idle with a bound just above what the free optimum reaches, and active
    /// just below.
    #[test]
    fn limits_of_the_state_space_mpc_bind_where_its_prediction_reaches_them(
        x in vector4(), v in vector2(), d in vector2(), u_r in vector2(), earlier in vector2(),
        m in 0usize..HORIZON, kind in 0usize..3, before in any::<bool>(),
    ) {
        let plant = three_outputs();
        let design = moves_design(true);
        let m = if kind == 2 { m + 1 } else { m };
        // Beyond the last move there is no increment to bound.
        prop_assume!(kind > 0 || m < MOVES);
        let sample = Sample {
            measured: x, deviation: x, disturbance: d, input_reference: u_r, ..Sample::default()
        };
        let moves = plan(&sample, &v, true);
        let (mut state, mut feedback, mut reached) = (dynamic(&x), dynamic(&v), f64::NAN);
        let (of_input, of_state) = (dmatrix![0.6, -1.3], dmatrix![0.2, -1.0, 0.4, 0.7]);
        for i in 0..=m {
            let mut next_move = DVector::zeros(2);
            if i < MOVES {
                next_move.copy_from(&moves.rows(2 * i, 2));
            }
            feedback += &next_move;
            if i == 0 {
                // The first increment has the step of the feed-forward.
                next_move += dynamic(&(u_r - earlier));
            }
            if i == m {
                reached = match kind {
                    0 => (&of_input * next_move)[0],
                    1 => (&of_input * (&feedback + dynamic(&u_r)))[0],
                    _ => (&of_state * &state)[0],
                };
            }
            state = plant.a() * &state + plant.b() * (&feedback + dynamic(&d));
        }
        let (quantity, directions) =
            [(Quantity::Increment, &of_input), (Quantity::Input, &of_input), (Quantity::State, &of_state)][kind];
        let limit = Limit { quantity, directions: directions.clone(), samples: vec![m], soft: false };
        // Another limit before it, which never binds, has bounds of its own.
        let far = Limit::range(Quantity::Input, 2, [0, 2]);
        let run = |bound: f64| {
            let (limits, upper) = if before {
                (vec![far.clone(), limit.clone()], vec![1e3, 1e3, 1e3, 1e3, bound])
            } else {
                (vec![limit.clone()], vec![bound])
            };
            let law = Moves::new(&design, &limits).unwrap();
            step_from(&law, v, earlier, &Sample { upper: &upper, ..sample }).active
        };
        let margin = 1e-6 * (1.0 + reached.abs());
        prop_assert_eq!(run(reached + margin), 0);
        prop_assert_eq!(run(reached - margin), 1);
    }

    /// The same for the Laguerre MPC, with a basis per input.
    #[test]
    fn limits_of_the_laguerre_mpc_bind_where_its_prediction_reaches_them(
        x in vector4(), dx in vector4(), v in vector2(), u_r in vector2(), earlier in vector2(), y in -2.0..2.0,
        m in 0usize..9, kind in 0usize..3, exponential in any::<bool>(), before in any::<bool>(),
    ) {
        let m = if kind == 2 { m + 1 } else { m };
        let (plant, design) = (one_output(), laguerre_design(exponential));
        let stacked = DVector::from_iterator(5, dx.iter().copied().chain([y]));
        let eta = -design.prediction().omega().clone().lu().solve(&(design.prediction().psi() * stacked)).unwrap();
        let (mut state, mut motion, mut input) = (dynamic(&x), dynamic(&dx), dynamic(&(u_r + v)));
        let (of_input, of_state) = (dmatrix![0.6, -1.3], dmatrix![0.2, -1.0, 0.4, 0.7]);
        let mut reached = f64::NAN;
        for i in 0..=m {
            let growth = design.alpha().powi(i as i32);
            let mut increment = growth * DVector::from_column_slice(&[
                design.bases()[0].at(i).dot(&eta.rows(0, 2)),
                design.bases()[1].at(i).dot(&eta.rows(2, 3)),
            ]);
            input += &increment;
            motion = plant.a() * motion + plant.b() * &increment;
            if i == 0 {
                increment += dynamic(&(u_r - earlier));
            }
            if i == m {
                reached = match kind {
                    0 => (&of_input * increment)[0],
                    1 => (&of_input * &input)[0],
                    _ => (&of_state * &state)[0],
                };
            }
            state += &motion;
        }
        let (quantity, directions) =
            [(Quantity::Increment, &of_input), (Quantity::Input, &of_input), (Quantity::State, &of_state)][kind];
        let limit = Limit { quantity, directions: directions.clone(), samples: vec![m], soft: false };
        let far = Limit::range(Quantity::Input, 2, [0, 2]);
        let sample = Sample {
            measured: x, increment: dx, error: vector![y], input_reference: u_r, ..Sample::default()
        };
        let run = |bound: f64| {
            let (limits, upper) = if before {
                (vec![far.clone(), limit.clone()], vec![1e3, 1e3, 1e3, 1e3, bound])
            } else {
                (vec![limit.clone()], vec![bound])
            };
            let law = Laguerre::new(&design, &limits).unwrap();
            let mut state = ControllerState::<4, 2, 6>::new(Vector4::zeros(), v + earlier, earlier);
            law.step(&mut state, &Sample { upper: &upper, ..sample }).active
        };
        let margin = 1e-6 * (1.0 + reached.abs());
        prop_assert_eq!(run(reached + margin), 0);
        prop_assert_eq!(run(reached - margin), 1);
    }
}

/// All moves of the state-space MPC from an input whose feedback stood at `v`: the minimum of (34) with all further
/// weights, simulated.
fn plan(sample: &Sample<'_, 4, 2, 3>, v: &Vector2<f64>, with_terminal: bool) -> DVector<f64> {
    let (plant, weights) = (three_outputs(), weights(with_terminal));
    // The last reference lasts, and that at the end of the horizon is the last one within it.
    let reference = |n: usize| {
        let known = sample.preview.get(n.min(HORIZON - 1)).or(sample.preview.last());
        dynamic(&known.copied().unwrap_or_default())
    };
    minimum(2 * MOVES, |moves| {
        let (mut state, mut input, mut cost) =
            (dynamic(&sample.deviation), dynamic(&(v + sample.disturbance)), 0.0);
        for n in 0..HORIZON {
            cost += quadratic(&(plant.c() * &state - reference(n)), &weights.output);
            if n < MOVES {
                let next_move = moves.rows(2 * n, 2).into_owned();
                cost += quadratic(&next_move, &weights.moves);
                input += next_move;
            }
            let next = plant.a() * &state + plant.b() * &input;
            let motion = &next - &state;
            cost += match weights.terminal.as_ref().filter(|_| n + 1 == HORIZON) {
                None => quadratic(&motion, &weights.increment),
                Some(terminal) => {
                    let error = plant.c() * &next - reference(HORIZON);
                    quadratic(
                        &DVector::from_iterator(7, motion.iter().chain(error.iter()).copied()),
                        terminal,
                    )
                }
            };
            state = next;
        }
        cost
    })
}

/// Two terms for the first input, three for the second, one slack, and room to spare.
type Laguerre = LaguerreMpc<4, 2, 1, 7>;

fn laguerre_design(exponential: bool) -> LmpcDesign {
    let model = Augmented::new(&one_output());
    let weights = Weights::new(
        &model,
        DMatrix::from_diagonal(&DVector::from_column_slice(&[0.1, 0.0, 0.3, 0.2, 1.0])),
        dmatrix![2.0, 0.3; 0.3, 1.0],
    )
    .unwrap();
    let bases = [LaguerreBasis::new(2, 0.6).unwrap(), LaguerreBasis::new(3, 0.4).unwrap()];
    let weighting =
        if exponential { Weighting::exponential(1.1, 1.0) } else { Weighting::Terminal { lambda: 1.0 } };
    LmpcDesign::new(&model, &weights, &bases, 40, weighting).unwrap()
}
