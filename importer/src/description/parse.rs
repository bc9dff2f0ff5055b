//! Reading `modelDescription.xml`, whatever is in it.

use std::collections::HashMap;
use std::str::FromStr;

use roxmltree::{Document, Node, ParsingOptions};

use super::{Causality, Dimension, Kind, ModelDescription, Unit, Variability, Variable};
use crate::error::ImportError;

/// Elements and attributes of the largest description; it bounds the memory.
const MOST_NODES: u32 = 20_000_000;
const BASE_UNITS: [&str; 7] = ["kg", "m", "s", "A", "K", "mol", "cd"];

impl ModelDescription {
    /// Reads a description.
    ///
    /// # Errors
    /// [`ImportError::Version`], [`ImportError::NotCoSimulation`], or [`ImportError::Description`] with the place.
    pub fn parse(text: &str) -> Result<Self, ImportError> {
        // Without a DTD, so that no entities grow.
        let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
        let document = Document::parse_with_options(text, options)
            .map_err(|error| ImportError::Description(format!("is not XML: {error}")))?;
        let root = document.root_element();
        if root.tag_name().name() != "fmiModelDescription" {
            return Err(wrong(&root, "is not <fmiModelDescription>"));
        }
        let version = required(&root, "fmiVersion")?;
        if !version.starts_with("2.") {
            return Err(ImportError::Version(version.chars().take(20).collect()));
        }
        let co_simulation = child(&root, "CoSimulation").ok_or(ImportError::NotCoSimulation)?;
        let model_identifier = required(&co_simulation, "modelIdentifier")?.to_owned();
        // It becomes part of a path.
        if model_identifier.is_empty() || model_identifier.contains(['/', '\\', '\0']) {
            return Err(wrong(&co_simulation, "has a modelIdentifier that is no file name"));
        }
        let types = child(&root, "TypeDefinitions")
            .map(|types| simple_types(&types))
            .transpose()?
            .unwrap_or_default();
        let variables =
            child(&root, "ModelVariables").ok_or_else(|| wrong(&root, "lacks <ModelVariables>"))?;
        let units = child(&root, "UnitDefinitions")
            .map(|units| elements(&units, "Unit").map(|node| unit(&node)).collect());
        Ok(Self {
            model_name: required(&root, "modelName")?.to_owned(),
            guid: required(&root, "guid")?.to_owned(),
            model_identifier,
            generation_tool: root.attribute("generationTool").map(str::to_owned),
            can_handle_variable_step: truth(&co_simulation, "canHandleVariableCommunicationStepSize")?,
            needs_execution_tool: truth(&co_simulation, "needsExecutionTool")?,
            variables: elements(&variables, "ScalarVariable")
                .map(|node| variable(&node, &types))
                .collect::<Result<_, _>>()?,
            units: units.transpose()?.unwrap_or_default(),
        })
    }
}

/// Kinds of `<SimpleType>` by their names.
fn simple_types(types: &Node<'_, '_>) -> Result<HashMap<String, Kind>, ImportError> {
    elements(types, "SimpleType")
        .map(|node| {
            let (kind, _) = kind_of(&node)?;
            Ok((required(&node, "name")?.to_owned(), kind))
        })
        .collect()
}

/// The element that has the type of a variable or of a type definition, and that type.
fn kind_of<'a, 'input>(node: &Node<'a, 'input>) -> Result<(Kind, Node<'a, 'input>), ImportError> {
    for element in node.children().filter(Node::is_element) {
        let kind = match element.tag_name().name() {
            "Real" => Kind::Real { unit: element.attribute("unit").map(str::to_owned) },
            "Integer" => Kind::Integer,
            "Boolean" => Kind::Boolean,
            "String" => Kind::String,
            "Enumeration" => Kind::Enumeration {
                items: elements(&element, "Item")
                    .map(|item| Ok((required(&item, "name")?.to_owned(), number(&item, "value")?)))
                    .collect::<Result<_, ImportError>>()?,
            },
            _ => continue,
        };
        return Ok((kind, element));
    }
    Err(wrong(node, "has no type"))
}

