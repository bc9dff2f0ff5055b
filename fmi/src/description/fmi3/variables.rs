//! `ModelVariables`

use std::io;

use super::SECOND;
use crate::description::document::{Attributes, Xml, empty};
use crate::description::numbers::{initial, nominal, real, text};
use crate::layout::{Content, Entry, Layout, Number};
use crate::model::Model;
use crate::variables::{Role, Type, Value, Variable, arrays, named, variable};

pub(super) fn write<M: Model>(xml: &mut Xml, layout: &Layout) -> io::Result<()> {
    xml.create_element("ModelVariables").write_inner_content(|xml| {
        layout.entries().iter().try_for_each(|entry| match entry.content {
            Content::Variables(value_type) => tabled::<M>(xml, entry, value_type),
            Content::Time => time(xml, entry),
            Content::EventIndicators => event_indicators(xml, entry),
        })
    })?;
    Ok(())
}

/// The variables of the table that an entry stands for.
pub(in crate::description) fn elements<M: Model>(entry: &Entry) -> Vec<&'static Variable<M>> {
    let elements = entry.numbers().filter_map(|number| match number {
        Number::Variable(reference) => variable::<M>(reference).ok(),
        Number::Time | Number::EventIndicator(_) => None,
    });
    elements.collect()
}

/// A variable of the table, or an array of them.
fn tabled<M: Model>(xml: &mut Xml, entry: &Entry, value_type: Type) -> io::Result<()> {
    let elements = elements::<M>(entry);
    let Some(first) = elements.first() else { return Ok(()) };
    let array = arrays::<M>().find(|array| entry.is_array && array.name == entry.name);
    let mut attributes = head(entry, array.map_or(first.description, |array| array.description));
    attributes.push(("causality", first.causality().to_owned()));
    attributes.push(("variability", first.variability().to_owned()));
    attributes.extend(initial(first).map(|initial| ("initial", initial.to_owned())));
    if let Some(quantity) = first.quantity() {
        attributes.push(("declaredType", quantity.name.to_owned()));
        // The unit is written again: not every importer follows declaredType.
        attributes.extend(quantity.unit.map(|unit| ("unit", unit.name.to_owned())));
        attributes.extend(quantity.display_unit.map(|unit| ("displayUnit", unit.to_owned())));
    }
    attributes.extend(first.choice().map(|choice| ("declaredType", choice.name.to_owned())));
    attributes.extend(bound(&elements, |(minimum, _)| minimum, f64::min).map(|value| ("min", value)));
    attributes.extend(bound(&elements, |(_, maximum)| maximum, f64::max).map(|value| ("max", value)));
    // The largest of the elements, which share one attribute.
    let nominal = elements.iter().filter_map(|element| nominal(element)).reduce(f64::max);
    attributes.extend(nominal.map(|nominal| ("nominal", real(nominal))));
    if let Role::Derivative { of, .. } = first.role {
        // An array of derivatives belongs to the array of its states: both begin at their first elements.
        attributes.extend(named::<M>(of).map(|(reference, _)| ("derivative", reference.to_string())));
    }
    let start: Option<Vec<String>> = elements.iter().map(|element| element.start().map(text)).collect();
    attributes.extend(start.map(|start| ("start", start.join(" "))));
    element(xml, type_name(value_type), entry, &attributes)
}

/// Time, which 3.0 wants as a variable.
fn time(xml: &mut Xml, entry: &Entry) -> io::Result<()> {
    let mut attributes = head(entry, "Time");
    attributes.push(("causality", "independent".to_owned()));
    attributes.push(("variability", "continuous".to_owned()));
    attributes.push(("unit", SECOND.name.to_owned()));
    element(xml, type_name(Type::Real), entry, &attributes)
}

/// The event indicators, which 3.0 wants as variables.
fn event_indicators(xml: &mut Xml, entry: &Entry) -> io::Result<()> {
    let mut attributes = head(entry, "Event indicators: an event is where one of them changes its sign");
    attributes.push(("causality", "local".to_owned()));
    attributes.push(("variability", "continuous".to_owned()));
    attributes.push(("initial", "calculated".to_owned()));
    element(xml, type_name(Type::Real), entry, &attributes)
}

fn head(entry: &Entry, description: &str) -> Attributes<'static> {
    vec![
        ("name", entry.name.to_owned()),
        ("valueReference", entry.reference.to_string()),
        ("description", description.to_owned()),
    ]
}

/// The element of a variable, with its dimension if it is an array.
fn element(xml: &mut Xml, name: &str, entry: &Entry, attributes: &Attributes<'_>) -> io::Result<()> {
    if !entry.is_array {
        return empty(xml, name, attributes);
    }
    xml.create_element(name)
        .with_attributes(attributes.iter().map(|(name, value)| (*name, value.as_str())))
        .write_inner_content(|xml| empty(xml, "Dimension", &vec![("start", entry.length.to_string())]))?;
    Ok(())
}

/// The bound that holds for all elements, if each has one.
fn bound<M: Model>(
    elements: &[&Variable<M>],
    side: impl Fn((Option<Value>, Option<Value>)) -> Option<Value>,
    wider: fn(f64, f64) -> f64,
) -> Option<String> {
    let bounds: Option<Vec<Value>> = elements.iter().map(|element| side(element.range())).collect();
    let widest = bounds?.into_iter().reduce(|a, b| match (a, b) {
        (Value::Real(a), Value::Real(b)) => Value::Real(wider(a, b)),
        (first, _) => first,
    });
    widest.map(text)
}

/// The element's name of a type.
fn type_name(of: Type) -> &'static str {
    match of {
        Type::Real => "Float64",
        Type::Integer => "Int32",
        Type::Enumeration => "Enumeration",
        Type::Boolean => "Boolean",
    }
}
