//! `terminalsAndIcons.xml`: groups of variables that plug into those of another model.

use std::collections::BTreeMap;

use fmi::description::{model_description, model_description3, terminals_and_icons, terminals_and_icons3};
use fmu::{ClosedLoop, Controller, QuadrotorPlant};
use roxmltree::Document;

/// Members of each terminal, by name, with their variables; the matching rules are checked on the way.
type Terminals = BTreeMap<String, BTreeMap<String, String>>;

fn terminals(text: &str) -> Terminals {
    let document = Document::parse(text).expect("it is XML");
    let terminals = document.descendants().filter(|node| node.has_tag_name("Terminal"));
    terminals
        .map(|terminal| {
            let members = terminal.children().filter(roxmltree::Node::is_element).map(|member| {
                let attribute = |name| member.attribute(name).expect("given").to_owned();
                assert_eq!(attribute("variableKind"), "signal");
                (attribute("memberName"), attribute("variableName"))
            });
            let (name, members) = (terminal.attribute("name").expect("given"), members.collect());
            let rule = if name == "actuation" { "plug" } else { "bus" };
            assert_eq!(terminal.attribute("matchingRule"), Some(rule));
            (name.to_owned(), members)
        })
        .collect()
}

/// Causalities of all variables of a description.
fn causalities(description: &str) -> BTreeMap<String, String> {
    let document = Document::parse(description).expect("it is XML");
    let named = document.descendants().filter_map(|node| {
        Some((node.attribute("name")?.to_owned(), node.attribute("causality")?.to_owned()))
    });
    named.collect()
}

/// What the three models have in one version of FMI: terminals, and causalities of variables.
fn of_version(version: u8) -> [(Terminals, BTreeMap<String, String>); 3] {
    let texts = if version == 2 {
        [
            (terminals_and_icons::<ClosedLoop>(), model_description::<ClosedLoop>()),
            (terminals_and_icons::<Controller>(), model_description::<Controller>()),
            (terminals_and_icons::<QuadrotorPlant>(), model_description::<QuadrotorPlant>()),
        ]
    } else {
        [
            (terminals_and_icons3::<ClosedLoop>(), model_description3::<ClosedLoop>()),
            (terminals_and_icons3::<Controller>(), model_description3::<Controller>()),
            (terminals_and_icons3::<QuadrotorPlant>(), model_description3::<QuadrotorPlant>()),
        ]
    };
    texts.map(|(text, description)| (terminals(&text.expect("it has terminals")), causalities(&description)))
}

/// Whatever is measured is told, whatever is commanded is obeyed, and one end of each connection is an output.
#[test]
fn the_controllers_plug_into_the_plant() {
    for version in [2, 3] {
        let [_, (controller, of_controller), (plant, of_plant)] = of_version(version);
        let keys = |members: &BTreeMap<String, String>| members.keys().cloned().collect::<Vec<_>>();
        assert_eq!(keys(&controller["actuation"]), keys(&plant["actuation"]), "{version}");
        let scalars = if version == 2 { (8, 20) } else { (3, 6) };
        assert_eq!((controller["actuation"].len(), controller["motion"].len()), scalars);
        for (terminal, from, to) in [("actuation", "output", "input"), ("motion", "input", "output")] {
            for (member, variable) in &controller[terminal] {
                let other = plant[terminal].get(member).unwrap_or_else(|| panic!("{member} has no partner"));
                assert_eq!(
                    (of_controller[variable].as_str(), of_plant[other].as_str()),
                    (from, to),
                    "{member}"
                );
            }
        }
    }
}

/// The closed loop takes the place of both.
#[test]
fn the_closed_loop_has_the_terminals_that_are_left_of_both() {
    for version in [2, 3] {
        let [(closed_loop, _), (controller, _), (plant, _)] = of_version(version);
        assert_eq!(closed_loop["reference"], controller["reference"], "{version}");
        assert_eq!(closed_loop["disturbance"], plant["disturbance"], "{version}");
        assert_eq!(closed_loop["motion"], plant["motion"], "{version}");
        assert_eq!(closed_loop.len(), 3);
        assert!(closed_loop["reference"].contains_key("armed"));
        assert!(closed_loop["disturbance"].keys().any(|member| member.starts_with("wind.velocity")));
    }
}
