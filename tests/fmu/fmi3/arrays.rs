//! Arrays are read and set as a whole, among other variables.

use super::{closed_loop, oscillator};
use crate::common::fmi3::instance::Instance;
use crate::common::fmi3::library::{ERROR, OK};

#[test]
fn elements_follow_one_another_in_the_values_of_a_call() {
    let mut instance = Instance::new(closed_loop());
    let names = ["initial.velocity", "airframe.mass", "initial.position"];
    assert_eq!(instance.set(&names, &[1.0, -2.0, 0.5, 0.9, 4.0, 5.0, -6.0]), OK);
    instance.initialize();
    assert_eq!(instance.values(&["position", "velocity"]), [4.0, 5.0, -6.0, 1.0, -2.0, 0.5]);
    assert_eq!(instance.values(&["airframe.mass", "initial.position"]), [0.9, 4.0, 5.0, -6.0]);
    // Twice the same, and time between them.
    let values = instance.values(&["position", "time", "position"]);
    assert_eq!(values, [4.0, 5.0, -6.0, 0.0, 4.0, 5.0, -6.0]);
    assert_eq!(instance.set(&["reference.position"], &[1.0, 2.0, -3.0]), OK);
    assert_eq!(instance.values(&["reference.position"]), [1.0, 2.0, -3.0]);
    // Nothing is nothing.
    assert_eq!(instance.try_values(&[], 0), Ok(vec![]));
    assert_eq!(instance.set(&[], &[]), OK);
}

#[test]
fn a_wrong_number_of_values_is_refused() {
    let mut instance = Instance::initialized(closed_loop(), &[]);
    let reference = instance.subject.description.reference("position");
    for (count, text) in [(2, "nValues = 2; must be 3"), (4, "nValues = 4; must be 3"), (0, "nValues = 0")] {
        assert_eq!(instance.try_values(&[reference], count), Err(ERROR));
        instance.is_refused(ERROR, text);
    }
    let status = instance.set(&["reference.position"], &[1.0]);
    instance.is_refused(status, "nValues = 1; must be 3");
    assert_eq!(instance.values(&["reference.position"]), [5.0, 5.0, -10.0]);
}

#[test]
fn an_element_has_no_reference_of_its_own() {
    let mut instance = Instance::initialized(closed_loop(), &[]);
    let first = instance.subject.description.reference("position");
    assert_eq!(instance.try_values(&[first + 1], 1), Err(ERROR));
    let text = format!(
        "value reference {} is an element of the array position, which is read and set as a whole: use value reference {first}",
        first + 1
    );
    instance.is_refused(ERROR, &text);
    let behind = instance.subject.description.reference("time") + 1;
    assert_eq!(instance.try_values(&[behind], 1), Err(ERROR));
    instance.is_refused(ERROR, "unknown value reference");
}

/// An element out of its range leaves the others as they are.
#[test]
fn all_elements_are_set_or_none() {
    let mut instance = Instance::initialized(oscillator(), &[("initial", &[0.25, 0.5])]);
    assert_eq!(instance.set(&["u"], &[1.0, 2.0]), OK);
    let status = instance.set(&["u"], &[3.0, 11.0]);
    instance.is_refused(status, "u[2] = 11; allowed -10 to 10");
    let status = instance.set(&["u", "x"], &[3.0, 4.0, 5.0, 6.0]);
    instance.is_refused(status, "x[1] cannot be set");
    assert_eq!(instance.values(&["u", "x"]), [1.0, 2.0, 0.25, 0.5]);
}

#[test]
fn output_derivatives_of_an_array() {
    let mut instance = Instance::initialized(oscillator(), &[]);
    instance.fly(0.0, 0.1, 3);
    let [x, y] = instance.values(&["x"])[..] else { panic!("two states") };
    let rates = instance.values(&["der(x)"]);
    assert_eq!(rates, [-2.0 * y, 2.0 * x]);
    assert_eq!(instance.output_derivatives(&["x"], &[1], 2), Ok(rates.clone()));
    let both = instance.output_derivatives(&["der(x)", "x"], &[1, 1], 4);
    assert_eq!(both, Ok(vec![-2.0 * rates[1], 2.0 * rates[0], rates[0], rates[1]]));
    assert_eq!(instance.output_derivatives(&["x"], &[1], 3), Err(ERROR));
    instance.is_refused(ERROR, "nValues = 3; must be 2");
    assert_eq!(instance.output_derivatives(&["x"], &[2], 2), Err(ERROR));
    instance.is_refused(ERROR, "order 2");
}