fn variable(node: &Node<'_, '_>, types: &HashMap<String, Kind>) -> Result<Variable, ImportError> {
    let (own, element) = kind_of(node)?;
    let declared = element.attribute("declaredType").and_then(|name| types.get(name));
    let kind = match (own, declared) {
        (Kind::Real { unit: None }, Some(real @ Kind::Real { .. })) => real.clone(),
        (Kind::Enumeration { .. }, Some(choice @ Kind::Enumeration { .. })) => choice.clone(),
        (own, _) => own,
    };
    Ok(Variable {
        name: required(node, "name")?.to_owned(),
        reference: number(node, "valueReference")?,
        causality: match node.attribute("causality").unwrap_or("local") {
            "parameter" => Causality::Parameter,
            "calculatedParameter" => Causality::CalculatedParameter,
            "input" => Causality::Input,
            "output" => Causality::Output,
            "local" => Causality::Local,
            "independent" => Causality::Independent,
            _ => return Err(wrong(node, "has a causality that FMI 2.0 does not know")),
        },
        variability: match node.attribute("variability").unwrap_or("continuous") {
            "constant" => Variability::Constant,
            "fixed" => Variability::Fixed,
            "tunable" => Variability::Tunable,
            "discrete" => Variability::Discrete,
            "continuous" => Variability::Continuous,
            _ => return Err(wrong(node, "has a variability that FMI 2.0 does not know")),
        },
        kind,
    })
}

fn unit(node: &Node<'_, '_>) -> Result<Unit, ImportError> {
    let name = required(node, "name")?.to_owned();
    let Some(base) = child(node, "BaseUnit") else {
        return Ok(Unit { name, dimension: None, factor: 1.0, offset: 0.0 });
    };
    let mut exponents = [0; 7];
    for (exponent, name) in exponents.iter_mut().zip(BASE_UNITS) {
        *exponent = optional(&base, name)?.unwrap_or(0);
    }
    let factor = optional(&base, "factor")?.unwrap_or(1.0);
    let offset = optional(&base, "offset")?.unwrap_or(0.0);
    if !(f64::is_finite(factor) && factor != 0.0 && f64::is_finite(offset)) {
        return Err(wrong(&base, "has a factor or offset that nothing converts by"));
    }
    Ok(Unit { name, dimension: Some(Dimension(exponents)), factor, offset })
}

fn child<'a, 'input>(node: &Node<'a, 'input>, name: &'static str) -> Option<Node<'a, 'input>> {
    node.children().find(|child| child.is_element() && child.tag_name().name() == name)
}

fn elements<'a, 'input>(
    node: &Node<'a, 'input>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(move |child| child.is_element() && child.tag_name().name() == name)
}

fn required<'a>(node: &Node<'a, '_>, attribute: &str) -> Result<&'a str, ImportError> {
    node.attribute(attribute).ok_or_else(|| wrong(node, &format!("lacks {attribute}")))
}

fn number<T: FromStr>(node: &Node<'_, '_>, attribute: &str) -> Result<T, ImportError> {
    let text = required(node, attribute)?;
    text.trim()
        .parse()
        .map_err(|_| wrong(node, &format!("has {attribute}={text:?}, which is no such number")))
}

fn optional<T: FromStr>(node: &Node<'_, '_>, attribute: &str) -> Result<Option<T>, ImportError> {
    if node.has_attribute(attribute) { number(node, attribute).map(Some) } else { Ok(None) }
}

fn truth(node: &Node<'_, '_>, attribute: &str) -> Result<bool, ImportError> {
    match node.attribute(attribute).unwrap_or("false") {
        "true" | "1" => Ok(true),
        "false" | "0" => Ok(false),
        _ => Err(wrong(node, &format!("has {attribute} that is neither true nor false"))),
    }
}

