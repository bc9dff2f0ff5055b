//! What an FMU offers to a system.

use roxmltree::{Document, Node};

use crate::failure::Failure;

/// A real variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Port {
    pub name: String,
    pub causality: String,
    /// Symbol of its unit, if it has one.
    pub unit: Option<String>,
    /// Its start value as it is written, if it has one.
    pub start: Option<String>,
}

/// A unit: its symbol and its exponents of base units.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    pub symbol: String,
    pub base: Vec<(String, String)>,
}

/// All real variables of an FMU, and the units.
pub struct Ports {
    pub ports: Vec<Port>,
    pub units: Vec<Unit>,
}

impl Ports {
    /// Reads a `modelDescription.xml` of FMI 2.0.
    pub fn read(description: &str) -> Result<Self, Failure> {
        let document = Document::parse(description)?;
        let ports = document.descendants().filter_map(|node| port(&node)).collect();
        let units = document.descendants().filter_map(|node| unit(&node)).collect();
        Ok(Self { ports, units })
    }

    /// The variable of this name.
    pub fn find(&self, name: &str) -> Option<&Port> {
        self.ports.iter().find(|port| port.name == name)
    }
}

fn port(node: &Node) -> Option<Port> {
    let real = node.children().find(|child| child.has_tag_name("Real"))?;
    let text = |node: &Node, name| node.attribute(name).map(str::to_owned);
    Some(Port {
        name: text(node, "name")?,
        causality: text(node, "causality")?,
        unit: text(&real, "unit"),
        start: text(&real, "start"),
    })
}

fn unit(node: &Node) -> Option<Unit> {
    let base = node.children().find(|child| child.has_tag_name("BaseUnit"))?;
    let exponents =
        base.attributes().map(|exponent| (exponent.name().to_owned(), exponent.value().to_owned()));
    Some(Unit { symbol: node.attribute("name")?.to_owned(), base: exponents.collect() })
}
