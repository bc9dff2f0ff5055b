//! `ModelVariables`

use std::io;

use super::Xml;
use crate::types::ValueReference;
use crate::variables::{Value, Variable, with_references};

pub(super) fn write(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("ModelVariables").write_inner_content(|xml| {
        with_references().try_for_each(|(reference, variable)| scalar_variable(xml, reference, variable))
    })?;
    Ok(())
}

fn scalar_variable(xml: &mut Xml, reference: ValueReference, variable: &Variable) -> io::Result<()> {
    let mut element = xml.create_element("ScalarVariable").with_attributes([
        ("name", variable.name),
        ("valueReference", reference.to_string().as_str()),
        ("description", variable.description),
        ("causality", variable.causality()),
        ("variability", variable.variability()),
    ]);
    if let Some(initial) = initial(variable) {
        element = element.with_attribute(("initial", initial));
    }
    element.write_inner_content(|xml| value_element(xml, variable))?;
    Ok(())
}

/// Attribute `initial`; inputs must not have one.
fn initial(variable: &Variable) -> Option<&'static str> {
    match variable.causality() {
        "parameter" => Some("exact"),
        "output" | "calculatedParameter" => Some("calculated"),
        _ => None,
    }
}

fn value_element(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let mut attributes = Vec::new();
    if let Some(quantity) = variable.quantity() {
        let definition = quantity.quantity_type();
        attributes.push(("declaredType", definition.name.to_owned()));
        // The unit is written again: not every importer follows declaredType.
        attributes.extend(definition.unit.map(|unit| ("unit", unit.to_owned())));
        attributes.extend(definition.display_unit.map(|unit| ("displayUnit", unit.to_owned())));
    }
    attributes.extend(variable.choice().map(|choice| ("declaredType", choice.name.to_owned())));
    let (minimum, maximum) = variable.range();
    attributes.extend(minimum.map(|value| ("min", text(value))));
    attributes.extend(maximum.map(|value| ("max", text(value))));
    attributes.extend(nominal(variable).map(|nominal| ("nominal", nominal)));
    attributes.extend(variable.start().map(|value| ("start", text(value))));
    xml.create_element(variable.value_type().to_string())
        .with_attributes(attributes.iter().map(|(name, value)| (*name, value.as_str())))
        .write_empty()?;
    Ok(())
}

/// Attribute `nominal`: the start value's magnitude of parameters that have one, else the quantity's.
fn nominal(variable: &Variable) -> Option<String> {
    let usual = variable.quantity()?.quantity_type().nominal;
    match (variable.causality(), variable.start()) {
        ("parameter", Some(Value::Real(start))) if start != 0.0 => Some(real(start.abs())),
        _ => Some(real(usual)),
    }
}

fn text(value: Value) -> String {
    match value {
        Value::Real(value) => real(value),
        Value::Integer(value) => value.to_string(),
        Value::Boolean(value) => value.to_string(),
    }
}

/// The shortest text that reads back as the same number.
fn real(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 || (1e-4..1e7).contains(&magnitude) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}
