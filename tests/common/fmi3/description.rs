//! `modelDescription.xml` of FMI 3.0 as read by a parser that is not the writer's.

use super::library::Reference;

/// One variable.
#[derive(Clone, Debug)]
pub struct Variable {
    pub name: String,
    pub reference: Reference,
    /// `Float64`, `Int32`, `Enumeration`, `Boolean`
    pub value_type: String,
    /// The size of its one dimension, if it is an array.
    pub dimension: Option<usize>,
    attributes: Vec<(String, String)>,
}

impl Variable {
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// Number of its elements.
    pub fn length(&self) -> usize {
        self.dimension.unwrap_or(1)
    }

    pub fn causality(&self) -> &str {
        self.attribute("causality").expect("it is written")
    }

    /// Its start values.
    pub fn start(&self) -> Option<Vec<&str>> {
        Some(self.attribute("start")?.split(' ').collect())
    }
}

/// An entry of `ModelStructure`: reference, and the references that it depends on, if they are given.
pub type Unknown = (Reference, Option<Vec<Reference>>);

/// The parts that the tests use.
pub struct Description {
    pub text: String,
    pub token: String,
    pub variables: Vec<Variable>,
}

impl Description {
    pub fn parse(text: String) -> Self {
        let document = roxmltree::Document::parse(&text).expect("well-formed XML");
        let root = document.root_element();
        assert_eq!(root.attribute("fmiVersion"), Some("3.0"));
        let list = root.children().find(|node| node.has_tag_name("ModelVariables")).expect("variables");
        let variables = list.children().filter(roxmltree::Node::is_element).map(|node| {
            let required =
                |name: &str| node.attribute(name).unwrap_or_else(|| panic!("no {name} in {node:?}"));
            let dimensions: Vec<usize> = node
                .children()
                .filter(|child| child.has_tag_name("Dimension"))
                .map(|child| child.attribute("start").and_then(|size| size.parse().ok()).expect("a size"))
                .collect();
            assert!(dimensions.len() <= 1, "{node:?}");
            Variable {
                name: required("name").to_owned(),
                reference: required("valueReference").parse().expect("a number"),
                value_type: node.tag_name().name().to_owned(),
                dimension: dimensions.first().copied(),
                attributes: node.attributes().map(|a| (a.name().to_owned(), a.value().to_owned())).collect(),
            }
        });
        let (variables, token) =
            (variables.collect(), root.attribute("instantiationToken").expect("a token").to_owned());
        Self { variables, token, text }
    }

    /// The entries of `ModelStructure` of one kind.
    pub fn unknowns(&self, kind: &str) -> Vec<Unknown> {
        let document = roxmltree::Document::parse(&self.text).expect("well-formed XML");
        let number = |text: &str| text.parse::<Reference>().expect("a number");
        document
            .descendants()
            .filter(|node| node.has_tag_name(kind))
            .map(|node| {
                let dependencies = node.attribute("dependencies");
                (
                    number(node.attribute("valueReference").expect("a reference")),
                    dependencies.map(|list| list.split_whitespace().map(number).collect()),
                )
            })
            .collect()
    }

    /// An attribute of the element of an interface type.
    pub fn capability(&self, interface: &str, name: &str) -> Option<String> {
        let document = roxmltree::Document::parse(&self.text).expect("well-formed XML");
        let element = document.root_element().children().find(|node| node.has_tag_name(interface))?;
        element.attribute(name).map(str::to_owned)
    }

    pub fn variable(&self, name: &str) -> &Variable {
        self.variables.iter().find(|variable| variable.name == name).unwrap_or_else(|| panic!("no {name}"))
    }

    pub fn reference(&self, name: &str) -> Reference {
        self.variable(name).reference
    }

    /// The variable that has this element of the table of variables.
    pub fn containing(&self, element: Reference) -> &Variable {
        let holds = |variable: &&Variable| {
            (variable.reference..variable.reference + variable.length() as Reference).contains(&element)
        };
        self.variables.iter().find(holds).unwrap_or_else(|| panic!("nothing has {element}"))
    }
}
