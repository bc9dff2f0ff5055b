//! Communication steps of all lengths.

use proptest::prelude::*;

use crate::closed_loop;
use crate::common::instance::Instance;
use crate::common::library::{ERROR, OK};
use crate::common::subject::Subject;

/// Outputs after 2 s in the given steps, each a whole number of microseconds.
fn run(subject: &'static Subject, start: f64, steps_us: &[u32]) -> Vec<u64> {
    let mut instance = Instance::new(subject);
    assert_eq!(instance.setup(start, None), OK);
    assert_eq!(instance.enter_initialization_mode(), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    let mut elapsed_us = 0;
    for step_us in steps_us {
        let (point, step) = (start + f64::from(elapsed_us) * 1e-6, f64::from(*step_us) * 1e-6);
        assert_eq!(instance.do_step(point, step), OK, "{:?}", instance.log.take());
        elapsed_us += step_us;
    }
    assert_eq!(elapsed_us, 2_000_000);
    instance.outputs()
}

fn reference(subject: &'static Subject) -> Vec<u64> {
    run(subject, 0.0, &[2_000_000])
}

fn any_equal_steps_give_the_same_run(subject: &'static Subject) {
    for step_us in [100, 125, 1_000, 2_500, 8_000, 10_000, 16_000, 25_000, 50_000, 400_000] {
        assert_eq!(
            run(subject, 0.0, &vec![step_us; (2_000_000 / step_us) as usize]),
            reference(subject),
            "{step_us} µs"
        );
    }
}

fn any_start_time_gives_the_same_run(subject: &'static Subject) {
    for start in [-1.0, -0.05, 0.3, 1e3, 1e6] {
        assert_eq!(run(subject, start, &[50_000; 40]), reference(subject), "from {start} s");
    }
}

fn any_split_gives_the_same_run(subject: &'static Subject) {
    let cuts = prop::collection::btree_set(1_u32..2_000_000, 0..40);
    proptest!(ProptestConfig::with_cases(64), |(mut cuts in cuts)| {
        cuts.insert(2_000_000);
        let mut last = 0;
        let steps: Vec<u32> = cuts.into_iter().map(|cut| cut - std::mem::replace(&mut last, cut)).collect();
        prop_assert_eq!(run(subject, 0.0, &steps), reference(subject));
    });
}

/// The state at odd communication points lies on the same smooth motion: nothing is rounded to a sample.
#[test]
fn arrival_is_exact() {
    let mut instance =
        Instance::initialized(closed_loop(), &[("initial.velocity.x", 3.0)], &[("armed", false)]);
    let mut time = 0.0;
    for step in [0.000_7, 0.001_3, 0.033_333, 0.1, 0.000_001, 0.017] {
        assert_eq!(instance.do_step(time, step), OK);
        time += step;
        // Free fall, without drag.
        let [x, z] = instance.reals(["position.x", "position.z"]);
        assert!((x - 3.0 * time).abs() < 1e-12, "{time}: {x}");
        assert!((z - 0.5 * 9.806_65 * time * time).abs() < 1e-12, "{time}: {z}");
        assert_eq!(instance.time(), time);
    }
}

#[test]
fn steps_below_a_microsecond_are_no_error_and_add_up() {
    let mut instance =
        Instance::initialized(closed_loop(), &[("initial.velocity.x", 3.0)], &[("armed", false)]);
    instance.fly(0.0, 1e-7, 1000);
    let x = instance.real("position.x");
    assert!((x - 3.0 * 1e-4).abs() < 1e-12, "{x}");
    assert_eq!(instance.do_step(1e-4, f64::MIN_POSITIVE), OK);
    assert_eq!(instance.do_step(1e-4, f64::EPSILON), OK);
    assert_eq!(instance.do_step(1e-4, 0.1), OK);
}

fn accumulated_time_is_accepted(subject: &'static Subject) {
    let mut instance = Instance::initialized(subject, &[], &[]);
    let mut time = 0.0;
    for _ in 0..5000 {
        assert_eq!(instance.do_step(time, 0.001), OK, "{:?}", instance.log.take());
        time += 0.001;
    }
    assert_ne!(time, 5.0, "this test needs rounding errors");
    let mut exact = Instance::initialized(subject, &[], &[]);
    exact.fly(0.0, 5.0, 1);
    assert_eq!(instance.outputs(), exact.outputs());
}

/// Importers whose points are whole nanoseconds while their step is 1/60 s, or whose step is a single-precision number: for an
/// hour, each point is off by a rounding, and the FMU follows it.
fn points_off_by_a_rounding_are_followed_for_an_hour(subject: &'static Subject) {
    let nanoseconds = |i: u32| f64::from(i) * 16_666_667e-9;
    let hundredths = |i: u32| f64::from(i) * 0.01;
    type Points<'a> = &'a dyn Fn(u32) -> f64;
    let runs: [(Points<'_>, f64, u32); 2] =
        [(&nanoseconds, 1.0 / 60.0, 216_000), (&hundredths, f64::from(0.01_f32), 360_000)];
    for (point, step, steps) in runs {
        let mut instance = Instance::initialized(subject, &[], &[(subject.sample.switch, false)]);
        for i in 0..steps {
            assert_eq!(instance.do_step(point(i), step), OK, "step {i}: {:?}", instance.log.take());
        }
        assert_eq!(instance.time(), point(steps - 1) + step);
    }
}

fn wrong_steps_are_refused_and_change_nothing(subject: &'static Subject) {
    let mut instance = Instance::initialized(subject, &[], &[]);
    instance.fly(0.0, 0.1, 5);
    let outputs = instance.outputs();
    for (point, step) in [
        (0.5, 0.0),
        (0.5, -0.1),
        (0.5, f64::NAN),
        (0.5, f64::INFINITY),
        (0.6, 0.1),
        (0.4, 0.1),
        (0.500_001, 0.1),
        (f64::NAN, 0.1),
        (f64::INFINITY, 0.1),
        (0.5, 1e12),
    ] {
        assert_eq!(instance.do_step(point, step), ERROR, "{point} + {step}");
        instance.log.last();
        assert_eq!(instance.outputs(), outputs);
    }
    assert_eq!(instance.do_step(0.6, 0.1), ERROR);
    let text = instance.log.last().text;
    assert!(text.contains("0.6") && text.contains("0.5"), "both times are said: {text}");
    assert_eq!(instance.do_step(0.5, 0.1), OK);
}

/// A call cannot be interrupted, so the longest step bounds the time that it takes.
fn steps_beyond_the_longest_are_refused_and_change_nothing(subject: &'static Subject) {
    let longest = subject.sample.longest_step;
    let mut instance = Instance::initialized(subject, &[], &[]);
    let before = instance.outputs();
    for step in [longest * 1.001, 1e5, 1e9] {
        assert_eq!(instance.do_step(0.0, step), ERROR, "{step}");
        let text = instance.log.last().text;
        assert!(
            text.contains(&format!("{step:?}")) && text.contains(&format!("at most {longest:?} s")),
            "{text}"
        );
        assert_eq!((instance.time(), instance.outputs()), (0.0, before.clone()));
    }
    assert_eq!(instance.do_step(0.0, longest), OK, "{:?}", instance.log.take());
    assert_eq!(instance.time(), longest);
}

fn stop_time_is_respected_within_the_tolerance(subject: &'static Subject) {
    let ready = || {
        let mut instance = Instance::new(subject);
        assert_eq!(instance.setup(0.0, Some(0.3)), OK);
        assert_eq!(instance.enter_initialization_mode(), OK);
        assert_eq!(instance.exit_initialization_mode(), OK);
        instance
    };
    let mut instance = ready();
    let mut time = 0.0;
    for _ in 0..3 {
        assert_eq!(instance.do_step(time, 0.1), OK);
        time += 0.1;
    }
    assert!(time > 0.3, "this test needs a rounding error");
    assert_eq!(instance.do_step(time, 0.001), ERROR);
    assert!(instance.log.last().text.contains("stopTime"));
    assert_eq!(ready().do_step(0.0, 0.300_1), ERROR);
    assert_eq!(ready().do_step(0.0, 0.3), OK);
}

/// FMI 2.0 says that an output in `ModelStructure` without dependencies does not change when an input is
/// set at a communication point.
fn outputs_do_not_depend_on_inputs_at_a_communication_point(subject: &'static Subject) {
    let mut instance = Instance::initialized(subject, &[], &[]);
    instance.fly(0.0, 0.35, 1);
    let before = instance.outputs();
    let reals =
        subject.description.variables.iter().filter(|v| v.causality == "input" && v.value_type == "Real");
    for variable in reals {
        assert_eq!(instance.set_real(&[(&variable.name, 3.0)]), OK);
    }
    assert_eq!(instance.set_boolean(&[(subject.sample.switch, false)]), OK);
    assert_eq!(instance.outputs(), before);
    instance.fly(0.35, 0.05, 1);
    assert_ne!(instance.outputs(), before);
}

for_each_model! {
    any_equal_steps_give_the_same_run,
    any_start_time_gives_the_same_run,
    any_split_gives_the_same_run,
    accumulated_time_is_accepted,
    points_off_by_a_rounding_are_followed_for_an_hour,
    wrong_steps_are_refused_and_change_nothing,
    steps_beyond_the_longest_are_refused_and_change_nothing,
    stop_time_is_respected_within_the_tolerance,
    outputs_do_not_depend_on_inputs_at_a_communication_point,
}
