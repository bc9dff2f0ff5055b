//! The description of FMI 3.0 says the same as that of 2.0, with arrays for vectors.

use std::collections::BTreeSet;

use super::{all, closed_loop, lag, oscillator};
use crate::common::description::Variable as Scalar;
use crate::common::fmi3::description::Variable;
use crate::common::fmi3::library::Reference;
use crate::common::fmi3::subject::Subject;

/// Each variable with the scalars of FMI 2.0 that it stands for.
fn with_scalars(subject: &'static Subject) -> impl Iterator<Item = (&'static Variable, &'static [Scalar])> {
    subject.description.variables.iter().filter_map(|variable| {
        let first = usize::try_from(variable.reference).expect("small");
        subject.second.variables.get(first..first + variable.length()).map(|scalars| (variable, scalars))
    })
}

/// No element is left out, none is there twice, and value references are those of 2.0.
#[test]
fn variables_are_the_scalars_of_version_2_and_time_and_event_indicators() {
    for subject in all() {
        let covered: Vec<&str> =
            with_scalars(subject).flat_map(|(_, scalars)| scalars).map(|v| v.name.as_str()).collect();
        let scalars: Vec<&str> = subject.second.variables.iter().map(|v| v.name.as_str()).collect();
        assert_eq!(covered, scalars);
        let indicators = subject.second.event_indicators;
        let expected = with_scalars(subject).count() + 1 + usize::from(indicators > 0);
        assert_eq!(subject.description.variables.len(), expected);
        let time = subject.description.variable("time");
        assert_eq!(time.causality(), "independent");
        let attributes = ["variability", "unit", "start", "initial"].map(|name| time.attribute(name));
        assert_eq!(attributes, [Some("continuous"), Some("s"), None, None]);
        if indicators > 0 {
            let variable = subject.description.variable("event_indicator");
            assert_eq!((variable.dimension, variable.causality()), (Some(indicators), "local"));
            let structure = subject.description.unknowns("EventIndicator");
            assert_eq!(structure, [(variable.reference, None)]);
        }
        let references: BTreeSet<Reference> =
            subject.description.variables.iter().map(|variable| variable.reference).collect();
        assert_eq!(references.len(), expected, "each reference once");
    }
}

/// Elements of one array have one type, causality, variability, unit and range; only outputs may be within a narrower one.
#[test]
fn elements_of_an_array_agree() {
    for (variable, scalars) in all().into_iter().flat_map(with_scalars) {
        let name = &variable.name;
        let value_type = match variable.value_type.as_str() {
            "Float64" => "Real",
            "Int32" => "Integer",
            other => other,
        };
        for scalar in scalars {
            assert_eq!(scalar.value_type, value_type, "{name}");
            assert_eq!(Some(scalar.causality.as_str()), variable.attribute("causality"), "{name}");
            assert_eq!(Some(scalar.variability.as_str()), variable.attribute("variability"), "{name}");
            assert_eq!(scalar.initial.as_deref(), variable.attribute("initial"), "{name}");
            for attribute in ["declaredType", "unit", "displayUnit"] {
                assert_eq!(scalar.attribute(attribute), variable.attribute(attribute), "{name}");
            }
            let bound = |limit: &str| {
                let own = variable.attribute(limit).map(|bound| bound.parse::<f64>().expect("a number"));
                (scalar.number(limit), own)
            };
            let ((least, minimum), (most, maximum)) = (bound("min"), bound("max"));
            let within =
                least >= minimum && most.is_none_or(|most| maximum.is_none_or(|bound| most <= bound));
            assert!(within, "{name}");
            assert!((least, most) == (minimum, maximum) || scalar.causality == "output", "{name}");
        }
        let start: Option<Vec<&str>> = scalars.iter().map(|scalar| scalar.attribute("start")).collect();
        assert_eq!(variable.start(), start, "{name}");
        if variable.dimension.is_none() {
            assert_eq!(variable.name, scalars[0].name);
            assert_eq!(variable.attribute("description"), Some(scalars[0].description.as_str()));
            assert_eq!(variable.attribute("nominal"), scalars[0].attribute("nominal"));
        }
    }
}

