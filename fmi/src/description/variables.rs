//! `ModelVariables`

use std::io;

use super::Xml;
use crate::model::Model;
use crate::variables::{Role, Value, ValueReference, Variable, variables};

pub(super) fn write<M: Model>(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("ModelVariables").write_inner_content(|xml| {
        variables::<M>().try_for_each(|(reference, variable)| scalar_variable(xml, reference, variable))
    })?;
    Ok(())
}

fn scalar_variable<M: Model>(
    xml: &mut Xml,
    reference: ValueReference,
    variable: &Variable<M>,
) -> io::Result<()> {
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
fn initial<M: Model>(variable: &Variable<M>) -> Option<&'static str> {
    match variable.causality() {
        "parameter" => Some("exact"),
        "output" | "local" | "calculatedParameter" => Some("calculated"),
        _ => None,
    }
}

fn value_element<M: Model>(xml: &mut Xml, variable: &Variable<M>) -> io::Result<()> {
    let mut attributes = Vec::new();
    if let Some(quantity) = variable.quantity() {
        attributes.push(("declaredType", quantity.name.to_owned()));
        // The unit is written again: not every importer follows declaredType.
        attributes.extend(quantity.unit.map(|unit| ("unit", unit.name.to_owned())));
        attributes.extend(quantity.display_unit.map(|unit| ("displayUnit", unit.to_owned())));
    }
    if let Role::Derivative { of, .. } = variable.role {
        let index = variables::<M>().position(|(_, state)| state.name == of).map(|place| place + 1);
        attributes.extend(index.map(|index| ("derivative", index.to_string())));
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
fn nominal<M: Model>(variable: &Variable<M>) -> Option<String> {
    let usual = variable.quantity()?.nominal;
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
pub(super) fn real(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 || (1e-4..1e7).contains(&magnitude) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}
