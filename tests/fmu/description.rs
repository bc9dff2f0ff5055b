//! `modelDescription.xml`: up to date, consistent in itself, and true of the library.

use std::collections::{BTreeMap, BTreeSet};

use crate::closed_loop;
use crate::common::description::{Variable, path};
use crate::common::instance::Instance;
use crate::common::library::OK;
use crate::common::subject::Subject;

fn variables(subject: &'static Subject) -> impl Iterator<Item = &'static Variable> {
    subject.description.variables.iter()
}

fn indices(subject: &'static Subject, causality: &[&str]) -> Vec<usize> {
    let places = (1..).zip(variables(subject));
    places.filter(|(_, v)| causality.contains(&v.causality.as_str())).map(|(index, _)| index).collect()
}

/// `cargo xtask model-description` rewrites it.
#[test]
fn file_in_the_repository_is_up_to_date() {
    let subject = closed_loop();
    let path = path();
    let text = std::fs::read_to_string(&path)
        .unwrap_or_else(|error| panic!("{}: {error}; run: cargo xtask model-description", path.display()));
    assert!(
        text == subject.description.text,
        "{} is stale; run: cargo xtask model-description",
        path.display()
    );
}

fn names_are_unique_and_structured(subject: &'static Subject) {
    let names: BTreeSet<_> = variables(subject).map(|v| v.name.as_str()).collect();
    assert_eq!(names.len(), variables(subject).count());
    for name in names {
        // The derivative of a variable with a structured name.
        let name = name.strip_prefix("der(").and_then(|rest| rest.strip_suffix(')')).unwrap_or(name);
        for part in name.split('.') {
            let (stem, index) = part.split_once('[').unwrap_or((part, "1]"));
            let mut letters = stem.chars();
            assert!(letters.next().is_some_and(|first| first.is_ascii_alphabetic()), "{name}");
            assert!(letters.all(|letter| letter.is_ascii_alphanumeric() || letter == '_'), "{name}");
            assert!(index.strip_suffix(']').is_some_and(|index| index.parse::<u32>().is_ok()), "{name}");
        }
    }
}

/// The names that others rely on, from the issue.
#[test]
fn promised_variables_exist() {
    let subject = closed_loop();
    let of = |causality: &str| -> BTreeSet<&str> {
        variables(subject).filter(|v| v.causality == causality).map(|v| v.name.as_str()).collect()
    };
    let expand = |names: &str| -> BTreeSet<String> {
        names
            .split_whitespace()
            .flat_map(|name| match name.rsplit_once('.') {
                Some((stem, ends)) if ends.contains('|') => {
                    ends.split('|').map(|end| format!("{stem}.{end}")).collect()
                }
                _ => vec![name.to_owned()],
            })
            .collect()
    };
    let promised = [
        (
            "input",
            "reference.position.x|y|z reference.velocity.x|y|z reference.acceleration.x|y|z reference.yaw \
             disturbance.force.x|y|z disturbance.torque.x|y|z armed",
        ),
        (
            "output",
            "position.x|y|z altitude velocity.x|y|z acceleration.x|y|z body_velocity.u|v|w attitude.phi|theta|psi \
             attitude.q0|q1|q2|q3 body_rate.p|q|r thrust torque.phi|theta|psi rotor.speed[1]|speed[2]|speed[3]|speed[4] \
             tilt_reference.phi|theta tracking_error.x|y|z",
        ),
        (
            "parameter",
            "airframe.mass airframe.arm_length airframe.inertia.x|y|z initial.position.x|y|z \
             initial.attitude.phi|theta|psi reference.shaping",
        ),
    ];
    for (causality, names) in promised {
        let there = of(causality);
        for name in expand(names) {
            assert!(there.contains(name.as_str()), "no {causality} {name}");
        }
    }
    assert_eq!(subject.description.variable("armed").value_type, "Boolean");
    assert_eq!(subject.description.variable("reference.shaping").value_type, "Boolean");
    assert_eq!(subject.description.variable("reference.shaping").attribute("start"), Some("true"));
}

/// FMI 2.0.4, section 2.2.7: which combinations are legal, and who has a start value.
fn attributes_are_a_legal_combination(subject: &'static Subject) {
    for variable in variables(subject) {
        let initial = variable.initial.as_deref();
        let combination = (variable.causality.as_str(), variable.variability.as_str(), initial);
        let legal = [
            ("input", "continuous", None),
            ("input", "discrete", None),
            ("output", "continuous", Some("calculated")),
            ("output", "discrete", Some("calculated")),
            ("parameter", "fixed", Some("exact")),
            ("parameter", "tunable", Some("exact")),
            ("calculatedParameter", "tunable", Some("calculated")),
            ("local", "continuous", Some("calculated")),
        ];
        assert!(legal.contains(&combination), "{}: {combination:?}", variable.name);
        let has_start = variable.attribute("start").is_some();
        assert_eq!(has_start, ["input", "parameter"].contains(&combination.0), "{}", variable.name);
        assert!(variable.value_type == "Real" || variable.variability != "continuous", "{}", variable.name);
        assert!(!variable.description.is_empty(), "{}", variable.name);
    }
}

fn start_values_lie_in_their_ranges(subject: &'static Subject) {
    let mut numbers = 0;
    for variable in variables(subject).filter(|v| v.value_type != "Boolean") {
        let Some(start) = variable.number("start") else { continue };
        let [minimum, maximum] = ["min", "max"].map(|end| variable.number(end).expect("a range"));
        assert!(minimum < maximum && (minimum..=maximum).contains(&start), "{}", variable.name);
        numbers += 1;
    }
    assert!(numbers >= subject.sample.numbers);
}

fn start_values_are_those_of_a_fresh_instance(subject: &'static Subject) {
    let mut instance = Instance::new(subject);
    assert_eq!(instance.enter_initialization_mode(), OK);
    for variable in variables(subject).filter(|v| v.attribute("start").is_some()) {
        let start = variable.attribute("start").expect("filtered");
        let name = variable.name.as_str();
        match variable.value_type.as_str() {
            "Real" => assert_eq!(instance.real(name), start.parse::<f64>().expect("a number"), "{name}"),
            "Integer" | "Enumeration" => assert_eq!(instance.integer(name).to_string(), start, "{name}"),
            _ => assert_eq!(instance.boolean(name).to_string(), start, "{name}"),
        }
    }
}

fn structure_lists_exactly_the_unknowns_in_order(subject: &'static Subject) {
    let listed = |unknowns: &[(usize, Vec<usize>)]| -> Vec<usize> {
        unknowns.iter().map(|(index, _)| *index).collect()
    };
    assert_eq!(listed(&subject.description.outputs), indices(subject, &["output"]));
    assert_eq!(listed(&subject.description.derivatives), indices(subject, &["local"]));
    // FMI 2.0.4, section 2.2.8; the continuous states are outputs.
    let is_unknown = |variable: &Variable| match variable.causality.as_str() {
        "output" => ["approx", "calculated"].contains(&variable.initial.as_deref().unwrap_or_default()),
        causality => ["calculatedParameter", "local"].contains(&causality),
    };
    let unknowns: Vec<usize> =
        (1..).zip(variables(subject)).filter(|(_, v)| is_unknown(v)).map(|(index, _)| index).collect();
    assert_eq!(listed(&subject.description.initial_unknowns), unknowns);
    let of_outputs = subject.description.outputs.iter().chain(&subject.description.derivatives);
    let states = states(subject);
    let inputs = [indices(subject, &["input"]), states].concat();
    let initial = indices(subject, &["input", "parameter"]);
    let checks = [
        (of_outputs.collect::<Vec<_>>(), inputs),
        (subject.description.initial_unknowns.iter().collect(), initial),
    ];
    for (unknowns, known) in checks {
        for (index, dependencies) in unknowns {
            assert!(dependencies.is_sorted(), "{index}");
            assert!(dependencies.iter().all(|dependency| known.contains(dependency)), "{index}");
        }
    }
}

/// Indices of the continuous states: what the derivatives are derivatives of.
fn states(subject: &'static Subject) -> Vec<usize> {
    variables(subject).filter_map(|v| v.number("derivative")).map(|index| index as usize).collect()
}

/// FMI 2.0.4, section 2.2.7: each derivative belongs to a continuous output, and no two to the same one.
fn derivatives_belong_to_states(subject: &'static Subject) {
    let states = states(subject);
    assert_eq!(states.len(), subject.description.derivatives.len());
    assert_eq!(states.iter().collect::<BTreeSet<_>>().len(), states.len());
    for state in states {
        let state = &subject.description.variables[state - 1];
        assert_eq!((&*state.causality, &*state.variability), ("output", "continuous"), "{}", state.name);
    }
}

/// Each input and parameter is changed alone, from several starting points; whatever then changes among
/// the initial unknowns must be declared to depend on it.
fn initial_dependencies_are_complete(subject: &'static Subject) {
    let unknowns: Vec<_> = (subject.description.initial_unknowns.iter())
        .map(|(index, dependencies)| (&subject.description.variables[index - 1], dependencies))
        // Those of other types say how the controllers' last step went, and there has been none.
        .filter(|(unknown, _)| unknown.value_type == "Real")
        .collect();
    let references: Vec<_> = unknowns.iter().map(|(unknown, _)| unknown.reference).collect();
    let mut found = BTreeMap::<&str, usize>::new();
    for (start, switches) in subject.sample.points {
        let prepared = || {
            let mut instance = Instance::with_logging(subject, false);
            assert_eq!(instance.set_real(start), OK);
            assert_eq!(instance.set_boolean(switches), OK);
            assert_eq!(instance.enter_initialization_mode(), OK);
            instance
        };
        let before = prepared().try_reals(&references).expect("valid values");
        for (index, known) in (1..).zip(variables(subject)).filter(|(_, v)| v.attribute("start").is_some()) {
            let mut instance = prepared();
            if !nudge(&mut instance, known) {
                continue;
            }
            // Not every value fits to the others; those that do not say nothing.
            let Ok(after) = instance.try_reals(&references) else { continue };
            for (((unknown, dependencies), before), after) in unknowns.iter().zip(&before).zip(&after) {
                if before.to_bits() != after.to_bits() {
                    assert!(dependencies.contains(&index), "{} depends on {}", unknown.name, known.name);
                    *found.entry(&unknown.name).or_default() += 1;
                }
            }
        }
    }
    assert!(found.len() >= subject.sample.dependent, "the changes showed too little: {found:?}");
}

/// Changes a variable's value a little.
fn nudge(instance: &mut Instance, variable: &Variable) -> bool {
    let name = variable.name.as_str();
    let status = match variable.value_type.as_str() {
        "Real" => {
            let value = instance.real(name);
            let maximum = variable.number("max").expect("a range");
            let more = value + 0.05 * value.abs().max(0.2);
            instance.set_real(&[(name, if more <= maximum { more } else { value - 0.05 * value.abs() })])
        }
        "Integer" | "Enumeration" => {
            let value = instance.integer(name);
            instance.set_integer(&[(name, value + 1)])
        }
        _ => {
            let value = instance.boolean(name);
            instance.set_boolean(&[(name, !value)])
        }
    };
    status == OK
}

/// Names in `declaredType`, `unit` and `displayUnit` are defined.
fn units_and_types_are_defined(subject: &'static Subject) {
    let document = roxmltree::Document::parse(&subject.description.text).expect("well-formed XML");
    let names = |tag: &str| -> BTreeSet<&str> {
        document.descendants().filter(|n| n.has_tag_name(tag)).filter_map(|n| n.attribute("name")).collect()
    };
    let (units, types) = (names("Unit"), names("SimpleType"));
    let display: BTreeSet<(&str, &str)> = (document.descendants().filter(|n| n.has_tag_name("DisplayUnit")))
        .filter_map(|n| Some((n.parent()?.attribute("name")?, n.attribute("name")?)))
        .collect();
    let reals = document.descendants().filter(|n| n.has_tag_name("Real"));
    for real in reals {
        let unit = real.attribute("unit");
        assert!(unit.is_none_or(|unit| units.contains(unit)), "{real:?}");
        assert!(real.attribute("declaredType").is_none_or(|name| types.contains(name)), "{real:?}");
        if let Some(preferred) = real.attribute("displayUnit") {
            assert!(display.contains(&(unit.expect("a display unit needs a unit"), preferred)), "{real:?}");
        }
    }
    for variable in variables(subject).filter(|v| v.value_type == "Real") {
        assert!(variable.attribute("declaredType").is_some(), "{}", variable.name);
    }
}

fn head_is_what_importers_need(subject: &'static Subject) {
    let document = roxmltree::Document::parse(&subject.description.text).expect("well-formed XML");
    let root = document.root_element();
    let date = root.attribute("generationDateAndTime").expect("a date");
    assert!(date.len() == 20 && date.ends_with('Z'), "{date}");
    assert_eq!(root.attribute("fmiVersion"), Some("2.0"));
    assert_eq!(root.attribute("modelName"), Some(subject.sample.model_name));
    assert_eq!(root.attribute("variableNamingConvention"), Some("structured"));
    let license =
        std::fs::read_to_string(path().with_file_name("LICENSE-MIT")).expect("it is in the repository");
    let copyright = root.attribute("copyright").expect("a copyright");
    if subject.sample.model_name == "LmpcQuadrotor" {
        assert!(license.lines().any(|line| line == copyright), "{copyright} is not that of the licence");
    }
    let author = root.attribute("author").expect("an author");
    assert!(copyright.ends_with(author), "{author}");
    let kinds = root.children().filter(|n| n.attribute("modelIdentifier").is_some());
    let kinds: Vec<_> = kinds.collect();
    let names: Vec<_> = kinds.iter().map(|kind| kind.tag_name().name()).collect();
    let exchanges = !subject.description.derivatives.is_empty();
    assert_eq!(names, if exchanges { vec!["ModelExchange", "CoSimulation"] } else { vec!["CoSimulation"] });
    assert_eq!(root.attribute("numberOfEventIndicators").is_some(), exchanges);
    for kind in &kinds {
        let differentiates = kind.attribute("providesDirectionalDerivative") == Some("true");
        assert_eq!(differentiates, exchanges);
    }
    let simulation = kinds.last().expect("a kind");
    assert_eq!(simulation.attribute("modelIdentifier"), Some(subject.sample.model_identifier));
    let experiment = root.children().find(|n| n.has_tag_name("DefaultExperiment")).expect("an experiment");
    let number = |name| experiment.attribute(name).expect("given").parse::<f64>().expect("a number");
    // FMPy doubles the step until there are at most 1000 of them; a sample time must stay a multiple.
    let steps = (number("stopTime") - number("startTime")) / number("stepSize");
    assert!(steps <= 1000.0 && (0.05 / number("stepSize")).fract() == 0.0, "{steps} steps");
}

for_each_model! {
    names_are_unique_and_structured,
    attributes_are_a_legal_combination,
    start_values_lie_in_their_ranges,
    start_values_are_those_of_a_fresh_instance,
    structure_lists_exactly_the_unknowns_in_order,
    derivatives_belong_to_states,
    initial_dependencies_are_complete,
    units_and_types_are_defined,
    head_is_what_importers_need,
}