/// An element with its line, and what is wrong with it.
fn wrong(node: &Node<'_, '_>, reason: &str) -> ImportError {
    let line = node.document().text_pos_at(node.range().start).row;
    let name = node.attribute("name").map(|name| format!(" {name:?}")).unwrap_or_default();
    ImportError::Description(format!("line {line}: <{}>{name} {reason}", node.tag_name().name()))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Causality, Dimension, Kind, ModelDescription, Variability};

    const DESCRIPTION: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="A model" guid="{1}" generationTool="by hand">
  <CoSimulation modelIdentifier="model" canHandleVariableCommunicationStepSize="true"/>
  <UnitDefinitions>
    <Unit name="deg"><BaseUnit rad="1" factor="0.017453292519943295"/></Unit>
    <Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
    <Unit name="furlong"/>
  </UnitDefinitions>
  <TypeDefinitions>
    <SimpleType name="Angle"><Real quantity="Angle" unit="deg"/></SimpleType>
    <SimpleType name="Choice"><Enumeration><Item name="a" value="1"/><Item name="b" value="2"/></Enumeration></SimpleType>
  </TypeDefinitions>
  <ModelVariables>
    <ScalarVariable name="u" valueReference="7" causality="input"><Real declaredType="Angle" start="0"/></ScalarVariable>
    <ScalarVariable name="c" valueReference="8" causality="parameter" variability="fixed"><Enumeration declaredType="Choice" start="1"/></ScalarVariable>
    <ScalarVariable name="on" valueReference="0"><Boolean/></ScalarVariable>
  </ModelVariables>
  <ModelStructure/>
</fmiModelDescription>"#;

    #[test]
    fn a_description_is_read_with_types_and_units() {
        let read = ModelDescription::parse(DESCRIPTION).expect("a description");
        assert_eq!((read.model_name.as_str(), read.model_identifier.as_str()), ("A model", "model"));
        assert!(read.can_handle_variable_step && !read.needs_execution_tool);
        let input = read.variable("u").expect("a variable");
        assert_eq!((input.reference, input.causality), (7, Causality::Input));
        assert_eq!(input.kind, Kind::Real { unit: Some("deg".to_owned()) });
        let choice = read.variable("c").expect("a variable");
        assert_eq!(choice.variability, Variability::Fixed);
        assert_eq!(choice.kind, Kind::Enumeration { items: vec![("a".to_owned(), 1), ("b".to_owned(), 2)] });
        assert_eq!(read.variable("on").expect("a variable").causality, Causality::Local);
        let degree = read.unit("deg").expect("a unit");
        assert_eq!(
            (degree.dimension, degree.to_base(180.0)),
            (Some(Dimension([0; 7])), std::f64::consts::PI)
        );
        assert_eq!(read.unit("degC").expect("a unit").to_base(20.0), 293.15);
        assert_eq!(read.unit("furlong").expect("a unit").dimension, None);
    }

    #[test]
    fn mistakes_are_named_with_their_line() {
        for (from, to, expected) in [
            ("fmiVersion=\"2.0\"", "fmiVersion=\"3.0\"", "is an FMU of FMI 3.0"),
            ("CoSimulation", "ModelExchange", "has no co-simulation"),
            (
                "valueReference=\"7\"",
                "valueReference=\"-7\"",
                "line 14: <ScalarVariable> \"u\" has valueReference=\"-7\"",
            ),
            ("causality=\"input\"", "causality=\"in\"", "line 14: <ScalarVariable> \"u\" has a causality"),
            ("<Boolean/>", "", "line 16: <ScalarVariable> \"on\" has no type"),
            (
                "modelIdentifier=\"model\"",
                "modelIdentifier=\"../model\"",
                "a modelIdentifier that is no file name",
            ),
            (
                "factor=\"0.017453292519943295\"",
                "factor=\"0\"",
                "a factor or offset that nothing converts by",
            ),
            (" guid=\"{1}\"", "", "line 2: <fmiModelDescription> lacks guid"),
            ("</fmiModelDescription>", "", "is not XML"),
            ("<?xml version=\"1.0\" encoding=\"UTF-8\"?>", "<!DOCTYPE x [<!ENTITY a \"b\">]>", "is not XML"),
        ] {
            let text = DESCRIPTION.replace(from, to);
            assert_ne!(text, DESCRIPTION, "{from}");
            let error = ModelDescription::parse(&text).expect_err(to).to_string();
            assert!(error.contains(expected), "{to}: {error}");
        }
    }

    proptest! {
        /// A description with any damage is read or refused.
        #[test]
        fn damage_never_panics(place in 0_usize..2000, length in 0_usize..40, with in "\\PC{0,12}") {
            let characters: Vec<char> = DESCRIPTION.chars().collect();
            let start = place.min(characters.len());
            let end = (start + length).min(characters.len());
            let text: String =
                characters[..start].iter().chain(with.chars().collect::<Vec<_>>().iter()).chain(&characters[end..]).collect();
            let _either = ModelDescription::parse(&text);
        }
    }
}
