//! Parameters: checked against one another, tunable in flight, and what follows from them.

use crate::closed_loop;
use crate::common::instance::Instance;
use crate::common::library::{ERROR, OK};
use crate::common::subject::Subject;

const RADII: [&str; 3] = [
    "controller.altitude.spectral_radius",
    "controller.position.spectral_radius",
    "controller.attitude.spectral_radius",
];

fn contradictions_are_found_when_initialization_ends_and_can_be_mended(subject: &'static Subject) {
    let (name, wrong, right) = subject.sample.contradiction;
    let mut instance = Instance::new(subject);
    assert_eq!(instance.set_real(&[(name, wrong)]), OK, "alone it is in range");
    assert_eq!(instance.enter_initialization_mode(), OK);
    assert_eq!(instance.exit_initialization_mode(), ERROR);
    assert!(instance.log.last().text.contains(name));
    assert_eq!(instance.try_reals(&[subject.description.reference(subject.sample.output)]), Err(ERROR));
    assert!(instance.log.last().text.contains(name));
    assert_eq!(instance.real(name), wrong, "what needs no run can be read");
    assert_eq!(instance.set_real(&[(name, right)]), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    instance.fly(0.0, 0.1, 1);
}

#[test]
fn calculated_parameters_follow_at_once() {
    let mut instance = Instance::new(closed_loop());
    assert_eq!(instance.enter_initialization_mode(), OK);
    let first = instance.reals(RADII);
    assert!(first.iter().all(|radius| (0.5..1.0).contains(radius)), "{first:?}");
    assert_eq!(instance.set_real(&[("controller.altitude.increment_weight", 5.0)]), OK);
    let second = instance.reals(RADII);
    assert!(second[0] > first[0] && second[1..] == first[1..], "{first:?} {second:?}");

    assert_eq!(instance.exit_initialization_mode(), OK);
    instance.fly(0.0, 0.1, 3);
    assert_eq!(instance.set_real(&[("controller.altitude.increment_weight", 1.0)]), OK);
    assert_eq!(instance.reals(RADII), first);
}

/// The paper's Figure 4: on its models, with its N = 5, a = 0.8187 and α = 1.2 the eigenvalues are those of DLQR, and Ω is well
/// conditioned.
#[test]
fn designs_are_those_of_the_regulator() {
    const CONTROLLERS: [&str; 3] = ["altitude", "position", "attitude"];
    let mut instance = Instance::new(closed_loop());
    for controller in CONTROLLERS {
        let set = |name: &str| format!("controller.{controller}.{name}");
        assert_eq!(instance.set_real(&[(&set("alpha"), 1.2), (&set("scale"), 0.8187)]), OK);
        assert_eq!(instance.set_integer(&[(&set("prediction_horizon"), 100), (&set("terms"), 5)]), OK);
    }
    assert_eq!(instance.set_integer(&[("controller.model", 2)]), OK);
    instance.initialize();
    for controller in CONTROLLERS {
        let difference = instance.real(&format!("controller.{controller}.eigenvalue_difference_to_dlqr"));
        let condition = instance.real(&format!("controller.{controller}.condition_number"));
        assert!(difference.abs() < 1e-2, "{controller}: {difference}");
        assert!((1.0..1e3).contains(&condition), "{controller}: {condition}");
    }
}

/// A tunable limit takes effect in flight.
#[test]
fn limits_are_tunable() {
    let mut instance = Instance::initialized(closed_loop(), &[("reference.position.x", 500.0)], &[]);
    instance.fly(0.0, 0.1, 100);
    let fast = instance.real("velocity.x");
    assert!(fast > 6.0, "{fast} m/s");
    assert_eq!(instance.set_real(&[("limits.speed.horizontal", 2.0)]), OK);
    instance.fly(10.0, 0.1, 100);
    let slow = instance.real("velocity.x");
    assert!(slow < 2.05, "{slow} m/s");
    assert!(slow > 1.0, "{slow} m/s");
}

/// A change to a value that makes the whole impossible is refused, and the flight goes on as if nothing
/// had been asked.
fn refused_tuning_leaves_no_trace(subject: &'static Subject) {
    let (name, wrong, _) = subject.sample.contradiction;
    let names = [name, subject.sample.input];
    let start = |name| subject.description.variable(name).number("start").expect("a start value");
    let starts = names.map(start);
    let flown = |disturb: bool| {
        let mut instance = Instance::initialized(subject, &[], &[]);
        for i in 0..40 {
            if disturb {
                let values = [(name, wrong), (subject.sample.input, 7.0)];
                assert_eq!(instance.set_real(&values), ERROR);
                assert!(instance.log.last().text.contains(name));
                assert_eq!(instance.reals(names), starts);
            }
            assert_eq!(instance.do_step(f64::from(i) * 0.1, 0.1), OK);
        }
        instance.outputs()
    };
    assert_eq!(flown(true), flown(false));
}

/// Setting a parameter to the value that it has is no change: the flight is the same.
fn tuning_to_the_same_value_is_no_change(subject: &'static Subject) {
    let flown = |tune: bool| {
        let mut instance = Instance::initialized(subject, &[], &[]);
        for i in 0..20 {
            if tune {
                let value = instance.real(subject.sample.tunable);
                assert_eq!(instance.set_real(&[(subject.sample.tunable, value)]), OK);
            }
            assert_eq!(instance.do_step(f64::from(i) * 0.1, 0.1), OK);
        }
        instance.outputs()
    };
    assert_eq!(flown(true), flown(false));
}

for_each_model! {
    contradictions_are_found_when_initialization_ends_and_can_be_mended,
    refused_tuning_leaves_no_trace,
    tuning_to_the_same_value_is_no_change,
}