/// Whoever adds a vector to the table adds its array, too. The ground is level: its height is no component of a vector.
#[test]
fn every_vector_is_an_array() {
    let endings = [
        &["x", "y", "z"][..],
        &["xy", "xz", "yz"],
        &["u", "v", "w"],
        &["p", "q", "r"],
        &["phi", "theta", "psi"],
        &["q0", "q1", "q2", "q3"],
    ];
    for subject in all() {
        for variable in subject.description.variables.iter().filter(|v| v.dimension.is_none()) {
            let name = variable.name.as_str();
            let component =
                name.rsplit_once('.').is_some_and(|(_, last)| endings.iter().any(|set| set.contains(&last)));
            assert!(!component && !name.contains('[') || name == "ground.z", "{name} is a scalar");
        }
    }
    let lengths: Vec<(&str, Option<usize>)> =
        ["position", "quaternion", "rotor.speed", "reference.position", "thrust"]
            .map(|name| (name, closed_loop().description.variable(name).dimension))
            .into();
    let expected = [
        ("position", Some(3)),
        ("quaternion", Some(4)),
        ("rotor.speed", Some(4)),
        ("reference.position", Some(3)),
        ("thrust", None),
    ];
    assert_eq!(lengths, expected);
}

/// So that a tool can show the names as a tree.
#[test]
fn no_variable_is_the_parent_of_another() {
    for subject in all() {
        let names: Vec<&str> = subject.description.variables.iter().map(|v| v.name.as_str()).collect();
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
        for name in &names {
            let below = format!("{name}.");
            assert!(!names.iter().any(|other| other.starts_with(&below)), "{name}");
        }
    }
}

/// An array depends on what its elements depend on, and knowns are the arrays that have them.
#[test]
fn structure_is_that_of_version_2() {
    for subject in all() {
        let lists = [
            ("Output", &subject.second.outputs),
            ("ContinuousStateDerivative", &subject.second.derivatives),
            ("InitialUnknown", &subject.second.initial_unknowns),
        ];
        for (kind, second) in lists {
            // Indices of 2.0 count from 1.
            let whole = |index: &usize| {
                subject.description.containing(Reference::try_from(index - 1).expect("small")).reference
            };
            let mut expected: Vec<(Reference, BTreeSet<Reference>)> = Vec::new();
            for (index, dependencies) in second {
                let dependencies = dependencies.iter().map(whole);
                match expected.last_mut().filter(|(reference, _)| *reference == whole(index)) {
                    Some((_, known)) => known.extend(dependencies),
                    None => expected.push((whole(index), dependencies.collect())),
                }
            }
            let found = subject.description.unknowns(kind).into_iter();
            let found: Vec<_> = found
                .map(|(reference, known)| (reference, known.expect("it is given").into_iter().collect()))
                .collect();
            assert_eq!(found, expected, "{kind}");
        }
    }
}

#[test]
fn an_array_of_derivatives_belongs_to_the_array_of_its_states() {
    let description = &oscillator().description;
    let (state, derivative) = (description.variable("x"), description.variable("der(x)"));
    assert_eq!(derivative.attribute("derivative"), Some(state.reference.to_string().as_str()));
    assert_eq!((state.dimension, derivative.dimension), (Some(2), Some(2)));
    assert_eq!(lag().description.variable("der(y)").attribute("derivative"), Some("2"));
}

#[test]
fn capabilities_are_those_of_the_model() {
    for subject in all() {
        let exchanges = subject.second.event_indicators > 0;
        let told = |interface: &str, name: &str| subject.description.capability(interface, name);
        let flag = |flag: bool| Some(flag.to_string());
        assert_eq!(told("ModelExchange", "modelIdentifier").is_some(), exchanges);
        assert_eq!(told("ScheduledExecution", "modelIdentifier"), None);
        for name in ["providesDirectionalDerivatives", "providesAdjointDerivatives"] {
            assert_eq!(told("CoSimulation", name), flag(exchanges), "{name}");
        }
        for name in ["canGetAndSetFMUState", "canSerializeFMUState", "canHandleVariableCommunicationStepSize"]
        {
            assert_eq!(told("CoSimulation", name), flag(true), "{name}");
        }
        assert_eq!(told("CoSimulation", "hasEventMode"), flag(false));
        assert_eq!(told("CoSimulation", "providesIntermediateUpdate"), None);
        assert_eq!(subject.description.token, subject.second.guid);
    }
}
