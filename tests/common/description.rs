//! `modelDescription.xml` as read by a parser that is not the writer's.

use std::path::{Path, PathBuf};

use super::library::Reference;

/// One `ScalarVariable`.
#[derive(Clone, Debug)]
pub struct Variable {
    pub name: String,
    pub reference: Reference,
    pub description: String,
    pub causality: String,
    pub variability: String,
    pub initial: Option<String>,
    /// `Real`, `Integer`, `Enumeration`, `Boolean`
    pub value_type: String,
    /// Attributes of the element of that name.
    pub attributes: Vec<(String, String)>,
}

impl Variable {
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// An attribute that is a number.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.attribute(name).map(|text| text.parse().expect("a number"))
    }
}

/// An entry of `ModelStructure`: index, and the indices it depends on.
pub type Unknown = (usize, Vec<usize>);

/// The parts that the tests use.
pub struct Description {
    pub text: String,
    pub guid: String,
    pub event_indicators: usize,
    pub variables: Vec<Variable>,
    pub outputs: Vec<Unknown>,
    pub derivatives: Vec<Unknown>,
    pub initial_unknowns: Vec<Unknown>,
}

impl Description {
    pub fn parse(text: String) -> Self {
        let document = roxmltree::Document::parse(&text).expect("well-formed XML");
        let root = document.root_element();
        let attribute = |node: roxmltree::Node<'_, '_>, name: &str| node.attribute(name).map(str::to_owned);
        let required =
            |node, name: &str| attribute(node, name).unwrap_or_else(|| panic!("no {name} in {node:?}"));
        let variables = root.descendants().filter(|node| node.has_tag_name("ScalarVariable")).map(|node| {
            let value = node.first_element_child().expect("a variable has a type");
            Variable {
                name: required(node, "name"),
                reference: required(node, "valueReference").parse().expect("a number"),
                description: required(node, "description"),
                causality: required(node, "causality"),
                variability: required(node, "variability"),
                initial: attribute(node, "initial"),
                value_type: value.tag_name().name().to_owned(),
                attributes: value.attributes().map(|a| (a.name().to_owned(), a.value().to_owned())).collect(),
            }
        });
        let unknowns = |list: &str| -> Vec<Unknown> {
            let Some(list) = root.descendants().find(|node| node.has_tag_name(list)) else {
                return Vec::new();
            };
            let indices =
                |text: String| text.split_whitespace().map(|i| i.parse().expect("a number")).collect();
            list.children()
                .filter(roxmltree::Node::is_element)
                .map(|node| {
                    let index = required(node, "index").parse().expect("a number");
                    (index, indices(required(node, "dependencies")))
                })
                .collect()
        };
        Self {
            guid: required(root, "guid"),
            event_indicators: attribute(root, "numberOfEventIndicators")
                .map_or(0, |n| n.parse().expect("a number")),
            variables: variables.collect(),
            outputs: unknowns("Outputs"),
            derivatives: unknowns("Derivatives"),
            initial_unknowns: unknowns("InitialUnknowns"),
            text,
        }
    }

    pub fn variable(&self, name: &str) -> &Variable {
        self.variables.iter().find(|variable| variable.name == name).unwrap_or_else(|| panic!("no {name}"))
    }

    pub fn reference(&self, name: &str) -> Reference {
        self.variable(name).reference
    }

    /// All outputs.
    pub fn outputs(&self) -> impl Iterator<Item = &Variable> {
        self.variables.iter().filter(|variable| variable.causality == "output")
    }
}

/// Where the description of the quadrotor lies in the repository.
pub fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("modelDescription.xml")
}
