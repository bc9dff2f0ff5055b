//! What is logged, and how.

use std::ffi::CStr;

use crate::common::instance::{Instance, Message};
use crate::common::library::{ERROR, OK, Status};
use crate::common::subject::Subject;

fn select(instance: &Instance, logging_on: bool, categories: &[&CStr]) -> Status {
    let categories: Vec<_> = categories.iter().map(|category| category.as_ptr()).collect();
    // SAFETY: the instance is alive and the strings end with NUL.
    unsafe {
        (instance.library.set_debug_logging)(
            instance.component,
            i32::from(logging_on),
            categories.len(),
            categories.as_ptr(),
        )
    }
}

/// What one good and one refused call log.
fn categories(instance: &mut Instance) -> Vec<String> {
    instance.log.take();
    assert_eq!(instance.reset(), OK);
    assert_eq!(instance.do_step(0.0, 0.1), ERROR);
    instance.log.take().into_iter().map(|message| message.category).collect()
}

fn categories_are_selected(subject: &'static Subject) {
    let mut instance = Instance::new(subject);
    assert_eq!(categories(&mut instance), ["logEvents", "logStatusError"]);
    assert_eq!(select(&instance, false, &[]), OK);
    assert_eq!(categories(&mut instance), ["logStatusError"]);
    assert_eq!(select(&instance, true, &[c"logStatusWarning"]), OK);
    assert_eq!(categories(&mut instance), ["logStatusError"]);
    assert_eq!(select(&instance, true, &[c"logStatusWarning", c"logEvents"]), OK);
    assert_eq!(categories(&mut instance), ["logEvents", "logStatusError"]);
    assert_eq!(select(&instance, false, &[c"logEvents"]), OK);
    assert_eq!(categories(&mut instance), ["logStatusError"]);
    assert_eq!(select(&instance, true, &[c"logAll"]), OK);
    assert_eq!(categories(&mut instance), ["logEvents", "logStatusError"]);
}

fn without_logging_only_errors_are_heard(subject: &'static Subject) {
    let mut instance = Instance::with_logging(subject, false);
    assert_eq!(categories(&mut instance), ["logStatusError"]);
}

fn unknown_category_is_named_and_changes_nothing(subject: &'static Subject) {
    let mut instance = Instance::with_logging(subject, false);
    assert_eq!(select(&instance, true, &[c"logEvents", c"logNonsense"]), ERROR);
    assert!(instance.log.last().text.contains("logNonsense"));
    assert_eq!(categories(&mut instance), ["logStatusError"]);
}

fn messages_carry_instance_status_and_function(subject: &'static Subject) {
    let mut instance = Instance::new(subject);
    assert_eq!(instance.do_step(0.0, 0.1), ERROR);
    assert_eq!(
        instance.log.take(),
        [Message {
            instance: "instance".into(),
            status: ERROR,
            category: "logStatusError".into(),
            text: "fmi2DoStep: not allowed in the state \"instantiated\"".into(),
        }]
    );
    instance.initialize();
}

/// In messages of FMUs "#r1#" means a variable, so the sign itself is doubled; a percent sign must not be
/// taken for a format.
fn special_characters_arrive(subject: &'static Subject) {
    let instance = Instance::new(subject);
    assert_eq!(select(&instance, true, &[c"100 %s #1#"]), ERROR);
    assert!(instance.log.last().text.contains("100 %s ##1##"));
}

/// FMI 2.0.4, section 2.1.6: an FMU for co-simulation may ignore the tolerance. Importers pass one at each run, so nothing is logged.
fn a_tolerance_is_ignored_in_silence(subject: &'static Subject) {
    let mut instance = Instance::new(subject);
    for tolerance in [1e-4, 0.0, f64::NAN] {
        // SAFETY: the instance is alive.
        let status =
            unsafe { (instance.library.setup_experiment)(instance.component, 1, tolerance, 0.0, 1, 5.0) };
        assert_eq!(status, OK);
    }
    assert_eq!(instance.log.take(), []);
    instance.initialize();
    instance.fly(0.0, 0.05, 2);
}

/// Controllers that are stepped far more coarsely than they sample say so, once in a run.
#[test]
fn a_coarse_step_of_the_controllers_is_warned_of_once() {
    let mut instance = Instance::new(crate::controller());
    for _run in 0..2 {
        instance.initialize();
        instance.log.take();
        instance.fly(0.0, 0.02, 5);
        assert_eq!(instance.log.take(), []);
        instance.fly(0.1, 0.15, 2);
        let said = instance.log.take();
        let [warning] = said.as_slice() else { panic!("one warning is expected: {said:?}") };
        assert_eq!(warning.category, "logStatusWarning");
        assert!(
            warning.text.contains("0.15 s is much longer than the attitude controller's sample time, 0.01 s")
        );
        assert!(warning.text.ends_with("use steps of at most 0.01 s"), "{}", warning.text);
        assert_eq!(instance.reset(), OK);
    }
    let mut closed_loop = Instance::new(crate::closed_loop());
    closed_loop.initialize();
    closed_loop.log.take();
    closed_loop.fly(0.0, 0.15, 2);
    assert_eq!(closed_loop.log.take(), []);
}

for_each_model! {
    a_tolerance_is_ignored_in_silence,
    categories_are_selected,
    without_logging_only_errors_are_heard,
    unknown_category_is_named_and_changes_nothing,
    messages_carry_instance_status_and_function,
    special_characters_arrive,
}
