//! Discretisation and augmentation.

use lmpc::{
    Augmented, Controller, ControllerState, DesignError, Discretization, LaguerreBasis, LmpcDesign, Sample,
    StateFeedback, StateSpace, Weighting, Weights,
};
use nalgebra::{DMatrix, Vector1, Vector2, dmatrix};

use crate::common::double_integrators;

#[test]
fn forward_euler_gives_the_papers_altitude_model() {
    // (9)
    let plant = double_integrators(&[1.0], 0.05, Discretization::ForwardEuler);
    assert_eq!(*plant.a(), dmatrix![1.0, 0.05; 0.0, 1.0]);
    assert_eq!(*plant.b(), dmatrix![0.0; 0.05]);
    assert_eq!(*plant.c(), dmatrix![1.0, 0.0]);
}

#[test]
fn zero_order_hold_of_a_double_integrator_is_exact() {
    let t = 0.3;
    let plant = double_integrators(&[2.0], t, Discretization::ZeroOrderHold);
    assert!((plant.a() - dmatrix![1.0, t; 0.0, 1.0]).amax() < 1e-15);
    assert!((plant.b() - dmatrix![2.0 * t * t / 2.0; 2.0 * t]).amax() < 1e-15);
}

#[test]
fn zero_order_hold_of_an_oscillator_is_exact() {
    // ẍ = −w² x + w² u: x = cos, sin; the step response is 1 − cos wt.
    let (w, t): (f64, f64) = (7.0, 0.4);
    let plant = StateSpace::from_continuous(
        &dmatrix![0.0, 1.0; -w * w, 0.0],
        &dmatrix![0.0; w * w],
        &dmatrix![1.0, 0.0],
        t,
        Discretization::ZeroOrderHold,
    )
    .unwrap();
    let (s, c) = (w * t).sin_cos();
    assert!((plant.a() - dmatrix![c, s / w; -w * s, c]).amax() < 1e-12);
    assert!((plant.b() - dmatrix![1.0 - c; w * s]).amax() < 1e-12);
}

#[test]
fn augmentation_of_the_double_integrator() {
    // Wang 2009, section 1.2: A = [A_m 0; C_m A_m 1] and B = [B_m; C_m B_m], by hand.
    let plant =
        StateSpace::new(dmatrix![1.0, 1.0; 0.0, 1.0], dmatrix![0.5; 1.0], dmatrix![1.0, 0.0]).unwrap();
    let model = Augmented::new(&plant);
    assert_eq!(*model.a(), dmatrix![1.0, 1.0, 0.0; 0.0, 1.0, 0.0; 1.0, 1.0, 1.0]);
    assert_eq!(*model.b(), dmatrix![0.5; 1.0; 0.5]);
    assert_eq!(*model.c(), dmatrix![0.0, 0.0, 1.0]);
}

#[test]
fn wrong_models_are_refused_by_name() {
    let a = dmatrix![1.0, 1.0; 0.0, 1.0];
    let (b, c) = (dmatrix![0.5; 1.0], dmatrix![1.0, 0.0]);
    let refused = |a: &DMatrix<f64>, b: &DMatrix<f64>, c: &DMatrix<f64>| {
        StateSpace::new(a.clone(), b.clone(), c.clone()).unwrap_err()
    };
    assert_eq!(
        refused(&a, &dmatrix![1.0], &c),
        DesignError::Dimension { name: "B", expected: (2, 1), actual: (1, 1) }
    );
    assert_eq!(
        refused(&a, &b, &dmatrix![1.0]),
        DesignError::Dimension { name: "C", expected: (1, 2), actual: (1, 1) }
    );
    assert_eq!(
        refused(&dmatrix![1.0, 1.0], &b, &c),
        DesignError::Dimension { name: "A", expected: (1, 1), actual: (1, 2) }
    );
    let told = refused(&(&a * f64::NAN), &b, &c);
    assert!(matches!(told, DesignError::ElementNotFinite { name: "A", row: 0, column: 0, .. }), "{told}");
    for time in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = StateSpace::from_continuous(&a, &b, &c, time, Discretization::ForwardEuler).unwrap_err();
        assert!(matches!(error, DesignError::SampleTime { .. }), "{error}");
    }
}

/// (24) with D, measured before the input changes: y(k) = C x(k) + D u(k−1), simulated.
#[test]
fn a_direct_term_shows_the_input_before() {
    let (a, b) = (dmatrix![0.9, 0.4; -0.2, 0.7], dmatrix![1.0, 0.5; -0.3, 2.0]);
    let (c, d) = (dmatrix![1.0, -1.0], dmatrix![3.0, 0.5]);
    let plant = StateSpace::with_direct_term(&a, &b, &c, &d).unwrap();
    let (mut x, mut before) = (dmatrix![0.3; -0.8], dmatrix![0.0; 0.0]);
    let mut state = dmatrix![0.3; -0.8; 0.0; 0.0];
    for k in 0..20 {
        let expected = &c * &x + &d * &before;
        assert!((plant.c() * &state - expected).amax() < 1e-14, "sample {k}");
        before = dmatrix![f64::from(k).sin(); f64::from(k * k).cos()];
        x = &a * x + &b * &before;
        state = plant.a() * state + plant.b() * &before;
    }
    let wrong = StateSpace::with_direct_term(&a, &b, &c, &dmatrix![3.0]).unwrap_err();
    assert_eq!(wrong, DesignError::Dimension { name: "D", expected: (1, 2), actual: (1, 1) });
}

/// Laguerre MPC brings an output with a direct term to its set-point: the prediction knows it.
#[test]
fn a_direct_term_is_predicted() {
    let (a, b, c, d) = (dmatrix![0.8], dmatrix![0.5], dmatrix![1.0], dmatrix![4.0]);
    let plant = StateSpace::with_direct_term(&a, &b, &c, &d).unwrap();
    let model = Augmented::new(&plant);
    let weights = Weights::output(&model, 1.0, 0.1).unwrap();
    let bases = [LaguerreBasis::new(6, 0.5).unwrap()];
    let design = LmpcDesign::new(&model, &weights, &bases, 60, Weighting::Terminal { lambda: 1.0 }).unwrap();
    let law = StateFeedback::<2, 1, 1>::from_design(&design).unwrap();
    let mut controller = ControllerState::<2, 1>::at_rest();
    let (set_point, mut x, mut u) = (Vector1::new(3.0), 0.0, 0.0);
    for _ in 0..100 {
        let measured = Vector2::new(x, u);
        let sample = Sample {
            measured,
            increment: measured - controller.measured(),
            error: Vector1::new(x + 4.0 * u) - set_point,
            ..Sample::default()
        };
        u = law.step(&mut controller, &sample).input.x;
        x = 0.8 * x + 0.5 * u;
    }
    assert!((x + 4.0 * u - set_point.x).abs() < 1e-9, "{}", x + 4.0 * u);
}
