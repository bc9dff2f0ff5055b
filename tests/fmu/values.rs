//! Getting and setting values: what is refused, and that nothing changes then.

use crate::common::description::Variable;
use crate::common::instance::Instance;
use crate::common::library::{ERROR, OK, Reference};
use crate::common::subject::{Sample, Subject};

fn settable(subject: &'static Subject) -> impl Iterator<Item = &'static Variable> {
    subject.description.variables.iter().filter(|v| v.causality == "input" || v.causality == "parameter")
}

/// All values that can be set, as bits.
fn settings(subject: &'static Subject, instance: &mut Instance) -> Vec<u64> {
    settable(subject)
        .map(|variable| match variable.value_type.as_str() {
            "Real" => instance.real(&variable.name).to_bits(),
            "Integer" | "Enumeration" => instance.integer(&variable.name) as u64,
            _ => u64::from(instance.boolean(&variable.name)),
        })
        .collect()
}

/// A value of an integer; of the number of an enumeration the one that the enumeration gets, too.
fn whole(variable: &Variable) -> i32 {
    if variable.number("max") < Some(17.0) { 2 } else { 17 }
}

fn what_is_set_is_read_back(subject: &'static Subject) {
    let mut instance = Instance::new(subject);
    for variable in settable(subject) {
        let name = variable.name.as_str();
        match variable.value_type.as_str() {
            "Real" => {
                let [minimum, maximum] = ["min", "max"].map(|end| variable.number(end).expect("a range"));
                for value in [minimum, maximum, (minimum + maximum) / 2.0] {
                    assert_eq!(instance.set_real(&[(name, value)]), OK);
                }
            }
            "Integer" => assert_eq!(instance.set_integer(&[(name, whole(variable))]), OK),
            "Enumeration" => assert_eq!(instance.set_integer(&[(name, 2)]), OK),
            _ => assert_eq!(instance.set_boolean(&[(name, false)]), OK),
        }
    }
    assert_eq!(instance.enter_initialization_mode(), OK);
    for variable in settable(subject) {
        let name = variable.name.as_str();
        match variable.value_type.as_str() {
            "Real" => {
                let [minimum, maximum] = ["min", "max"].map(|end| variable.number(end).expect("a range"));
                let (expected, got) = ((minimum + maximum) / 2.0, instance.real(name));
                // Sample times are kept in microseconds.
                assert!((got - expected).abs() <= 1e-12 * expected.abs(), "{name}: {got}");
            }
            "Integer" => assert_eq!(instance.integer(name), whole(variable), "{name}"),
            "Enumeration" => assert_eq!(instance.integer(name), 2, "{name}"),
            _ => assert!(!instance.boolean(name), "{name}"),
        }
    }
}

/// The value that a message refuses, and the smallest and the largest that it allows.
fn told(text: &str, name: &str) -> (f64, [f64; 2]) {
    let number = |text: &str| text.split(' ').next().expect("a number").parse().expect("a number");
    let rest = text.split_once(&format!("{name} = ")).expect("the name").1;
    let (value, allowed) = rest.split_once("; allowed ").expect("a range");
    let (minimum, maximum) =
        allowed.split_once(" to ").or_else(|| allowed.split_once('–')).expect("two ends");
    (number(value), [number(minimum), number(maximum)])
}

/// In each state in which values can be set, for each number there is.
fn values_out_of_range_are_refused_by_name(subject: &'static Subject) {
    let check = |instance: &mut Instance, before: &[u64], all: bool| {
        for variable in
            settable(subject).filter(|v| all || v.causality == "input" || v.variability == "tunable")
        {
            let name = variable.name.as_str();
            match variable.value_type.as_str() {
                "Real" => {
                    let [minimum, maximum] = ["min", "max"].map(|end| variable.number(end).expect("a range"));
                    let outside = [
                        minimum - 1e-9 * minimum.abs().max(1.0),
                        maximum + 1e-9 * maximum.abs().max(1.0),
                        f64::NAN,
                        f64::INFINITY,
                        f64::NEG_INFINITY,
                    ];
                    for value in outside {
                        assert_eq!(instance.set_real(&[(name, value)]), ERROR, "{name} = {value}");
                        let text = instance.log.last().text;
                        let (told, allowed) = told(&text, name);
                        assert!(
                            told.to_bits() == value.to_bits() || told.is_nan() && value.is_nan(),
                            "{text}"
                        );
                        assert_eq!(allowed, [minimum, maximum], "{text}");
                    }
                }
                "Integer" | "Enumeration" => {
                    let [minimum, maximum] =
                        ["min", "max"].map(|end| variable.number(end).expect("a range") as i32);
                    for value in [minimum - 1, maximum.saturating_add(1), i32::MAX, i32::MIN] {
                        if value == maximum {
                            continue;
                        }
                        assert_eq!(instance.set_integer(&[(name, value)]), ERROR, "{name} = {value}");
                        let text = instance.log.last().text;
                        if variable.value_type == "Integer" {
                            let (told, allowed) = told(&text, name);
                            assert_eq!(
                                (told, allowed),
                                (value.into(), [minimum, maximum].map(f64::from)),
                                "{text}"
                            );
                        } else {
                            let expected = format!("{name} = {value}; allowed {minimum} (");
                            assert!(text.contains(&expected), "{text}");
                        }
                    }
                }
                _ => {}
            }
        }
        if !before.is_empty() {
            assert_eq!(settings(subject, instance), before);
        }
    };
    let mut instance = Instance::new(subject);
    check(&mut instance, &[], true);
    assert_eq!(instance.enter_initialization_mode(), OK);
    let before = settings(subject, &mut instance);
    check(&mut instance, &before, true);
    assert_eq!(instance.exit_initialization_mode(), OK);
    instance.fly(0.0, 0.1, 1);
    let outputs = instance.outputs();
    check(&mut instance, &before, false);
    assert_eq!(instance.outputs(), outputs);
    instance.fly(0.1, 0.1, 1);
}

/// One bad value among five, at any place: none is set.
fn one_call_is_one_transaction(subject: &'static Subject) {
    let Sample { good, bad, .. } = subject.sample;
    let mut instance = Instance::initialized(subject, &[], &[]);
    let before = settings(subject, &mut instance);
    for place in 0..=good.len() {
        for &wrong in bad {
            let mut values = good.to_vec();
            values.insert(place, wrong);
            assert_eq!(instance.set_real(&values), ERROR, "{wrong:?} at {place}");
            assert!(instance.log.last().text.contains(wrong.0));
            assert_eq!(settings(subject, &mut instance), before, "{wrong:?} at {place}");
        }
    }
    assert_eq!(instance.set_real(good), OK);
    for (name, value) in good {
        assert_eq!(instance.real(name), *value, "{name}");
    }
}

fn of_two_values_for_one_variable_the_last_counts(subject: &'static Subject) {
    let mut instance = Instance::initialized(subject, &[], &[]);
    assert_eq!(instance.set_real(&[(subject.sample.input, 1.0), (subject.sample.input, 2.0)]), OK);
    assert_eq!(instance.real(subject.sample.input), 2.0);
}

fn unknown_references_and_wrong_types_are_refused(subject: &'static Subject) {
    let mut instance = Instance::initialized(subject, &[], &[]);
    let before = settings(subject, &mut instance);
    let count = Reference::try_from(subject.description.variables.len()).expect("a small number");
    for reference in [count, count + 1, Reference::MAX] {
        let status = instance.set_real_references(
            &[subject.description.reference(subject.sample.input), reference],
            &[1.0; 2],
        );
        assert_eq!(status, ERROR);
        assert!(instance.log.last().text.contains(&reference.to_string()));
        assert_eq!(instance.try_reals(&[0, reference]), Err(ERROR));
        assert!(instance.log.last().text.contains(&reference.to_string()));
    }
    let (c, l) = (instance.component, &subject.library);
    for variable in &subject.description.variables {
        let reference = variable.reference;
        let real = variable.value_type == "Real";
        let text = |instance: &Instance| instance.log.last().text;
        // SAFETY: the instance is alive and all pointers are valid.
        unsafe {
            if real {
                assert_eq!((l.set_integer)(c, &reference, 1, &1), ERROR);
                assert!(text(&instance).contains(&variable.name));
                assert_eq!((l.get_boolean)(c, &reference, 1, &mut 0), ERROR);
            } else {
                assert_eq!((l.set_real)(c, &reference, 1, &1.0), ERROR);
                assert!(text(&instance).contains(&variable.name));
                assert_eq!((l.get_real)(c, &reference, 1, &mut 0.0), ERROR);
            }
            assert!(text(&instance).contains(&variable.name));
            assert_eq!((l.get_string)(c, &reference, 1, &mut std::ptr::null()), ERROR);
            assert_eq!((l.set_string)(c, &reference, 1, &c"text".as_ptr()), ERROR);
        }
    }
    assert_eq!(settings(subject, &mut instance), before);
}

/// A refused read writes nothing, also not the values before the bad one.
fn refused_reading_writes_nothing(subject: &'static Subject) {
    let instance = Instance::initialized(subject, &[], &[]);
    let references = [subject.description.reference(subject.sample.output), Reference::MAX];
    let mut values = [-7.0; 2];
    // SAFETY: the instance is alive; both arrays have two elements.
    let status = unsafe {
        (subject.library.get_real)(instance.component, references.as_ptr(), 2, values.as_mut_ptr())
    };
    assert_eq!((status, values), (ERROR, [-7.0; 2]));
}

/// Few values at once, many, and outputs among others are what each of them is alone.
fn what_is_read_together_is_what_is_read_alone(subject: &'static Subject) {
    let mut instance = Instance::initialized(subject, &[], &[]);
    assert_eq!(instance.do_step(0.0, 0.013), OK);
    let real = subject.description.variables.iter().filter(|variable| variable.value_type == "Real");
    let (outputs, others): (Vec<_>, Vec<_>) = real.partition(|variable| variable.causality == "output");
    let mixed = outputs.iter().chain(&others).map(|variable| variable.reference).collect::<Vec<_>>();
    let alone =
        mixed.iter().map(|&reference| instance.try_reals(&[reference]).expect("a value")[0].to_bits());
    let alone = alone.collect::<Vec<_>>();
    for count in 0..=mixed.len() {
        // Each time a run whose outputs have not been calculated yet.
        let mut instance = Instance::initialized(subject, &[], &[]);
        assert_eq!(instance.do_step(0.0, 0.013), OK);
        let together = instance.try_reals(&mixed[..count]).expect("values");
        assert_eq!(together.into_iter().map(f64::to_bits).collect::<Vec<_>>(), alone[..count], "{count}");
    }
}

fn what_is_not_settable_stays(subject: &'static Subject) {
    let mut instance = Instance::new(subject);
    for variable in
        subject.description.variables.iter().filter(|v| !["input", "parameter"].contains(&&*v.causality))
    {
        assert_eq!(instance.set_real(&[(&variable.name, 0.5)]), ERROR, "{}", variable.name);
        let text = instance.log.last().text;
        assert!(text.contains(&variable.name), "{text}");
        if variable.value_type == "Real" {
            let kind = match variable.causality.as_str() {
                "output" => "an output",
                "local" => "a derivative",
                _ => "calculated",
            };
            assert!(text.contains(&format!("cannot be set: it is {kind} (read-only)")), "{text}");
        }
    }
    instance.initialize();
    for variable in settable(subject).filter(|v| v.variability == "fixed") {
        let name = variable.name.as_str();
        let status = match variable.value_type.as_str() {
            "Real" => instance.set_real(&[(name, variable.number("start").expect("a start value"))]),
            "Integer" => instance.set_integer(&[(name, 5)]),
            "Enumeration" => instance.set_integer(&[(name, 1)]),
            _ => instance.set_boolean(&[(name, true)]),
        };
        assert_eq!(status, ERROR, "{name} is fixed");
        assert!(instance.log.last().text.contains(name));
    }
}

/// An enumeration can be chosen by an integer of its own, which wins until it is 0 again, whatever is set first.
#[test]
fn enumerations_can_be_chosen_by_number() {
    let subject = crate::lag();
    let settled = |values: &[(&str, i32)]| {
        let mut instance = Instance::new(subject);
        for value in values {
            assert_eq!(instance.set_integer(&[*value]), OK, "{:?}", instance.log.take());
        }
        instance.initialize();
        assert_eq!(instance.do_step(0.0, 1.0), OK);
        (instance.integer("sign"), instance.integer("sign_number"), instance.real("y") > 0.0)
    };
    assert_eq!(settled(&[]), (1, 0, true));
    assert_eq!(settled(&[("sign_number", 2)]), (2, 2, false));
    // An importer that writes all start values, in both orders.
    assert_eq!(settled(&[("sign_number", 2), ("sign", 1)]), (2, 2, false));
    assert_eq!(settled(&[("sign", 2), ("sign_number", 0)]), (2, 0, false));
    assert_eq!(settled(&[("sign_number", 1), ("sign", 2), ("sign_number", 0)]), (2, 0, false));
    let mut instance = Instance::new(subject);
    assert_eq!(instance.set_integer(&[("sign_number", 3)]), ERROR);
    assert!(instance.log.last().text.contains("sign_number = 3; allowed 0 to 2"));
    // It is saved, and not changed in a run.
    assert_eq!(instance.set_integer(&[("sign_number", 2)]), OK);
    instance.initialize();
    let saved = instance.get_state();
    let bytes = instance.serialize(saved);
    assert_eq!(instance.set_integer(&[("sign_number", 0)]), ERROR);
    let mut other = Instance::new(subject);
    let state = other.deserialize(&bytes).expect("our own bytes");
    assert_eq!(other.set_state(state), OK);
    assert_eq!((other.integer("sign"), other.integer("sign_number")), (2, 2));
    other.free_state(state);
    instance.free_state(saved);
}

/// C has no Booleans; anything but 0 is true.
fn booleans_are_read_as_c_does(subject: &'static Subject) {
    let mut instance = Instance::initialized(subject, &[], &[]);
    for (value, expected) in [(0, false), (1, true), (0, false), (-1, true), (i32::MIN, true)] {
        // SAFETY: the instance is alive and the pointers are valid.
        let status = unsafe {
            (subject.library.set_boolean)(
                instance.component,
                &subject.description.reference(subject.sample.switch),
                1,
                &value,
            )
        };
        assert_eq!(status, OK);
        assert_eq!(instance.boolean(subject.sample.switch), expected);
    }
}

for_each_model! {
    what_is_set_is_read_back,
    values_out_of_range_are_refused_by_name,
    one_call_is_one_transaction,
    of_two_values_for_one_variable_the_last_counts,
    unknown_references_and_wrong_types_are_refused,
    refused_reading_writes_nothing,
    what_is_read_together_is_what_is_read_alone,
    what_is_not_settable_stays,
    booleans_are_read_as_c_does,
}