/// A = (0 −ω; ω 0), B = 1: directional derivatives are columns, adjoint ones rows.
#[test]
fn directional_and_adjoint_derivatives_are_those_of_the_matrices() {
    let mut instance = Instance::initialized(oscillator(), &[]);
    let directional = |instance: &mut Instance, knowns: &[&str], seed: &[f64]| {
        instance.directional(&["der(x)", "x"], knowns, seed, 4).expect("they exist")
    };
    assert_eq!(directional(&mut instance, &["x"], &[1.0, 0.0]), [0.0, 2.0, 1.0, 0.0]);
    assert_eq!(directional(&mut instance, &["x"], &[0.0, 1.0]), [-2.0, 0.0, 0.0, 1.0]);
    assert_eq!(directional(&mut instance, &["u", "x"], &[1.0, 2.0, 3.0, 4.0]), [-7.0, 8.0, 3.0, 4.0]);
    let adjoint = |instance: &mut Instance, knowns: &[&str], seed: &[f64]| {
        instance.adjoint(&["der(x)", "x"], knowns, seed, 2).expect("they exist")
    };
    assert_eq!(adjoint(&mut instance, &["x"], &[1.0, 0.0, 0.0, 0.0]), [0.0, -2.0]);
    assert_eq!(adjoint(&mut instance, &["u"], &[3.0, 5.0, 7.0, 9.0]), [3.0, 5.0]);
    assert_eq!(adjoint(&mut instance, &["x"], &[3.0, 5.0, 7.0, 9.0]), [17.0, 3.0]);
    for (unknown, known, text) in [
        ("u", "u", "u[1] has no derivatives"),
        ("time", "u", "time has no derivatives"),
        ("event_indicator", "u", "event_indicator has no derivatives"),
        ("x", "time", "with respect to time"),
        ("x", "initial", "with respect to initial[1]"),
    ] {
        let description = &instance.subject.description;
        let [unknowns, knowns] = [unknown, known].map(|name| description.variable(name).length());
        assert_eq!(instance.directional(&[unknown], &[known], &vec![1.0; knowns], unknowns), Err(ERROR));
        instance.is_refused(ERROR, text);
        assert_eq!(instance.adjoint(&[unknown], &[known], &vec![1.0; unknowns], knowns), Err(ERROR));
        instance.is_refused(ERROR, text);
    }
    assert_eq!(instance.directional(&["x"], &["u"], &[1.0], 2), Err(ERROR));
    instance.is_refused(ERROR, "nSeed = 1; must be 2");
    assert_eq!(instance.directional(&["x"], &["u"], &[1.0, 1.0], 1), Err(ERROR));
    instance.is_refused(ERROR, "nSensitivity = 1; must be 2");
    assert_eq!(instance.adjoint(&["x"], &["u"], &[1.0, f64::NAN], 2), Err(ERROR));
    instance.is_refused(ERROR, "x[2] is NaN");
}

#[test]
fn a_model_without_equations_has_no_derivatives() {
    let mut instance = Instance::initialized(closed_loop(), &[]);
    assert_eq!(instance.directional(&["position"], &["wind.velocity"], &[1.0; 3], 3), Err(ERROR));
    instance.is_refused(ERROR, "providesDirectionalDerivative = false");
    assert_eq!(instance.adjoint(&["position"], &["wind.velocity"], &[1.0; 3], 3), Err(ERROR));
    instance.is_refused(ERROR, "providesDirectionalDerivative = false");
    assert_eq!(instance.output_derivatives(&["position"], &[1], 3), Err(ERROR));
    instance.is_refused(ERROR, "maxOutputDerivativeOrder = 0");
}
