//! A double integrator under a limit of its speed, by Laguerre MPC about a stabilizing feedback.

use lmpc::{
    Augmented, Controller, ControllerState, DesignError, Discretization, Dlqr, LaguerreBasis, Sample,
    SignalLimit, StabilizedDesign, StabilizedMpc, StateSpace, Weights, unknowns,
};
use nalgebra::{Vector1, Vector2, dmatrix};

fn main() -> Result<(), DesignError> {
    let (a, b, c) = (dmatrix![0.0, 1.0; 0.0, 0.0], dmatrix![0.0; 1.0], dmatrix![1.0, 0.0]);
    let plant = StateSpace::from_continuous(&a, &b, &c, 0.05, Discretization::ZeroOrderHold)?;
    let model = Augmented::new(&plant);
    // Plans are made about a slower regulator.
    let slow = Weights::output(&model, 1.0, 1e4)?;
    let stabilizing = Dlqr::new(model.a(), model.b(), slow.q(), slow.r(), 1.0)?;
    let basis = LaguerreBasis::new(5, 0.8)?;
    let weights = Weights::output(&model, 1.0, 10.0)?;
    let design = StabilizedDesign::new(&model, &weights, stabilizing.gain(), &[basis], 1.0)?;

    // |ẏ| ≤ 1 at samples 1 to 60.
    let speed =
        SignalLimit::of_states(2, 1, &[1], SignalLimit::range(1), (1..=60).collect()).giving_way_by(1.0);
    const UNKNOWNS: usize = unknowns(1, 5);
    let controller = StabilizedMpc::<2, 1, 1, UNKNOWNS>::new(&design, &[speed], 1e6)?;
    let mut state = ControllerState::<2, 1, UNKNOWNS>::at_rest();

    let moved = |x: &Vector2<f64>, input: f64| {
        let next = plant.a() * x + plant.b() * input;
        Vector2::new(next[0], next[1])
    };
    let (mut x, mut last) = (Vector2::zeros(), Vector2::zeros());
    let mut fastest = 0.0_f64;
    for _ in 0..400 {
        let sample = Sample {
            measured: x,
            increment: x - last,
            error: Vector1::new(x[0] - 5.0),
            upper: &[1.0, 1.0],
            ..Sample::default()
        };
        let step = controller.step(&mut state, &sample);
        last = x;
        x = moved(&x, step.input.x);
        fastest = fastest.max(x[1]);
    }
    println!("at {:.3} m, fastest {fastest:.3} m/s", x[0]);
    Ok(())
}
