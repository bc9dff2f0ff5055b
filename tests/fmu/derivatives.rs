//! Directional derivatives and time derivatives of outputs.
//!
//! Of the lag, τ ẏ = k u − y, they are known: ∂ẏ/∂u = k/τ, ∂ẏ/∂y = −1/τ.

use crate::common::instance::Instance;
use crate::common::library::{ERROR, OK};
use crate::{closed_loop, lag};

/// The lag of gain 3 and time constant 0.25 s, stepped for 0.1 s.
fn stepped() -> Instance<'static> {
    let mut instance = Instance::initialized(lag(), &[("gain", 3.0), ("time_constant", 0.25)], &[]);
    assert_eq!(instance.do_step(0.0, 0.1), OK);
    instance
}

#[test]
fn they_are_those_of_the_equations() {
    let mut instance = stepped();
    let along = |instance: &mut Instance, direction: &[(&str, f64)]| {
        instance.directional_derivative(&["y", "der(y)"], direction).expect("they exist")
    };
    assert_eq!(along(&mut instance, &[("u", 1.0)]), [0.0, 12.0]);
    assert_eq!(along(&mut instance, &[("y", 1.0)]), [1.0, -4.0]);
    assert_eq!(along(&mut instance, &[("u", 0.5), ("y", -2.0)]), [-2.0, 14.0]);
    // Sums, if a variable is named twice.
    assert_eq!(along(&mut instance, &[("u", 1.0), ("u", 1.0)]), [0.0, 24.0]);
    assert_eq!(along(&mut instance, &[]), [0.0, 0.0]);
    // Nothing has moved.
    assert_eq!(instance.do_step(0.1, 0.1), OK);
}

#[test]
fn what_cannot_be_differentiated_is_named() {
    let mut instance = stepped();
    for (unknown, known, named) in [
        ("y", "gain", "gain"),
        ("y", "hold", "hold"),
        ("y", "der(y)", "der(y)"),
        ("samples", "u", "samples"),
        ("u", "u", "u has no derivatives"),
        ("corner", "u", "corner"),
    ] {
        assert_eq!(instance.directional_derivative(&[unknown], &[(known, 1.0)]), Err(ERROR));
        let text = instance.log.last().text;
        assert!(text.contains(named), "{text}");
    }
    assert_eq!(instance.directional_derivative(&["y"], &[("u", f64::NAN)]), Err(ERROR));
    assert!(instance.log.last().text.contains("u is NaN"));
}

#[test]
fn outputs_have_time_derivatives() {
    let mut instance = stepped();
    let [y, rate] = instance.reals(["y", "der(y)"]);
    // y goes from 0 to k u = 3.
    assert!((y - 3.0 * (1.0 - (-0.4_f64).exp())).abs() < 1e-12 && (rate - (3.0 - y) / 0.25).abs() < 1e-12);
    assert_eq!(instance.output_derivatives(&["y", "der(y)"], 1), Ok(vec![rate, -4.0 * rate]));
    assert_eq!(instance.output_derivatives(&[], 1), Ok(vec![]));
    for (name, order, named) in
        [("y", 2, "order 2"), ("y", 0, "order 0"), ("u", 1, "u has no"), ("samples", 1, "samples")]
    {
        assert_eq!(instance.output_derivatives(&[name], order), Err(ERROR));
        let text = instance.log.last().text;
        assert!(text.contains(named), "{text}");
    }
}

#[test]
fn a_model_without_equations_says_so() {
    let mut instance = Instance::initialized(closed_loop(), &[], &[]);
    let answer = instance.directional_derivative(&["position.x"], &[("wind.velocity.x", 1.0)]);
    assert_eq!(answer, Err(ERROR));
    assert!(instance.log.last().text.contains("providesDirectionalDerivative = false"));
}
